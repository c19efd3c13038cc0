// CGAL's Regular_triangulation_3 with exact predicates, by range insertion, for peers.py: `regular POINTS`, raw
// little-endian doubles, coordinates and weight of each point. Prints one JSON object; "seconds" is the insertion alone,
// without reading the file and without freeing the result.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/version.h>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Regular = CGAL::Regular_triangulation_3<Kernel>;

int main(int, char **arguments) {
  std::ifstream file(arguments[1], std::ios::binary | std::ios::ate);
  std::vector<Regular::Weighted_point> points;
  points.reserve(file.tellg() / (4 * sizeof(double)));
  file.seekg(0);
  double p[4];
  while (file.read(reinterpret_cast<char *>(p), sizeof p)) {
    points.emplace_back(Kernel::Point_3(p[0], p[1], p[2]), p[3]);
  }

  const auto start = std::chrono::steady_clock::now();
  const Regular mesh(points.begin(), points.end());
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  std::printf("{\"cgal\": \"" CGAL_VERSION_STR "\", \"vertices\": %zu, \"cells\": %zu, \"seconds\": %.6f}\n",
              size_t(mesh.number_of_vertices()), size_t(mesh.number_of_finite_cells()), seconds.count());
}
