// The peer of the benchmarks: CGAL's Delaunay_triangulation_3 with exact predicates, by range insertion.
//
//   cgal [--repeat N] POINTS.f64     raw little-endian triples of doubles
//
// Prints one JSON object per line per run: "seconds" is the insertion alone, without reading the file and without
// freeing the result; "peak_rss_bytes" is the process's so far.

#include <sys/resource.h>

#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/version.h>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel>;

namespace {

int usage() {
    std::fputs("usage: cgal [--repeat N] POINTS.f64\n", stderr);
    return 2;
}

bool read_points(const char* path, std::vector<Kernel::Point_3>& points) {
    std::error_code error;
    const auto bytes = std::filesystem::file_size(path, error);
    if (error || bytes % (3 * sizeof(double)) != 0) return false;
    std::ifstream file(path, std::ios::binary);
    points.reserve(bytes / (3 * sizeof(double)));
    double p[3];
    while (file.read(reinterpret_cast<char*>(p), sizeof p)) points.emplace_back(p[0], p[1], p[2]);
    return points.size() == bytes / (3 * sizeof(double));
}

}  // namespace

int main(int argc, char** argv) {
    int repeat = 1;
    const char* path = nullptr;
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "--repeat") == 0 && i + 1 < argc) {
            const char* text = argv[++i];
            const char* end = text + std::strlen(text);
            const auto [stop, error] = std::from_chars(text, end, repeat);
            if (error != std::errc() || stop != end || repeat < 1) return usage();
        } else if (path == nullptr) {
            path = argv[i];
        } else {
            return usage();
        }
    }
    if (path == nullptr) return usage();

    std::vector<Kernel::Point_3> points;
    if (!read_points(path, points)) {
        std::fprintf(stderr, "%s: not a readable file of whole triples of doubles\n", path);
        return 1;
    }
    for (int run = 0; run < repeat; ++run) {
        const auto start = std::chrono::steady_clock::now();
        const Delaunay triangulation(points.begin(), points.end());
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;

        rusage usage;
        getrusage(RUSAGE_SELF, &usage);
        std::printf(
            "{\"cgal\": \"" CGAL_VERSION_STR "\", \"points\": %zu, \"vertices\": %zu, \"cells\": %zu, \"seconds\": %.6f, \"peak_rss_bytes\": %lld}\n",
            points.size(), static_cast<std::size_t>(triangulation.number_of_vertices()),
            static_cast<std::size_t>(triangulation.number_of_finite_cells()), seconds.count(),
            static_cast<long long>(usage.ru_maxrss) * 1024);
        std::fflush(stdout);
    }
}
