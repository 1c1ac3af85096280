#include "points/spread.hpp"

#include "keys/domain_of.hpp"

#include <algorithm>
#include <bit>

namespace abacus {

namespace {
/// The logarithm of the number of points with one code that make a crowd: they take a good part of
/// a page.
constexpr int crowd_log = 5;
/// Share of the points that may be misplaced without harm.
constexpr std::size_t harmless = 16;
/// Room on either side of an interval of the sample, as a share of its extent: for points that are
/// not in the sample.
constexpr double room = 0.5;

bool is_far_less(std::size_t misplaced, std::size_t than) { return 2 * misplaced < than; }
} // namespace

/// Keeps each point once, and no more points than belong to the sample.
template <int D> void Spread<D>::cut() {
    std::sort(sample_.begin(), sample_.end(), [](const Drawn &a, const Drawn &b) {
        return a.hash < b.hash || (a.hash == b.hash && lexicographically_less<D>(a.point, b.point));
    });
    const auto is_same = [](const Drawn &a, const Drawn &b) { return a.point == b.point; };
    const Drawn *end = std::unique(sample_.begin(), sample_.end(), is_same);
    const auto distinct = static_cast<std::size_t>(end - sample_.begin());
    sample_.resize(std::min(distinct, most));
    if (distinct >= most) least_excluded_ = sample_.back().hash;
}

template <int D> std::size_t Spread<D>::misplaced_by(const Box<D> &box) {
    const Domain<D> domain = domain_around<D>(box.lower, box.upper);
    const Box<D> inside(domain.lower(), domain.upper());
    // The sample has one of 2^n points. In a cell of 2^m codes, a crowd has 2^(m + 5 - n) of it.
    // That number must be at least some points, so a cell may have to be larger than a code.
    const int n = std::countl_zero(least_excluded_);
    const int cell_bits = std::max(0, n + 1 - crowd_log);
    const std::size_t crowd = std::size_t{1} << (cell_bits + crowd_log - n);
    Arena<std::uint64_t> cells(host_);
    cells.reserve(sample_.size());
    for (const Drawn &drawn : sample_)
        if (inside.contains(drawn.point)) cells.push_back(domain.code(drawn.point) >> cell_bits);
    std::sort(cells.begin(), cells.end());
    std::size_t misplaced = sample_.size() - cells.size();
    for (std::size_t i = 0, next; i < cells.size(); i = next) {
        next = i + 1;
        while (next < cells.size() && cells[next] == cells[i]) ++next;
        if (next - i >= crowd) misplaced += next - i;
    }
    return misplaced;
}

/// On each axis, the shortest interval that contains all of the sample except a few points.
template <int D> Box<D> Spread<D>::all_but(std::size_t few, const Arena<double> &sorted) const {
    const std::size_t n = sample_.size();
    Box<D> box;
    for (int axis = 0; axis < D; ++axis) {
        const double *at = sorted.data() + axis * n, *shortest = at;
        for (const double *from = at; from <= at + few; ++from)
            if (from[n - 1 - few] - *from < shortest[n - 1 - few] - *shortest) shortest = from;
        const double lower = *shortest, upper = shortest[n - 1 - few];
        const double more = room * (upper - lower);
        box.lower[axis] = std::max(box_.lower[axis], lower - more);
        box.upper[axis] = std::min(box_.upper[axis], upper + more);
    }
    return box;
}

template <int D> Box<D> Spread<D>::choose(const Box<D> &first) {
    cut();
    Box<D> best = first;
    std::size_t misplaced = misplaced_by(first);
    const std::size_t n = sample_.size();
    const auto is_good = [&] { return misplaced <= n / harmless; };
    const auto offer = [&](const Box<D> &box) {
        const std::size_t of_box = misplaced_by(box);
        if (!is_far_less(of_box, misplaced)) return;
        best = box;
        misplaced = of_box;
    };
    if (is_good()) return best;
    offer(box_);
    if (is_good()) return best;

    Arena<double> sorted(host_);
    sorted.resize(D * n);
    for (int axis = 0; axis < D; ++axis) {
        double *at = sorted.data() + axis * n;
        for (std::size_t i = 0; i < n; ++i) at[i] = sample_[i].point[axis];
        std::sort(at, at + n);
    }
    for (std::size_t few = 0; few < n / 2; few = 2 * few + 1) offer(all_but(few, sorted));
    return best;
}

template <int D> bool Spread<D>::is_better(const Box<D> &box, const Box<D> &than) {
    cut();
    return is_far_less(misplaced_by(box), misplaced_by(than));
}

template class Spread<2>;
template class Spread<3>;

} // namespace abacus
