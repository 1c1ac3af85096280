// bench_cgal: what CGAL takes to build the triangulation in core.
//
//   bench_cgal DIMENSION FILE
//
// Reads raw records (int64 id, then a double a coordinate; see oracle_points),
// sorts them along a curve and inserts them one by one, each from the one before, as
// Delaunay_triangulation_2 and _3 do for a range. Both are the plain sequential
// ones with the default policies; in 3D this means Compact_location: after a
// spatial sort the hint is better than the hierarchy of Fast_location, which only
// adds its upkeep. Prints seconds: read, sort, insert, total; and the number of
// simplices.
//
// CGAL's triangulations are GPL: this program is a benchmark and not a part of
// the extension.
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/spatial_sort.h>

#include <chrono>
#include <cstdio>
#include <cstring>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

namespace {

template <int D> struct Delaunay;

template <> struct Delaunay<2> {
    using Triangulation = CGAL::Delaunay_triangulation_2<Kernel>;
    using Point = Kernel::Point_2;
    using Cell = Triangulation::Face_handle;
    static Point point(const double *x) { return {x[0], x[1]}; }
    static Cell cell(Triangulation::Vertex_handle vertex) { return vertex->face(); }
    static std::size_t simplices(const Triangulation &t) { return t.number_of_faces(); }
};

template <> struct Delaunay<3> {
    using Triangulation = CGAL::Delaunay_triangulation_3<Kernel>;
    using Point = Kernel::Point_3;
    using Cell = Triangulation::Cell_handle;
    static Point point(const double *x) { return {x[0], x[1], x[2]}; }
    static Cell cell(Triangulation::Vertex_handle vertex) { return vertex->cell(); }
    static std::size_t simplices(const Triangulation &t) { return t.number_of_finite_cells(); }
};

template <int D>
bool read_points(const char *path, std::vector<typename Delaunay<D>::Point> &points) {
    struct Record {
        std::int64_t id;
        double x[D];
    };
    std::FILE *file = std::fopen(path, "rb");
    if (file == nullptr) return false;
    std::vector<Record> records(1 << 14);
    while (const std::size_t count =
               std::fread(records.data(), sizeof(Record), records.size(), file))
        for (std::size_t i = 0; i < count; ++i) points.push_back(Delaunay<D>::point(records[i].x));
    std::fclose(file);
    return true;
}

template <int D> int run(const char *path) {
    using Clock = std::chrono::steady_clock;
    const auto seconds = [](Clock::time_point from, Clock::time_point to) {
        return std::chrono::duration<double>(to - from).count();
    };
    const auto start = Clock::now();
    std::vector<typename Delaunay<D>::Point> points;
    if (!read_points<D>(path, points)) {
        std::fprintf(stderr, "bench_cgal: cannot open %s\n", path);
        return 2;
    }
    const auto read = Clock::now();
    CGAL::spatial_sort(points.begin(), points.end());
    const auto sorted = Clock::now();
    typename Delaunay<D>::Triangulation triangulation;
    typename Delaunay<D>::Cell hint;
    for (const auto &point : points) hint = Delaunay<D>::cell(triangulation.insert(point, hint));
    const auto inserted = Clock::now();
    std::printf("%.3f %.3f %.3f %.3f %zu\n", seconds(start, read), seconds(read, sorted),
                seconds(sorted, inserted), seconds(start, inserted),
                Delaunay<D>::simplices(triangulation));
    return 0;
}

} // namespace

int main(int argc, char **argv) {
    if (argc == 3 && std::strcmp(argv[1], "2") == 0) return run<2>(argv[2]);
    if (argc == 3 && std::strcmp(argv[1], "3") == 0) return run<3>(argv[2]);
    std::fprintf(stderr, "usage: bench_cgal 2|3 FILE_OF_RAW_POINTS\n");
    return 2;
}
