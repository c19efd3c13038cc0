// CGAL's alpha shapes, exact and in general mode.
//
// `alpha POINTS RADIUS…`, the oracle in tests/data/derived, prints the smallest alpha with one component
// that has all points, and for each radius how many vertices, edges, facets and cells are exterior,
// singular, regular and interior.

#include <CGAL/Alpha_shape_3.h>
#include <CGAL/Alpha_shape_cell_base_3.h>
#include <CGAL/Alpha_shape_vertex_base_3.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Alpha_shape_vertex_base_3<Kernel, CGAL::Default, CGAL::Tag_true>;
using Cell = CGAL::Alpha_shape_cell_base_3<Kernel, CGAL::Default, CGAL::Tag_true>;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex, Cell>>;
using Alpha = CGAL::Alpha_shape_3<Delaunay, CGAL::Tag_true>;

int main(int count_of_arguments, char **arguments) {
  std::ifstream file(arguments[1], std::ios::binary);
  std::vector<Kernel::Point_3> points;
  double p[3];
  while (file.read(reinterpret_cast<char *>(p), sizeof p)) points.emplace_back(p[0], p[1], p[2]);
  Delaunay mesh(points.begin(), points.end());
  Alpha shape(mesh, 0, Alpha::GENERAL);
  const double optimal = std::sqrt(CGAL::to_double(shape.find_optimal_alpha(1)->exact()));
  std::printf("optimal %.17g\n", optimal);
  for (int i = 2; i < count_of_arguments; i++) {
    const double radius = std::atof(arguments[i]);
    const Alpha::NT alpha = radius * radius;
    const auto count = [&](auto begin, auto end) {
      std::array<int, 4> counts{};
      for (auto it = begin; it != end; ++it) {
        switch (shape.classify(*it, alpha)) {
        case Alpha::EXTERIOR: counts[0]++; break;
        case Alpha::SINGULAR: counts[1]++; break;
        case Alpha::REGULAR: counts[2]++; break;
        case Alpha::INTERIOR: counts[3]++; break;
        }
      }
      std::printf(" %d %d %d %d", counts[0], counts[1], counts[2], counts[3]);
    };
    std::printf("%.17g", radius);
    std::vector<Alpha::Vertex_handle> vertices;
    for (auto it = shape.finite_vertices_begin(); it != shape.finite_vertices_end(); ++it) vertices.push_back(it);
    count(vertices.begin(), vertices.end());
    count(shape.finite_edges_begin(), shape.finite_edges_end());
    count(shape.finite_facets_begin(), shape.finite_facets_end());
    std::vector<Alpha::Cell_handle> cells;
    for (auto it = shape.finite_cells_begin(); it != shape.finite_cells_end(); ++it) cells.push_back(it);
    count(cells.begin(), cells.end());
    std::printf("\n");
  }
}
