// CGAL's point location, for peers.py: the queries are sorted along a Hilbert curve, and each walk
// starts where the last one ended.

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/spatial_sort.h>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel>;

static std::vector<Kernel::Point_3> read(const char *path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<Kernel::Point_3> points;
  double p[3];
  while (file.read(reinterpret_cast<char *>(p), sizeof p)) points.emplace_back(p[0], p[1], p[2]);
  return points;
}

int main(int, char **arguments) {
  auto points = read(arguments[1]), queries = read(arguments[2]);
  // Processor time, as the other programs measure it.
  const auto seconds = [] { return double(std::clock()) / CLOCKS_PER_SEC; };
  const auto report = [](const char *name, double cpu) {
    std::printf("{\"name\": \"%s\", \"cpu_seconds\": %.6f}\n", name, cpu);
  };
  double start = seconds();
  Delaunay mesh(points.begin(), points.end());
  report("triangulate", seconds() - start);
  start = seconds();
  CGAL::spatial_sort(queries.begin(), queries.end());
  Delaunay::Cell_handle cell;
  size_t inside = 0;
  for (const auto &query : queries) {
    cell = mesh.locate(query, cell);
    inside += !mesh.is_infinite(cell);
  }
  report("locate", seconds() - start);
  std::printf("{\"name\": \"locate\", \"inside\": %zu}\n", inside);
}
