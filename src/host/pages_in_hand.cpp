#include "host/pages_in_hand.hpp"

#include <algorithm>
#include <cstring>

namespace abacus {

void PagesInHand::begin(abacus_page_kind kind, std::size_t most_bytes) {
    pages_.reset();
    bytes_.reset();
    kind_ = kind;
    most_bytes_ = most_bytes;
    kept_ = {};
    stored_first_ = 0;
}

void PagesInHand::count(Count &count, const InHand &kept) {
    ++count.pages;
    count.new_versions += kept.location != 0;
    count.bytes += kept.size;
}

bool PagesInHand::keep(abacus_page_kind kind, abacus_page &page) {
    constexpr std::size_t aligned = 8;
    const std::size_t size = (page.size + aligned - 1) / aligned * aligned;
    if (kind != kind_ || bytes_.size() + size > most_bytes_) return false;
    const std::size_t begin = bytes_.size();
    std::memcpy(bytes_.extend(size), page.bytes, page.size);
    pages_.push_back({page.key, page.location, begin, page.size, false, false});
    count(kept_, pages_.back());
    page.location = in_hand_bit;
    return true;
}

void PagesInHand::end(const Host &host) {
    most_bytes_ = 0;
    std::sort(pages_.begin(), pages_.end(),
              [](const InHand &a, const InHand &b) { return is_less(a.key, b.key); });
    abacus_page any;
    are_all_ = !pages_.empty() && !host.next(kind_, nullptr, any);
}

PagesInHand::Count PagesInHand::store(const Host &host) {
    Count stored;
    for (InHand &kept : pages_) {
        if (kept.is_gone) continue;
        abacus_page page{kept.key, bytes_.data() + kept.begin, kept.size, kept.location};
        host.put(kind_, page);
        host.poll();
        count(stored, kept);
    }
    pages_.reset();
    bytes_.reset();
    return stored;
}

PagesInHand::InHand *PagesInHand::at(std::uint64_t location) {
    const std::uint64_t number = location & ~in_hand_bit;
    if (number >= pages_.size() || pages_[number].is_gone)
        throw Error(ABACUS_ERROR_INTERNAL, "a page in hand is named that is not there");
    return &pages_[number];
}

PagesInHand::InHand *PagesInHand::after(const abacus_key &key) {
    return std::upper_bound(
        pages_.begin(), pages_.end(), key,
        [](const abacus_key &k, const InHand &kept) { return is_less(k, kept.key); });
}

void PagesInHand::hand_out(InHand &kept, abacus_page &page) {
    kept.is_handed_out = true;
    page.key = kept.key;
    page.bytes = bytes_.data() + kept.begin;
    page.size = kept.size;
    page.location = in_hand_bit | static_cast<std::uint64_t>(&kept - pages_.data());
}

bool PagesInHand::find(const Host &host, abacus_page_kind kind, abacus_key key, abacus_page &page) {
    if (kind != kind_ || pages_.empty()) return host.find(kind, key, page);
    InHand *kept = after(key);
    const bool is_owner =
        are_all_ && kept != pages_.begin() && !kept[-1].is_gone && !kept[-1].is_handed_out;
    while (kept != pages_.begin() && kept[-1].is_gone) --kept;
    InHand *const floor = kept == pages_.begin() ? nullptr : kept - 1;
    if (!is_owner && host.find(kind, key, page) &&
        (floor == nullptr || is_less(floor->key, page.key)))
        return true;
    if (floor != nullptr) hand_out(*floor, page);
    return floor != nullptr;
}

bool PagesInHand::fetch(const Host &host, abacus_page_kind kind, abacus_page &page) {
    if (!has(kind, page)) return host.fetch(kind, page);
    hand_out(*at(page.location), page);
    return true;
}

bool PagesInHand::next(const Host &host, abacus_page_kind kind, const abacus_key *key,
                       abacus_page &page) {
    if (kind != kind_ || pages_.empty()) return host.next(kind, key, page);
    InHand *kept = key == nullptr ? pages_.begin() : after(*key);
    while (kept != pages_.end() && kept->is_gone) ++kept;
    const bool is_there = kept != pages_.end();
    if (host.next(kind, key, page) && !(is_there && !is_less(page.key, kept->key))) return true;
    if (is_there) hand_out(*kept, page);
    return is_there;
}

void PagesInHand::put(const Host &host, abacus_page_kind kind, abacus_page &page) {
    if (has(kind, page)) {
        InHand &kept = *at(page.location);
        kept.is_gone = true;
        page.location = kept.location;
        stored_first_ += kept.location == 0;
    }
    host.put(kind, page);
}

void PagesInHand::erase(const Host &host, abacus_page_kind kind, const abacus_page &page) {
    if (!has(kind, page)) return host.erase(kind, page);
    InHand &kept = *at(page.location);
    kept.is_gone = true;
    if (kept.location != 0) host.erase(kind, {kept.key, nullptr, 0, kept.location});
}

} // namespace abacus
