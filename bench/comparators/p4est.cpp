// bench_p4est: what p4est takes to make an octree of points in memory, one in a leaf at most, to
// balance it across corners, and to number its nodes. Of the points in the unit square or cube that
// a file has. The library is Debian's, and GPL: it is linked into this program and the oracle only.
#include "comparator.hpp"

#include <mpi.h>

#include <p4est_bits.h>
#include <p4est_extended.h>
#include <p4est_ghost.h>
#include <p4est_lnodes.h>
#include <p8est_bits.h>
#include <p8est_extended.h>
#include <p8est_ghost.h>
#include <p8est_lnodes.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace {

template <int D> struct Names;

template <> struct Names<2> {
    using Forest = p4est_t;
    using Quadrant = p4est_quadrant_t;
    static constexpr int levels = P4EST_MAXLEVEL, finest = P4EST_QMAXLEVEL;

    static std::array<std::int32_t, 2> corner(const Quadrant &q) { return {q.x, q.y}; }
    static Forest *forest(void *user) {
        return p4est_new_ext(sc_MPI_COMM_WORLD, p4est_connectivity_new_unitsquare(), 0, 0, 1, 0,
                             nullptr, user);
    }
    static void refine(Forest *f, p4est_refine_t split) { p4est_refine(f, 1, split, nullptr); }
    static void balance(Forest *f) { p4est_balance(f, P4EST_CONNECT_FULL, nullptr); }
    static auto nodes(Forest *f) {
        return p4est_lnodes_new(f, p4est_ghost_new(f, P4EST_CONNECT_FULL), 1);
    }
};

template <> struct Names<3> {
    using Forest = p8est_t;
    using Quadrant = p8est_quadrant_t;
    static constexpr int levels = P8EST_MAXLEVEL, finest = P8EST_QMAXLEVEL;

    static std::array<std::int32_t, 3> corner(const Quadrant &q) { return {q.x, q.y, q.z}; }
    static Forest *forest(void *user) {
        return p8est_new_ext(sc_MPI_COMM_WORLD, p8est_connectivity_new_unitcube(), 0, 0, 1, 0,
                             nullptr, user);
    }
    static void refine(Forest *f, p8est_refine_t split) { p8est_refine(f, 1, split, nullptr); }
    static void balance(Forest *f) { p8est_balance(f, P8EST_CONNECT_FULL, nullptr); }
    static auto nodes(Forest *f) {
        return p8est_lnodes_new(f, p8est_ghost_new(f, P8EST_CONNECT_FULL), 1);
    }
};

/// Place on the Morton curve: bits of coordinates that count cells, D * levels in all.
template <int D> std::uint64_t place(const std::array<std::int32_t, D> &cell) {
    std::uint64_t code = 0;
    for (int bit = 0; bit < Names<D>::levels; ++bit)
        for (int i = 0; i < D; ++i)
            code |= static_cast<std::uint64_t>(cell[i] >> bit & 1) << (D * bit + i);
    return code;
}

/// Whether more than one point lies in a quadrant; places are sorted.
template <int D>
int is_split(typename Names<D>::Forest *forest, p4est_topidx_t, typename Names<D>::Quadrant *q) {
    if (q->level == Names<D>::finest) return 0;
    const auto &places = *static_cast<const std::vector<std::uint64_t> *>(forest->user_pointer);
    const std::uint64_t begin = place<D>(Names<D>::corner(*q));
    const std::uint64_t end = begin + (std::uint64_t{1} << (D * (Names<D>::levels - q->level)));
    const auto first = std::lower_bound(places.begin(), places.end(), begin);
    return places.end() - first > 1 && first[1] < end;
}

template <int D> void run(const char *path) {
    comparator::Stopwatch watch;
    std::vector<std::uint64_t> places;
    comparator::for_each_point<D>(path, [&](const double *x) {
        std::array<std::int32_t, D> cell;
        for (int i = 0; i < D; ++i)
            cell[i] = static_cast<std::int32_t>(std::ldexp(x[i], Names<D>::levels));
        places.push_back(place<D>(cell));
    });
    watch.phase("read");
    std::sort(places.begin(), places.end());
    auto *const forest = Names<D>::forest(&places);
    Names<D>::refine(forest, is_split<D>);
    watch.phase("construct");
    Names<D>::balance(forest);
    watch.phase("balance");
    Names<D>::nodes(forest);
    watch.phase("extract");
    watch.print(static_cast<std::size_t>(forest->local_num_quadrants));
}

} // namespace

int main(int argc, char **argv) {
    sc_MPI_Init(&argc, &argv);
    sc_init(sc_MPI_COMM_WORLD, 0, 0, nullptr, SC_LP_ERROR);
    p4est_init(nullptr, SC_LP_ERROR);
    const int status = comparator::main(argc, argv, []<int D>(const char *path) { run<D>(path); });
    sc_MPI_Finalize();
    return status;
}
