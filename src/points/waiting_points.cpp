#include "points/waiting_points.hpp"

#include <algorithm>

namespace abacus {

/// Finds the points that the wants of a place can take: as many first points as there are wants,
/// and after them, for each identity, as many as are wanted.
template <int D> void WaitingPoints<D>::find_candidates(std::uint64_t from, std::uint64_t to) {
    const auto at_place = [](const Wanted &a, const Wanted &b) { return a.point < b.point; };
    const auto by_identity = [](const Wanted &a, const Wanted &b) {
        return a.identity < b.identity;
    };
    std::sort(wanted_.begin(), wanted_.end(), [&](const Wanted &a, const Wanted &b) {
        if (!(a.point == b.point)) return a.point < b.point;
        return a.identity < b.identity || (a.identity == b.identity && a.order < b.order);
    });
    candidates_.clear();
    VertexReader<D> reader(host_, attributes_, from, to);
    while (reader.advance()) {
        Wanted given{reader.point(), 0, 0, 0, 0};
        const auto [first, last] =
            std::equal_range(wanted_.begin(), wanted_.end(), given, at_place);
        if (first == last) continue;
        given.identity = identities_.find(reader.id(), reader.attributes());
        const auto [same, end] = std::equal_range(first, last, given, by_identity);
        const auto times = static_cast<std::uint32_t>(end - same);
        const bool is_behind = first->offered >= static_cast<std::uint32_t>(last - first);
        if (times == 0 ? is_behind || exactly_ : is_behind && same->behind == times) continue;
        ++first->offered;
        if (times != 0) same->behind += is_behind;
        candidates_.push_back({static_cast<std::uint32_t>(first - wanted_.begin()),
                               reader.sequence(), given.identity});
    }
}

/// For each place, its wants choose among its candidates in their order.
template <int D> void WaitingPoints<D>::choose() {
    found_.clear();
    std::sort(candidates_.begin(), candidates_.end(), [](const Candidate &a, const Candidate &b) {
        return a.place < b.place || (a.place == b.place && a.sequence < b.sequence);
    });
    const auto is_earlier = [](const Wanted &a, const Wanted &b) { return a.order < b.order; };
    for (const Candidate *c = candidates_.begin(); c != candidates_.end();) {
        Wanted *const first = wanted_.begin() + c->place;
        Wanted *last = first;
        while (last != wanted_.end() && last->point == first->point) ++last;
        std::sort(first, last, is_earlier);
        leaving_.clear();
        for (const Wanted *w = first; w != last; ++w) leaving_.want(w->identity, nullptr);
        leaving_.begin();
        const Candidate *const here = c;
        for (; c != candidates_.end() && c->place == here->place; ++c)
            leaving_.offer(c->identity, nullptr, c->sequence);
        leaving_.decide();
        if (leaving_.has_first()) found_.push_back(here->sequence);
        leaving_.each_other([&](std::uint64_t sequence) { found_.push_back(sequence); });
        host_.poll();
    }
    leaving_.clear();
    std::sort(found_.begin(), found_.end());
}

/// Writes the points that do not leave after the last page, and erases the pages it has read.
template <int D>
template <class Leaves>
std::uint64_t WaitingPoints<D>::take_those(std::uint64_t &from, std::uint64_t &to, Leaves leaves) {
    std::uint64_t taken = 0;
    VertexReader<D> reader(host_, attributes_, from, to, true);
    VertexPageWriter left(host_, D, attributes_, to);
    while (reader.advance()) {
        if (leaves(reader, taken))
            ++taken;
        else
            left.add(reader.record());
    }
    left.finish();
    from = to;
    to = left.next();
    wanted_.clear();
    identities_.clear();
    return taken;
}

template <int D> std::uint64_t WaitingPoints<D>::take(std::uint64_t &from, std::uint64_t &to) {
    find_candidates(from, to);
    choose();
    return take_those(from, to, [&](const VertexReader<D> &reader, std::uint64_t taken) {
        return taken < found_.size() && found_[taken] == reader.sequence();
    });
}

template <int D> std::uint64_t WaitingPoints<D>::take_all(std::uint64_t &from, std::uint64_t &to) {
    const auto is_before = [](const Wanted &a, const Wanted &b) { return a.point < b.point; };
    std::sort(wanted_.begin(), wanted_.end(), is_before);
    return take_those(from, to, [&](const VertexReader<D> &reader, std::uint64_t) {
        const Wanted given{reader.point(), 0, 0, 0, 0};
        const bool leaves = std::binary_search(wanted_.begin(), wanted_.end(), given, is_before);
        if (leaves) last_taken_ = reader.id();
        return leaves;
    });
}

template class WaitingPoints<2>;
template class WaitingPoints<3>;

} // namespace abacus
