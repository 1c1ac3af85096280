// bench_cgal: what CGAL takes to build the triangulation in memory.
//
// The points are sorted along a curve and inserted one by one, each from the one before, as
// Delaunay_triangulation_2 and _3 do for a range. Both are the plain sequential versions with the
// default policies. In 3D this means Compact_location: after a spatial sort the hint is better than
// the hierarchy of Fast_location, which only costs its upkeep.
//
// CGAL's triangulations are GPL: this program is a benchmark and not a part of
// the extension.
#include "comparator.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/spatial_sort.h>

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

template <int D> std::vector<typename Delaunay<D>::Point> read_points(const char *path) {
    std::vector<typename Delaunay<D>::Point> points;
    comparator::for_each_point<D>(
        path, [&](const double *x) { points.push_back(Delaunay<D>::point(x)); });
    return points;
}

} // namespace

int main(int argc, char **argv) {
    return comparator::main(argc, argv, []<int D>(const char *path) {
        comparator::Stopwatch watch;
        auto points = read_points<D>(path);
        watch.phase("read");
        CGAL::spatial_sort(points.begin(), points.end());
        watch.phase("sort");
        typename Delaunay<D>::Triangulation triangulation;
        typename Delaunay<D>::Cell hint;
        for (const auto &point : points)
            hint = Delaunay<D>::cell(triangulation.insert(point, hint));
        watch.phase("insert");
        watch.print(Delaunay<D>::simplices(triangulation));
    });
}
