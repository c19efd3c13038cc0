// The Voronoi cells of voro++ in the unit cube, volumes and neighbours, for peers.py.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <vector>
#include <voro++/voro++.hh>

int main(int, char **arguments) {
  std::ifstream file(arguments[1], std::ios::binary);
  std::vector<double> points(3 * std::stoul(arguments[2]));
  file.read(reinterpret_cast<char *>(points.data()), points.size() * sizeof(double));
  const int count = points.size() / 3;
  const clock_t start = std::clock();
  // About five points per block, as its documentation recommends.
  const int blocks = int(std::cbrt(count / 5.0)) + 1;
  voro::container cells(0, 1, 0, 1, 0, 1, blocks, blocks, blocks, false, false, false, 8);
  for (int i = 0; i < count; i++) cells.put(i, points[3 * i], points[3 * i + 1], points[3 * i + 2]);
  voro::c_loop_all loop(cells);
  voro::voronoicell_neighbor cell;
  std::vector<std::vector<int>> neighbors(count);
  double volume = 0;
  if (loop.start()) do {
      if (!cells.compute_cell(cell, loop)) continue;
      volume += cell.volume();
      cell.neighbors(neighbors[loop.pid()]);
    } while (loop.inc());
  const double cpu = double(std::clock() - start) / CLOCKS_PER_SEC;
  std::printf("{\"name\": \"voronoi\", \"cpu_seconds\": %.6f, \"volume\": %.17g}\n", cpu, volume);
  uint64_t sum = 0;
  for (uint64_t i = 0; i < neighbors.size(); i++) {
    for (int j : neighbors[i]) {
      // The sides of the box have negative numbers.
      if (j < 0) continue;
      const uint64_t pair = i << 32 | uint64_t(j);
      const uint64_t mixed = (pair ^ pair >> 29) * 0xbf58476d1ce4e5b9;
      sum += mixed ^ mixed >> 32;
    }
  }
  std::printf("{\"name\": \"voronoi\", \"checksum\": \"%016llx\"}\n", (unsigned long long)sum);
}
