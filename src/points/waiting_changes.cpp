#include "points/waiting_changes.hpp"

#include <algorithm>

namespace abacus {

template <int D> void WaitingChanges<D>::want(const std::uint64_t *record) {
    Wanted wanted{};
    wanted.point = record_point<D>(record);
    wanted.id = record_id(record);
    wanted.order = static_cast<std::uint32_t>(wanted_.size());
    wanted.first = wanted.with_id = none;
    wanted_.push_back(wanted);
    std::copy_n(record + 1 + D, which_.size(), values_.extend(which_.size()));
}

template <int D> void WaitingChanges<D>::find_points(std::uint64_t from, std::uint64_t to) {
    const auto at_place = [](const Wanted &a, const Wanted &b) { return a.point < b.point; };
    const auto by_id = [](const Wanted &a, const Wanted &b) { return a.id < b.id; };
    std::sort(wanted_.begin(), wanted_.end(), [](const Wanted &a, const Wanted &b) {
        if (!(a.point == b.point)) return a.point < b.point;
        return a.id < b.id || (a.id == b.id && a.order < b.order);
    });
    VertexReader<D> reader(host_, attributes_, from, to);
    while (reader.advance()) {
        Wanted given{};
        given.point = reader.point();
        given.id = reader.id();
        const auto [first, last] =
            std::equal_range(wanted_.begin(), wanted_.end(), given, at_place);
        if (first == last) continue;
        first->first = std::min(first->first, reader.sequence());
        const auto same = std::lower_bound(first, last, given, by_id);
        if (same != last && same->id == given.id)
            same->with_id = std::min(same->with_id, reader.sequence());
    }
}

template <int D> std::uint64_t WaitingChanges<D>::choose() {
    std::uint64_t missing = none;
    const Wanted *place = wanted_.begin(), *same = place;
    for (const Wanted *w = wanted_.begin(); w != wanted_.end(); ++w) {
        if (!(w->point == place->point)) place = same = w;
        if (w->id != same->id) same = w;
        const std::uint64_t sequence = same->with_id != none ? same->with_id : place->first;
        if (sequence == none)
            missing = std::min<std::uint64_t>(missing, w->order);
        else
            found_.push_back({sequence, w->order});
    }
    std::sort(found_.begin(), found_.end(), [](const Found &a, const Found &b) {
        return a.sequence < b.sequence || (a.sequence == b.sequence && a.order < b.order);
    });
    return missing;
}

/// Writes each page once.
template <int D> void WaitingChanges<D>::write() {
    const std::size_t stride = record_words(D, attributes_);
    std::uint64_t words[ABACUS_MAX_PAGE_BYTES / 8];
    for (const Found *found = found_.begin(); found != found_.end();) {
        host_.poll();
        abacus_page page;
        if (!host_.find(ABACUS_STAGED_PAGES, {found->sequence, 0}, page) ||
            page.size > sizeof words)
            throw_corrupted("A vertex page is missing or too large.");
        std::memcpy(words, page.bytes, page.size);
        const std::uint64_t end =
            page.key.code + VertexPage<D>(words, page.size, attributes_, page.key).size();
        std::uint64_t *const records = words + VertexPageHeader::words;
        for (; found != found_.end() && found->sequence < end; ++found) {
            std::uint64_t *record = records + (found->sequence - page.key.code) * stride;
            const std::uint64_t *values = values_.data() + found->order * which_.size();
            for (std::size_t i = 0; i < which_.size(); ++i) record[1 + D + which_[i]] = values[i];
        }
        page.bytes = reinterpret_cast<const unsigned char *>(words);
        host_.put(ABACUS_STAGED_PAGES, page);
    }
}

template <int D>
std::uint64_t WaitingChanges<D>::apply(std::uint64_t from, std::uint64_t to,
                                       std::optional<std::array<std::uint64_t, 1 + D>> &missing) {
    find_points(from, to);
    const std::uint64_t order = choose();
    if (order != none && !missing)
        for (const Wanted &w : wanted_)
            if (w.order == order)
                fill_record<D>(missing.emplace().data(), w.id, w.point, nullptr, 0);
    write();
    const std::uint64_t changed = found_.size();
    wanted_.clear();
    values_.clear();
    found_.clear();
    return changed;
}

template class WaitingChanges<2>;
template class WaitingChanges<3>;

} // namespace abacus
