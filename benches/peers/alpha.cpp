// CGAL's alpha shapes, exact and in general mode.
//
// `alpha POINTS RADIUS…`, the oracle in tests/data/derived, prints the smallest alpha with one component
// that has all points, and for each radius how many vertices, edges, facets and cells are exterior,
// singular, regular and interior.
//
// `alpha POINTS --intervals FOLDER`, for answers.py --equal, prints that alpha, and reads a triangulation
// of the points from the folder: `tetrahedra.u32`, and lists of its faces, `facets.u32`, `edges.u32` and
// `vertices.u32`. CGAL checks that it is the Delaunay triangulation, and that the lists have all faces.
// For each of them, in their order, the radii from which on it is singular, regular and interior are
// written to `cgal-facets.f64`, …, and the circumradii to `cgal-cells.f64`. So a triangulation in which
// ties were broken in another way than CGAL's is compared simplex by simplex, too.

#include <CGAL/Alpha_shape_3.h>
#include <CGAL/Alpha_shape_cell_base_3.h>
#include <CGAL/Alpha_shape_vertex_base_3.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <string>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Alpha_shape_vertex_base_3<Kernel, CGAL::Default, CGAL::Tag_true>;
using Cell = CGAL::Alpha_shape_cell_base_3<Kernel, CGAL::Default, CGAL::Tag_true>;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex, Cell>>;
using Alpha = CGAL::Alpha_shape_3<Delaunay, CGAL::Tag_true>;

template <size_t K> std::vector<std::array<uint32_t, K>> read(const std::string &path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<std::array<uint32_t, K>> rows;
  std::array<uint32_t, K> row;
  while (file.read(reinterpret_cast<char *>(row.data()), sizeof row)) rows.push_back(row);
  return rows;
}

static void write(const std::string &path, const std::vector<double> &numbers) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char *>(numbers.data()), numbers.size() * sizeof(double));
}

static void fail(const char *what) {
  std::fprintf(stderr, "%s\n", what);
  std::exit(1);
}

static int intervals(const std::vector<Kernel::Point_3> &points, const std::string &folder) {
  Delaunay mesh;
  auto &tds = mesh.tds();
  tds.clear();
  tds.set_dimension(3);
  const auto infinite = tds.create_vertex();
  mesh.set_infinite_vertex(infinite);
  const auto listed = read<1>(folder + "/vertices.u32");
  std::vector<Alpha::Vertex_handle> vertices(points.size());
  for (const auto [v] : listed) {
    vertices[v] = tds.create_vertex();
    vertices[v]->set_point(points[v]);
  }
  // Facets by their sorted vertices, of which -1 is the infinite one.
  std::map<std::array<int64_t, 3>, Alpha::Facet> facets;
  std::map<std::array<uint32_t, 2>, Alpha::Edge> edges;
  std::vector<Alpha::Cell_handle> cells;
  const auto add = [&](std::array<int64_t, 4> corners) {
    const auto vertex = [&](int k) { return corners[k] < 0 ? infinite : vertices[corners[k]]; };
    const auto cell = tds.create_cell(vertex(0), vertex(1), vertex(2), vertex(3));
    for (int k = 0; k < 4; k++) {
      vertex(k)->set_cell(cell);
      std::array<int64_t, 3> facet{corners[(k + 1) % 4], corners[(k + 2) % 4], corners[(k + 3) % 4]};
      std::sort(facet.begin(), facet.end());
      const auto [at, is_new] = facets.emplace(facet, Alpha::Facet(cell, k));
      if (!is_new) tds.set_adjacency(cell, k, at->second.first, at->second.second);
    }
    return cell;
  };
  std::map<Alpha::Cell_handle, std::array<int64_t, 4>> corners_of;
  for (const auto &t : read<4>(folder + "/tetrahedra.u32")) {
    cells.push_back(add({t[0], t[1], t[2], t[3]}));
    corners_of[cells.back()] = {t[0], t[1], t[2], t[3]};
    for (int j = 0; j < 4; j++)
      for (int i = 0; i < j; i++)
        edges.emplace(std::array{std::min(t[i], t[j]), std::max(t[i], t[j])}, Alpha::Edge(cells.back(), i, j));
  }
  const size_t finite_facets = facets.size();
  std::vector<std::array<int64_t, 4>> beyond;
  for (const auto &[facet, at] : facets) {
    const auto [cell, k] = at;
    if (cell->neighbor(k) != Alpha::Cell_handle()) continue;
    // The other side of the hull: the same cell with the infinite vertex, turned.
    auto corners = corners_of[cell];
    corners[k] = -1;
    std::swap(corners[(k + 1) % 4], corners[(k + 2) % 4]);
    beyond.push_back(corners);
  }
  for (const auto &corners : beyond) add(corners);
  if (!mesh.is_valid()) fail("this is not the Delaunay triangulation");

  Alpha shape(mesh, 0, Alpha::GENERAL);
  const double never = std::numeric_limits<double>::infinity();
  // Without `exact`, what is returned may be off by 10⁻⁵.
  const auto radius = [](const Alpha::NT &squared) { return std::sqrt(CGAL::to_double(squared.exact())); };
  std::vector<double> numbers;
  const auto push = [&](const auto &status, bool is_vertex) {
    const bool has_own = is_vertex || status.is_Gabriel();
    numbers.push_back(is_vertex ? 0 : radius(has_own ? status.alpha_min() : status.alpha_mid()));
    numbers.push_back(radius(status.alpha_mid()));
    numbers.push_back(status.is_on_chull() ? never : radius(status.alpha_max()));
  };
  for (const auto cell : cells) numbers.push_back(radius(cell->get_alpha()));
  write(folder + "/cgal-cells.f64", numbers);
  numbers.clear();
  const auto our_facets = read<3>(folder + "/facets.u32");
  if (our_facets.size() != finite_facets) fail("the number of facets");
  for (const auto &v : our_facets) {
    std::array<int64_t, 3> facet{v[0], v[1], v[2]};
    std::sort(facet.begin(), facet.end());
    push(shape.get_alpha_status(facets.at(facet)), false);
  }
  write(folder + "/cgal-facets.f64", numbers);
  numbers.clear();
  const auto our_edges = read<2>(folder + "/edges.u32");
  if (our_edges.size() != edges.size()) fail("the number of edges");
  for (const auto &edge : our_edges) push(shape.get_alpha_status(edges.at(edge)), false);
  write(folder + "/cgal-edges.f64", numbers);
  numbers.clear();
  for (const auto [v] : listed) push(*vertices[v]->get_alpha_status(), true);
  write(folder + "/cgal-vertices.f64", numbers);
  return 0;
}

int main(int count_of_arguments, char **arguments) {
  std::ifstream file(arguments[1], std::ios::binary);
  std::vector<Kernel::Point_3> points;
  double p[3];
  while (file.read(reinterpret_cast<char *>(p), sizeof p)) points.emplace_back(p[0], p[1], p[2]);
  Delaunay mesh(points.begin(), points.end());
  Alpha shape(mesh, 0, Alpha::GENERAL);
  const double optimal = std::sqrt(CGAL::to_double(shape.find_optimal_alpha(1)->exact()));
  std::printf("optimal %.17g\n", optimal);
  if (count_of_arguments == 4 && std::string(arguments[2]) == "--intervals") return intervals(points, arguments[3]);
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
