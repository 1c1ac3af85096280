// bench_cgal_lines: what CGAL takes to build the constrained Delaunay triangulation in memory.
//
//   bench_cgal_lines FILE_OF_RAW_POINTS FILE_OF_SEGMENTS
//
// The points are sorted and inserted as in bench_cgal; their ids count from 1. A segment is a pair
// of ids (64 bits each). Segments may meet and overlap, but not cross: then no place is computed,
// and CGAL is exact.
//
// CGAL's triangulations are GPL: this program is a benchmark and not a part of
// the extension.
#include "comparator.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/spatial_sort.h>

#include <array>
#include <cstddef>
#include <numeric>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Default, CGAL::No_constraint_intersection_requiring_constructions_tag>;
using Segment = std::array<std::int64_t, 2>;

std::vector<Segment> read_segments(const char *path) {
    std::FILE *file = std::fopen(path, "rb");
    if (file == nullptr) throw std::runtime_error(std::string("cannot open ") + path);
    std::vector<Segment> segments, part(1 << 14);
    while (const std::size_t count = std::fread(part.data(), sizeof(Segment), part.size(), file))
        segments.insert(segments.end(), part.begin(), part.begin() + std::ptrdiff_t(count));
    std::fclose(file);
    return segments;
}

void run(const char *points_path, const char *segments_path) {
    comparator::Stopwatch watch;
    std::vector<Kernel::Point_2> points;
    comparator::for_each_point<2>(points_path,
                                  [&](const double *x) { points.emplace_back(x[0], x[1]); });
    const std::vector<Segment> segments = read_segments(segments_path);
    watch.phase("read");
    std::vector<std::ptrdiff_t> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    CGAL::spatial_sort(
        order.begin(), order.end(),
        CGAL::Spatial_sort_traits_adapter_2<Kernel, const Kernel::Point_2 *>(points.data()));
    watch.phase("sort");
    Triangulation triangulation;
    std::vector<Triangulation::Vertex_handle> vertices(points.size());
    Triangulation::Face_handle hint;
    for (const std::ptrdiff_t n : order) {
        vertices[std::size_t(n)] = triangulation.insert(points[std::size_t(n)], hint);
        hint = vertices[std::size_t(n)]->face();
    }
    watch.phase("insert");
    for (const auto &[a, b] : segments)
        triangulation.insert_constraint(vertices.at(std::size_t(a - 1)),
                                        vertices.at(std::size_t(b - 1)));
    watch.phase("constrain");
    watch.print(triangulation.number_of_faces());
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: %s FILE_OF_RAW_POINTS FILE_OF_SEGMENTS\n", argv[0]);
        return 2;
    }
    try {
        run(argv[1], argv[2]);
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
        return 1;
    }
}
