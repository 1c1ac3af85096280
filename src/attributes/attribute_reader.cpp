#include "attributes/attribute_reader.hpp"

#include <algorithm>

namespace abacus {

namespace {

constexpr std::size_t fewest_held = 8, most_pages_held = 1 << 16;
/// What the keys of a page take as a rule.
constexpr std::size_t key_bytes = most_written_in_attribute_page / 2 * sizeof(Key);

/// Copies at most the largest size of a page. The reader rejects a longer page by its size.
void copy(const abacus_page &page, std::array<unsigned char, ABACUS_PAGE_BYTES> &bytes) {
    std::memcpy(bytes.data(), page.bytes, std::min(page.size, bytes.size()));
}

/// Finds the first page of a group or of a later one.
bool find_first(const Host &host, unsigned group, abacus_page &page) {
    if (group == 0) return host.next(ABACUS_ATTRIBUTE_PAGES, nullptr, page);
    const Key before = predecessor(group_begin(group));
    return host.next(ABACUS_ATTRIBUTE_PAGES, &before, page);
}

} // namespace

template <int D, int K>
AttributeReader<D, K>::AttributeReader(const Host &host, const Domain<D> &domain,
                                       unsigned attributes, std::size_t bytes, unsigned first)
    : host_(host), domain_(domain), groups_(attributes), first_(first), memory_(host),
      most_held_(std::max<std::size_t>(
          std::clamp(bytes / (sizeof(Held) + key_bytes), fewest_held, most_pages_held),
          groups_.count())),
      pages_(&memory_), by_key_(&memory_) {}

template <int D, int K> void AttributeReader<D, K>::begin(const Name &owner) {
    if (is_asked_ && owner == owner_) return;
    is_asked_ = true;
    owner_ = owner;
    key_ = attribute_key<D, K>(owner, code_of<D, K>(domain_, owner));
    found_ = {};
}

template <int D, int K> auto AttributeReader<D, K>::make_room() -> Held & {
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

template <int D, int K> void AttributeReader<D, K>::read(const Key &key, Held &held) {
    host_.poll();
    abacus_page page{};
    const unsigned group = group_of(key);
    if (!host_.find(ABACUS_ATTRIBUTE_PAGES, key, page) || group_of(page.key) != group) return;
    ++pages_read_;
    copy(page, held.bytes);
    held.page.read(held.bytes.data(), page.size, group, columns(group));
    Key upper = group_begin(group + 1);
    held.lower = page.key;
    if (K > 1 && host_.next(ABACUS_ATTRIBUTE_PAGES, &held.lower, page) && page.key < upper)
        upper = page.key;
    held.page.keys(domain_, held.lower, upper, held.keys);
    if (K == 1 && held.keys.empty()) return;
    held.last = K == 1 ? held.keys.back() : predecessor(upper);
    by_key_.insert_or_assign(held.lower, &held);
}

template <int D, int K> auto AttributeReader<D, K>::page(const Key &key) -> Held * {
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

template <int D, int K> auto AttributeReader<D, K>::find(unsigned group) -> Found {
    if (found_.held != nullptr && found_group_ == group) return found_;
    const Key key = in_group(key_, first_ + group);
    Held *const held = page(key);
    if (held == nullptr) return {};
    const Key *at = std::lower_bound(held->keys.begin(), held->keys.end(), key, KeyBefore{});
    for (; at != held->keys.end() && *at == key; ++at) {
        const auto row = static_cast<std::size_t>(at - held->keys.begin());
        if (!(held->page.owner(row) == owner_)) continue;
        found_group_ = group;
        return found_ = {held, row};
    }
    return {};
}

template <int D, int K> double AttributeReader<D, K>::value(const Name &owner, unsigned attribute) {
    begin(owner);
    const unsigned group = groups_.group_of(attribute);
    const Found found = find(group);
    if (found.held == nullptr) throw_no_attributes<D, K>();
    return found.held->page.value(found.row, attribute - groups_.first(group));
}

template <int D, int K> void AttributeReader<D, K>::values(const Name &owner, double *values) {
    if (!values_if_any(owner, values)) throw_no_attributes<D, K>();
}

template <int D, int K>
bool AttributeReader<D, K>::values_if_any(const Name &owner, double *values) {
    begin(owner);
    for (unsigned group = 0; group < groups_.count(); ++group) {
        const Found found = find(group);
        if (found.held == nullptr) {
            if (group > 0) throw_no_attributes<D, K>(); // group 0 has it
            std::fill_n(values, groups_.attributes(), null_value);
            return false;
        }
        for (unsigned i = 0; i < groups_.columns(group); ++i)
            *values++ = found.held->page.value(found.row, i);
    }
    return groups_.count() > 0;
}

template <int D, int K> bool AttributeReader<D, K>::contains(const Name &owner) {
    begin(owner);
    for (unsigned group = 0; group < groups_.count(); ++group)
        if (find(group).held == nullptr) return false;
    return true;
}

template <int D, int K> bool AttributeScan<D, K>::fetch() {
    host_.poll();
    abacus_page page{};
    const bool any = started_ ? host_.next(ABACUS_ATTRIBUTE_PAGES, &key_, page)
                              : find_first(host_, first_, page);
    if (!any || group_of(page.key) >= end_of_kind(first_)) return false;
    started_ = true;
    key_ = page.key;
    size_ = page.size;
    copy(page, bytes_);
    return true;
}

template <int D, int K> void AttributeScan<D, K>::read() {
    const bool begins = group() != last_group_;
    const unsigned stored = group_of(key_);
    if (group() >= groups_.count() || (begins && !(key_ == group_begin(stored))))
        throw_corrupted("An attribute page lies where no such page can be.");
    // All owners of a page come before the next page.
    if (!begins && key_ <= last_)
        throw_corrupted("An attribute page has attributes that another page owns.");
    page_.read(bytes_.data(), size_, stored, groups_.columns(group()));
    page_.keys(domain_, key_, group_begin(stored + 1), keys_);
    for (std::size_t row = 1; row < keys_.size(); ++row)
        if (keys_[row - 1] == keys_[row] && page_.owner(row - 1) == page_.owner(row))
            throw_corrupted("An attribute page has the same owner twice.");
    last_group_ = group();
    last_ = keys_.empty() ? key_ : keys_.back();
}

template class AttributeReader<2>;
template class AttributeReader<3>;
template class AttributeReader<2, 3>;
template class AttributeReader<3, 4>;
template class AttributeScan<2>;
template class AttributeScan<3>;
template class AttributeScan<2, 3>;
template class AttributeScan<3, 4>;

} // namespace abacus
