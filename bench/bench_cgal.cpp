// bench_cgal: what CGAL takes to build the triangulation in core. Reads raw
// records (int64 id, double x, double y; see oracle_points), sorts them along
// a curve and inserts them, as Delaunay_triangulation_2::insert(range) does.
// Prints seconds: read, sort, insert, total; and the number of triangles.
//
// CGAL's triangulations are GPL: this program is a benchmark and not a part of
// the extension.
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/spatial_sort.h>

#include <chrono>
#include <cstdio>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangulation = CGAL::Delaunay_triangulation_2<Kernel>;

namespace {

struct Record {
    std::int64_t id;
    double x, y;
};

bool read_points(const char *path, std::vector<Kernel::Point_2> &points) {
    std::FILE *file = std::fopen(path, "rb");
    if (file == nullptr) return false;
    std::vector<Record> records(1 << 14);
    while (const std::size_t count =
               std::fread(records.data(), sizeof(Record), records.size(), file))
        for (std::size_t i = 0; i < count; ++i) points.emplace_back(records[i].x, records[i].y);
    std::fclose(file);
    return true;
}

} // namespace

int main(int argc, char **argv) {
    using Clock = std::chrono::steady_clock;
    const auto seconds = [](Clock::time_point from, Clock::time_point to) {
        return std::chrono::duration<double>(to - from).count();
    };
    std::vector<Kernel::Point_2> points;
    const auto start = Clock::now();
    if (argc != 2 || !read_points(argv[1], points)) {
        std::fprintf(stderr, "usage: bench_cgal FILE_OF_RAW_POINTS\n");
        return 2;
    }
    const auto read = Clock::now();
    CGAL::spatial_sort(points.begin(), points.end());
    const auto sorted = Clock::now();
    Triangulation triangulation;
    Triangulation::Face_handle hint;
    for (const Kernel::Point_2 &point : points) hint = triangulation.insert(point, hint)->face();
    const auto inserted = Clock::now();
    std::printf("%.3f %.3f %.3f %.3f %zu\n", seconds(start, read), seconds(read, sorted),
                seconds(sorted, inserted), seconds(start, inserted),
                triangulation.number_of_faces());
}
