// bench_cgal_parallel: what CGAL takes to build the triangulation in space in core, with several
// threads.
//
//   bench_cgal_parallel 3 FILE THREADS
//
// The points are sorted in parallel along a curve and inserted by the threads of TBB. Each locks
// the cells of a grid in which it works; the grid has 50 cells along each axis, as in CGAL's
// example. In all else it is what bench_cgal does. In the plane CGAL has no parallel triangulation.
//
// CGAL's triangulations are GPL: this program is a benchmark and not a part of
// the extension.
#include "comparator.hpp"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <tbb/global_control.h>

#include <cstdlib>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Structure =
    CGAL::Triangulation_data_structure_3<CGAL::Triangulation_vertex_base_3<Kernel>,
                                         CGAL::Delaunay_triangulation_cell_base_3<Kernel>,
                                         CGAL::Parallel_tag>;
using Triangulation = CGAL::Delaunay_triangulation_3<Kernel, Structure>;

namespace {

constexpr int cells_of_an_axis = 50;

template <int D> void run(const char *path) {
    if constexpr (D == 3) {
        comparator::Stopwatch watch;
        std::vector<Triangulation::Point> points;
        CGAL::Bbox_3 box;
        comparator::for_each_point<3>(path, [&](const double *x) {
            points.emplace_back(x[0], x[1], x[2]);
            box += points.back().bbox();
        });
        watch.phase("read");
        Triangulation::Lock_data_structure locks(box, cells_of_an_axis);
        const Triangulation triangulation(points.begin(), points.end(), &locks);
        watch.phase("build");
        watch.print(triangulation.number_of_finite_cells());
    } else {
        throw std::runtime_error("CGAL's parallel triangulation is for dimension 3");
    }
}

} // namespace

int main(int argc, char **argv) {
    const int threads = argc == 4 ? std::atoi(argv[3]) : 0;
    if (threads < 1) {
        std::fprintf(stderr, "usage: %s 3 FILE_OF_RAW_POINTS THREADS\n", argv[0]);
        return 2;
    }
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    return comparator::main(3, argv, []<int D>(const char *path) { run<D>(path); });
}
