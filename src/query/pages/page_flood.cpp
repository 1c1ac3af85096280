#include "query/pages/page_flood.hpp"

#include "keys/domain_of.hpp"
#include "mesh/page_attributes.hpp"

#include <algorithm>
#include <cstring>

namespace abacus {

namespace {

bool less(const Key &a, const Key &b) { return a < b; }

constexpr Key last_of(std::uint64_t code) { return {code, key_word_end - 1}; }

} // namespace

template <int D>
PageFlood<D>::PageFlood(const Host &host, const abacus_facts &facts)
    : host_(host), attributes_(page_attributes(facts.columns)), domain_(domain_of<D>(facts.form)),
      memory_(host), open_(&less, &memory_), read_(&less, &memory_), inner_links_(host),
      slots_(host), border_(host), on_border_(host) {
    slots_.resize(block_slots<D>);
}

template <int D> void PageFlood<D>::reach(const Key &key) {
    if (read_around(key) == nullptr) open_.emplace(key, false);
}

template <int D> void PageFlood<D>::reach_all(std::uint64_t code) {
    // Start with the last page.
    Key key = last_of(code);
    while (const Key *const lower = read_around(key)) {
        if (*lower <= Key{code, 0}) return;
        key = predecessor(*lower);
    }
    open_[key] = true;
}

template <int D> void PageFlood<D>::follow(int link) {
    const int n = view_.link_vertex(link);
    const std::uint64_t code =
        n < view_.vertices() ? domain_.code(view_.point(n)) : view_.foreign_code(n);
    const std::uint64_t part = view_.link_part(link);
    if (code >= key_word_end || (part >= key_word_end && part != unknown_part))
        throw_corrupted("A page has a link to an impossible key.");
    // A part of 0 may stand for any part: the code had no parts when the link was stored.
    if (part == 0 || part == unknown_part)
        reach_all(code);
    else
        reach({code, part});
}

template <int D> bool PageFlood<D>::advance() {
    if (is_again_) return advance_again();
    while (!open_.empty())
        if (take_open()) return true;
    return false;
}

template <int D> bool PageFlood<D>::take_open() {
    auto next = open_.lower_bound(at_);
    if (next == open_.end()) next = open_.begin();
    const auto [key, has_all] = *next;
    open_.erase(next);
    const bool is_new = read_around(key) == nullptr;
    if (is_new) {
        read(key);
        note_read(view_.lower(), view_.upper());
        at_ = view_.upper();
    }
    if (has_all) reach_all(key.code);
    return is_new;
}

template <int D> void PageFlood<D>::rewind() {
    is_again_ = true;
    at_ = first_key;
}

template <int D> bool PageFlood<D>::advance_again() {
    if (read_around(at_) == nullptr) {
        const auto next = read_.upper_bound(at_);
        if (next == read_.end()) return false;
        at_ = next->first;
    }
    read(at_);
    at_ = view_.upper();
    return true;
}

template <int D> void PageFlood<D>::read(const Key &key) {
    host_.poll();
    abacus_page page{};
    const bool is_there = host_.find(ABACUS_SIMPLEX_PAGES, key, page);
    if (is_there) {
        ++pages_read_;
        const std::size_t size = page.size;
        const Key lower = page.key;
        std::memcpy(copy_, page.bytes, std::min(size, sizeof copy_));
        view_.read(copy_, size, attributes_);
        if (!(view_.lower() == lower))
            throw_corrupted("A page is stored under another page's key.");
    }
    if (!is_there || !(key < view_.upper())) throw_corrupted("No page owns a part of the curve.");
}

template <int D> const Key *PageFlood<D>::read_around(const Key &key) const {
    auto interval = read_.upper_bound(key);
    if (interval == read_.begin()) return nullptr;
    --interval;
    return key < interval->second ? &interval->first : nullptr;
}

template <int D> void PageFlood<D>::note_read(Key lower, Key upper) {
    auto after = read_.upper_bound(lower);
    if ((after != read_.end() && after->first < upper) || read_around(lower) != nullptr)
        throw_corrupted("Two pages own the same part of the curve.");
    if (after != read_.end() && after->first == upper) {
        upper = after->second;
        after = read_.erase(after);
    }
    if (after != read_.begin() && std::prev(after)->second == lower)
        std::prev(after)->second = upper;
    else
        read_.emplace_hint(after, lower, upper);
}

template class PageFlood<2>;
template class PageFlood<3>;

} // namespace abacus
