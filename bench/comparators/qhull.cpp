// bench_qhull: what Qhull takes, with the options that SciPy gives it
// (scipy.spatial.Delaunay). The library is Debian's.
#include "comparator.hpp"

#include <libqhull_r/qhull_ra.h>

namespace {

/// Number of simplices of the lower hull, which is the Delaunay triangulation.
std::size_t simplices(qhT *qh) {
    std::size_t count = 0;
    facetT *facet; // the macro FORALLfacets needs a variable with this name
    FORALLfacets {
        if (!facet->upperdelaunay) ++count;
    }
    return count;
}

} // namespace

int main(int argc, char **argv) {
    return comparator::main(argc, argv, []<int D>(const char *path) {
        comparator::Stopwatch watch;
        std::vector<double> coordinates = comparator::read_coordinates<D>(path);
        watch.phase("read");
        qhT state;
        qhT *qh = &state;
        qh_zero(qh, stderr);
        char options[] = "qhull d Qt Qbb Qc Qz Q12";
        if (qh_new_qhull(qh, D, static_cast<int>(coordinates.size() / D), coordinates.data(), False,
                         options, nullptr, stderr) != 0)
            throw std::runtime_error("Qhull has failed");
        watch.phase("build");
        watch.print(simplices(qh));
    });
}
