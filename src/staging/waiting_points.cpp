#include "staging/waiting_points.hpp"

#include <algorithm>

namespace abacus {

template <int D>
std::pair<typename WaitingPoints<D>::Wanted *, typename WaitingPoints<D>::Wanted *>
WaitingPoints<D>::at(const Point<D> &p) {
    const auto below = [](const Wanted &a, const Point<D> &b) { return a.point < b; };
    const auto above = [](const Point<D> &a, const Wanted &b) { return a < b.point; };
    return {std::lower_bound(wanted_.begin(), wanted_.end(), p, below),
            std::upper_bound(wanted_.begin(), wanted_.end(), p, above)};
}

/// Gives each want the first point with its coordinates and id that no other has.
template <int D> void WaitingPoints<D>::find(std::uint64_t from, std::uint64_t to) {
    VertexReader<D> reader(host_, attributes_, from, to);
    while (reader.advance()) {
        auto [want, end] = at(reader.point());
        want = std::find_if(want, end, [&](const Wanted &w) {
            return w.sequence == none && w.id == reader.id();
        });
        if (want != end) want->sequence = reader.sequence();
    }
}

/// Whether the point at hand goes: because it is one that find() found, or because it is
/// the first left for a want that found none, where any point will do.
template <int D> bool WaitingPoints<D>::is_wanted(const VertexReader<D> &reader) {
    const auto [begin, end] = at(reader.point());
    auto want = std::find_if(begin, end,
                             [&](const Wanted &w) { return w.sequence == reader.sequence(); });
    if (want == end && !by_id_)
        want = std::find_if(begin, end,
                            [](const Wanted &w) { return w.sequence == none && !w.taken; });
    if (want == end) return false;
    want->taken = true;
    return true;
}

template <int D> std::uint64_t WaitingPoints<D>::take(std::uint64_t &from, std::uint64_t &to) {
    std::sort(wanted_.begin(), wanted_.end(), [](const Wanted &a, const Wanted &b) {
        return a.point < b.point || (a.point == b.point && a.order < b.order);
    });
    find(from, to);
    std::uint64_t taken = 0;
    VertexReader<D> reader(host_, attributes_, from, to, true);
    VertexPageWriter left(host_, D, attributes_, to);
    while (reader.advance()) {
        if (is_wanted(reader)) ++taken;
        else left.add(reader.record());
    }
    left.finish();
    from = to;
    to = left.next();
    wanted_.clear();
    return taken;
}

template class WaitingPoints<2>;
template class WaitingPoints<3>;

} // namespace abacus
