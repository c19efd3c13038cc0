// CGAL's surfaces of points: `surface front|scale POINTS` reads coordinates as numbers of double precision, and writes the
// triangles as three indices each, of 32 bits.

#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Scale_space_reconstruction_3/Alpha_shape_mesher.h>
#include <CGAL/Scale_space_reconstruction_3/Weighted_PCA_smoother.h>
#include <CGAL/Scale_space_surface_reconstruction_3.h>
#include <array>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Smoother = CGAL::Scale_space_reconstruction_3::Weighted_PCA_smoother<Kernel>;
using Mesher = CGAL::Scale_space_reconstruction_3::Alpha_shape_mesher<Kernel>;
using Facet = std::array<std::size_t, 3>;

int main(int, char **arguments) {
  std::ifstream file(arguments[2], std::ios::binary);
  std::vector<Kernel::Point_3> points;
  double p[3];
  while (file.read(reinterpret_cast<char *>(p), sizeof p)) points.emplace_back(p[0], p[1], p[2]);
  std::vector<Facet> facets;
  if (std::string(arguments[1]) == "front") {
    CGAL::advancing_front_surface_reconstruction(points.begin(), points.end(), std::back_inserter(facets));
  } else {
    // As in CGAL's manual, with manifold output.
    CGAL::Scale_space_surface_reconstruction_3<Kernel> reconstruction(points.begin(), points.end());
    Smoother smoother(10, 200);
    reconstruction.increase_scale(4, smoother);
    Mesher mesher(smoother.squared_radius(), false, true);
    reconstruction.reconstruct_surface(mesher);
    for (auto it = reconstruction.facets_begin(); it != reconstruction.facets_end(); ++it)
      facets.push_back({(*it)[0], (*it)[1], (*it)[2]});
  }
  for (const Facet &facet : facets) {
    const std::uint32_t row[3] = {std::uint32_t(facet[0]), std::uint32_t(facet[1]), std::uint32_t(facet[2])};
    std::fwrite(row, sizeof row, 1, stdout);
  }
}
