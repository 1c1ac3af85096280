#include "points/waiting_points.hpp"

#include <algorithm>

namespace abacus {

/// Gives each want the first point with its coordinates and identity that no other has.
template <int D> void WaitingPoints<D>::find(std::uint64_t from, std::uint64_t to) {
    const auto below = [](const Wanted &a, const Wanted &b) {
        return a.point < b.point || (a.point == b.point && a.identity < b.identity);
    };
    std::sort(wanted_.begin(), wanted_.end(), below);
    found_.clear();
    found_again_ = 0;
    VertexReader<D> reader(host_, attributes_, from, to);
    while (reader.advance()) {
        const std::int64_t identity = identities_.find(reader.id(), reader.attributes());
        const Wanted given{reader.point(), identity, false, 0};
        const auto [begin, end] = std::equal_range(wanted_.begin(), wanted_.end(), given, below);
        // Of equal wants the first ones have got theirs.
        const auto want = std::partition_point(begin, end, [](const Wanted &w) { return w.is_met; });
        if (want == end) continue;
        want->is_met = true;
        found_.push_back(reader.sequence());
    }
    if (exactly_) return;
    Wanted *first = wanted_.begin();
    for (Wanted &w : wanted_) {
        if (!(w.point == first->point)) first = &w;
        first->unmet += !w.is_met;
    }
}

/// Whether the point at hand goes: because it is one that find() found, or because it is
/// the first left for a want that found none, where any point will do.
template <int D> bool WaitingPoints<D>::is_wanted(const VertexReader<D> &reader) {
    if (found_again_ < found_.size() && found_[found_again_] == reader.sequence()) {
        ++found_again_;
        return true;
    }
    const Point<D> p = reader.point();
    Wanted *const first = std::lower_bound(
        wanted_.begin(), wanted_.end(), p,
        [](const Wanted &a, const Point<D> &b) { return a.point < b; });
    if (first == wanted_.end() || !(first->point == p) || first->unmet == 0) return false;
    --first->unmet;
    return true;
}

template <int D> std::uint64_t WaitingPoints<D>::take(std::uint64_t &from, std::uint64_t &to) {
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
    identities_.clear();
    return taken;
}

template class WaitingPoints<2>;
template class WaitingPoints<3>;

} // namespace abacus
