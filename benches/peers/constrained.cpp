// Constrained Delaunay triangulations of points and segments by CGAL, with exact predicates, and by CDT:
// `constrained POINTS SEGMENTS`, raw little-endian pairs of doubles and of unsigned 32-bit numbers. Prints one JSON object
// per library; "plain" are the seconds for the points alone, "constrained" those for both. Compiled with -lmpfr -lgmp, and
// with the headers of CDT (github.com/artem-ogre/CDT, CDT/include) in the include path.

#include <CDT.h>
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/version.h>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <utility>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Segment = std::pair<std::size_t, std::size_t>;

template <class T> std::vector<T> read(const char *path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::vector<T> all(file.tellg() / sizeof(T));
  file.seekg(0);
  file.read(reinterpret_cast<char *>(all.data()), all.size() * sizeof(T));
  return all;
}

template <class F> double seconds(F run) {
  const auto start = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

int main(int, char **arguments) {
  struct Pair { double x, y; };
  struct Ends { std::uint32_t from, to; };
  const auto pairs = read<Pair>(arguments[1]);
  const auto ends = read<Ends>(arguments[2]);

  {
    std::vector<Kernel::Point_2> points;
    for (const auto &p : pairs) points.emplace_back(p.x, p.y);
    std::vector<Segment> segments;
    for (const auto &e : ends) segments.emplace_back(e.from, e.to);
    std::size_t faces = 0;
    const double plain = seconds([&] { CGAL::Delaunay_triangulation_2<Kernel> mesh(points.begin(), points.end()); });
    const double constrained = seconds([&] {
      // The points first, in an order of its own, as for the plain one; then the segments between their vertices.
      CGAL::Constrained_Delaunay_triangulation_2<Kernel> mesh;
      mesh.insert_constraints(points.begin(), points.end(), segments.begin(), segments.end());
      faces = mesh.number_of_faces();
    });
    std::printf("{\"library\": \"CGAL " CGAL_VERSION_STR "\", \"triangles\": %zu, \"plain\": %.6f, \"constrained\": %.6f}\n", faces,
                plain, constrained);
  }
  {
    std::vector<CDT::V2d<double>> points;
    for (const auto &p : pairs) points.emplace_back(p.x, p.y);
    std::vector<CDT::Edge> edges;
    for (const auto &e : ends) edges.emplace_back(e.from, e.to);
    std::size_t triangles = 0;
    const auto mesh_of = [&](bool is_constrained) {
      CDT::Triangulation<double> mesh;
      mesh.insertVertices(points);
      if (is_constrained) mesh.insertEdges(edges);
      mesh.eraseSuperTriangle();
      triangles = mesh.triangles.size();
    };
    const double plain = seconds([&] { mesh_of(false); });
    const double constrained = seconds([&] { mesh_of(true); });
    std::printf("{\"library\": \"CDT\", \"triangles\": %zu, \"plain\": %.6f, \"constrained\": %.6f}\n", triangles, plain, constrained);
  }
}
