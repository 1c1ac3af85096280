#include "attributes/attribute_reader.hpp"

#include <algorithm>

namespace abacus {

namespace {

constexpr std::size_t fewest_held = 8, most_pages_held = 1 << 16;
/// Of the keys of a page, as a rule.
constexpr std::size_t key_bytes = most_written_in_attribute_page / 2 * sizeof(Key);

/// As far as a page may be read: a longer one is refused by its size.
void copy(const abacus_page &page, std::array<unsigned char, ABACUS_PAGE_BYTES> &bytes) {
    std::memcpy(bytes.data(), page.bytes, std::min(page.size, bytes.size()));
}

[[noreturn]] void throw_none() { throw_corrupted("A vertex has no attributes."); }

} // namespace

template <int D>
AttributeReader<D>::AttributeReader(const Host &host, const Domain<D> &domain, unsigned attributes,
                                    std::size_t bytes)
    : host_(host), domain_(domain), groups_(attributes), memory_(host),
      most_held_(std::max<std::size_t>(
          std::clamp(bytes / (sizeof(Held) + key_bytes), fewest_held, most_pages_held),
          groups_.count())),
      pages_(&memory_), by_key_(&memory_) {}

template <int D> void AttributeReader<D>::begin(const Point<D> &p) {
    if (is_asked_ && p == p_) return;
    is_asked_ = true;
    p_ = p;
    key_ = attribute_key<D>(p, domain_.code(p));
    found_ = {};
}

template <int D> auto AttributeReader<D>::make_room() -> Held & {
    if (pages_.size() < most_held_) return pages_.emplace_back(host_);
    for (;; ++hand_) {
        if (hand_ == pages_.size()) hand_ = 0;
        if (!pages_[hand_].is_used) break;
        pages_[hand_].is_used = false;
    }
    Held &held = pages_[hand_++];
    const auto entry = by_key_.find(held.lower);
    if (entry != by_key_.end() && entry->second == &held) by_key_.erase(entry);
    return held;
}

template <int D> void AttributeReader<D>::read(const Key &key, Held &held) {
    host_.poll();
    abacus_page page{};
    const unsigned group = group_of(key);
    if (!host_.find(ABACUS_ATTRIBUTE_PAGES, key, page) || group_of(page.key) != group) return;
    ++pages_read_;
    copy(page, held.bytes);
    held.page.read(held.bytes.data(), page.size, group, groups_.columns(group));
    held.page.keys(domain_, page.key, group_begin(group + 1), held.keys);
    if (held.keys.empty()) return;
    held.lower = page.key;
    held.last = held.keys.back();
    by_key_.insert_or_assign(held.lower, &held);
}

template <int D> auto AttributeReader<D>::page(const Key &key) -> Held * {
    const auto held_page = [&]() -> Held * {
        const auto after = by_key_.upper_bound(key);
        if (after == by_key_.begin()) return nullptr;
        Held *const held = std::prev(after)->second;
        return key <= held->last ? held : nullptr;
    };
    Held *held = held_page();
    if (held == nullptr) {
        found_ = {};
        read(key, make_room());
        held = held_page();
    }
    if (held != nullptr) held->is_used = true;
    return held;
}

template <int D> auto AttributeReader<D>::find(unsigned group) -> Found {
    if (found_.held != nullptr && found_group_ == group) return found_;
    const Key key = in_group(key_, group);
    Held *const held = page(key);
    if (held == nullptr) return {};
    const Key *at = std::lower_bound(held->keys.begin(), held->keys.end(), key, KeyBefore{});
    for (; at != held->keys.end() && *at == key; ++at) {
        const auto vertex = static_cast<std::size_t>(at - held->keys.begin());
        if (!(held->page.point(vertex) == p_)) continue;
        found_group_ = group;
        return found_ = {held, vertex};
    }
    return {};
}

template <int D> double AttributeReader<D>::value(const Point<D> &p, unsigned attribute) {
    begin(p);
    const unsigned group = groups_.group_of(attribute);
    const Found found = find(group);
    if (found.held == nullptr) throw_none();
    return found.held->page.value(found.vertex, attribute - groups_.first(group));
}

template <int D> void AttributeReader<D>::values(const Point<D> &p, double *values) {
    begin(p);
    for (unsigned group = 0; group < groups_.count(); ++group) {
        const Found found = find(group);
        if (found.held == nullptr) throw_none();
        for (unsigned i = 0; i < groups_.columns(group); ++i)
            *values++ = found.held->page.value(found.vertex, i);
    }
}

template <int D> bool AttributeReader<D>::contains(const Point<D> &p) {
    begin(p);
    for (unsigned group = 0; group < groups_.count(); ++group)
        if (find(group).held == nullptr) return false;
    return true;
}

template <int D> bool AttributeScan<D>::fetch() {
    host_.poll();
    abacus_page page{};
    if (!host_.next(ABACUS_ATTRIBUTE_PAGES, started_ ? &key_ : nullptr, page)) return false;
    started_ = true;
    key_ = page.key;
    size_ = page.size;
    copy(page, bytes_);
    return true;
}

template <int D> void AttributeScan<D>::read() {
    const bool begins = group() != last_group_;
    if (group() >= groups_.count() || (begins && !(key_ == group_begin(group()))))
        throw_corrupted("An attribute page lies where none can be.");
    // The last vertex of a page comes before the next page.
    if (!begins && key_ <= last_)
        throw_corrupted("An attribute page has vertices that another page owns.");
    page_.read(bytes_.data(), size_, group(), groups_.columns(group()));
    page_.keys(domain_, key_, group_begin(group() + 1), keys_);
    for (std::size_t v = 1; v < keys_.size(); ++v)
        if (keys_[v - 1] == keys_[v] && page_.point(v - 1) == page_.point(v))
            throw_corrupted("An attribute page has the same vertex twice.");
    last_group_ = group();
    last_ = keys_.empty() ? key_ : keys_.back();
}

template class AttributeReader<2>;
template class AttributeReader<3>;
template class AttributeScan<2>;
template class AttributeScan<3>;

} // namespace abacus
