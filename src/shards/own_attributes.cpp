#include "shards/own_attributes.hpp"

#include <algorithm>

namespace abacus {

template <int D> void OwnAttributes<D>::seek(const Key &key) {
    group_ = group_of(key);
    begin_ = in_group(code_begin(first_), group_);
    end_ = last_ >= key_word_end - 1 ? group_begin(group_ + 1)
                                     : in_group(code_begin(last_ + 1), group_);
    is_over_ = last_ < first_ || group_ >= groups_.count();
    if (is_over_) return;
    at_ = key < begin_ ? begin_ : key;
    is_first_ = true;
    writer_.emplace(host_, D, 1, group_, groups_.columns(group_));
}

template <int D> bool OwnAttributes<D>::find(abacus_page &page) {
    if (!is_first_) return host_.next(ABACUS_ATTRIBUTE_PAGES, &at_, page) && page.key < end_;
    is_first_ = false;
    if (!host_.find(ABACUS_ATTRIBUTE_PAGES, at_, page)) return false;
    return group_of(page.key) == group_;
}

template <int D> bool OwnAttributes<D>::next(abacus_page &page) {
    if (is_over_) return false;
    host_.poll();
    is_over_ = !(at_ < end_) || !find(page);
    if (is_over_) return false;
    at_ = page.key;
    cut(page);
    page.location = 0;
    return true;
}

template <int D> void OwnAttributes<D>::cut(abacus_page &page) {
    view_.read(page.bytes, page.size, group_, groups_.columns(group_));
    view_.keys(domain_, page.key, group_begin(group_ + 1), keys_);
    const auto before = [](const Key &a, const Key &b) { return a < b; };
    const Key *const begin = keys_.begin(), *const end = keys_.end();
    const Key *const from = std::lower_bound(begin, end, begin_, before);
    const Key *const to = std::lower_bound(from, end, end_, before);
    page.key = std::max(page.key, begin_, before);
    if (from == begin && to == end) return;
    rows_.clear();
    for (const Key *key = from; key != to; ++key)
        for (unsigned word = 0; word < writer_->stride(); ++word)
            rows_.push_back(view_.rank(static_cast<std::size_t>(key - begin), word));
    writer_->write(rows_.data(), static_cast<std::size_t>(to - from));
    page.bytes = writer_->bytes();
    page.size = writer_->size();
}

template class OwnAttributes<2>;
template class OwnAttributes<3>;

} // namespace abacus
