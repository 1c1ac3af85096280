// bench_p4est: what p4est takes to make an octree of points in memory, with at most one point in a
// leaf, to balance it across corners, and to number its nodes. The points of the file lie in the
// unit square or cube. The library is Debian's, and GPL: it is linked only into this program and
// the oracle.
#include "oracle/p4est.hpp"
#include "comparator.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace {

using abacus::test::Foreign;

/// A place on the Morton curve: bits of coordinates that count cells, D * levels in all.
template <int D> std::uint64_t place(const std::array<std::uint32_t, D> &cell) {
    std::uint64_t code = 0;
    for (int bit = 0; bit < Foreign<D>::levels; ++bit)
        for (int i = 0; i < D; ++i)
            code |= static_cast<std::uint64_t>(cell[i] >> bit & 1) << (D * bit + i);
    return code;
}

/// Whether more than one point lies in a quadrant; places are sorted.
template <int D>
int is_split(typename Foreign<D>::Forest *forest, p4est_topidx_t,
             typename Foreign<D>::Quadrant *q) {
    if (q->level == Foreign<D>::finest) return 0;
    const auto &places = *static_cast<const std::vector<std::uint64_t> *>(forest->user_pointer);
    const std::uint64_t begin = place<D>(Foreign<D>::cell(q));
    const std::uint64_t end = begin + (std::uint64_t{1} << (D * (Foreign<D>::levels - q->level)));
    const auto first = std::lower_bound(places.begin(), places.end(), begin);
    return places.end() - first > 1 && first[1] < end;
}

template <int D> void run(const char *path) {
    comparator::Stopwatch watch;
    std::vector<std::uint64_t> places;
    comparator::for_each_point<D>(path, [&](const double *x) {
        std::array<std::uint32_t, D> cell;
        for (int i = 0; i < D; ++i)
            cell[i] = static_cast<std::uint32_t>(std::ldexp(x[i], Foreign<D>::levels));
        places.push_back(place<D>(cell));
    });
    watch.phase("read");
    std::sort(places.begin(), places.end());
    auto *const unit = Foreign<D>::unit();
    auto *const forest = Foreign<D>::forest(unit, &places);
    Foreign<D>::refine(forest, is_split<D>);
    watch.phase("construct");
    Foreign<D>::balance(forest, D);
    watch.phase("balance");
    auto *const nodes = Foreign<D>::nodes(forest);
    watch.phase("extract");
    watch.print(static_cast<std::size_t>(forest->local_num_quadrants));
    Foreign<D>::destroy(nodes);
    Foreign<D>::destroy(forest);
    Foreign<D>::destroy(unit);
}

} // namespace

int main(int argc, char **argv) {
    return abacus::test::with_p4est(argc, argv, [&] {
        return comparator::main(argc, argv, []<int D>(const char *path) { run<D>(path); });
    });
}
