#include "labels/label_sweep.hpp"

namespace abacus {

namespace {

/// The least key of a code among the rows of a group; at the end of the curve, the key after them.
constexpr Key row_begin(unsigned group, std::uint64_t code) {
    return code < key_word_end ? in_group(code_begin(code), group) : group_begin(group + 1);
}

} // namespace

template <int D>
LabelSweep<D>::LabelSweep(const Host &host, const abacus_facts &facts, const Domain<D> &domain,
                          unsigned columns, unsigned first)
    : host_(host), domain_(domain), columns_(AttributeGroups(columns).columns(0)), group_(first),
      values_(host), pages_(host, domain, columns, first), keys_(host), is_found_(host),
      simplices_(host, facts, domain) {
    values_.resize(columns);
}

// Rows written meanwhile may be in other pages than before. So the sweep goes from key to key: it
// is done with all rows that have lesser keys.
template <int D>
std::uint64_t LabelSweep<D>::sweep(const StoredPages::Stretch &stretch, const Report &gone,
                                   const Report &kept) {
    std::uint64_t count = 0;
    const Key end = row_begin(group_, stretch.greatest + 1);
    for (Key from = row_begin(group_, stretch.least); from < end;) {
        const Key upper = read(from);
        begin_ = first_row(from);
        end_ = first_row(std::min(end, upper, KeyBefore{}));
        from = upper;
        host_.poll();
        if (begin_ == end_) continue;
        simplices_.each(
            {code_of(keys_[begin_]), code_of(keys_[end_ - 1])},
            [&](const Simplex &s, std::uint64_t code) { find(s, code); }, [] {});
        for (std::size_t row = begin_; row < end_; ++row) {
            if (is_found_[row]) {
                if (kept) report(row, kept);
                continue;
            }
            take_away(row, gone);
            ++count;
        }
    }
    return count;
}

template <int D> Key LabelSweep<D>::read(const Key &from) {
    const Key group_end = group_begin(group_ + 1);
    keys_.clear();
    abacus_page page;
    if (!host_.find(ABACUS_ATTRIBUTE_PAGES, from, page) || group_of(page.key) != group_)
        return group_end;
    std::memcpy(bytes_.data(), page.bytes, std::min(page.size, bytes_.size()));
    rows_.read(bytes_.data(), page.size, group_, columns_);
    rows_.keys(domain_, page.key, group_end, keys_);
    is_found_.resize(rows_.rows());
    std::fill(is_found_.begin(), is_found_.end(), false);
    const Key lower = page.key;
    return host_.next(ABACUS_ATTRIBUTE_PAGES, &lower, page) && page.key < group_end ? page.key
                                                                                    : group_end;
}

template <int D> std::size_t LabelSweep<D>::first_row(const Key &from) const {
    return static_cast<std::size_t>(
        std::lower_bound(keys_.begin(), keys_.end(), from, KeyBefore{}) - keys_.begin());
}

template <int D> void LabelSweep<D>::find(const Simplex &simplex, std::uint64_t code) {
    const Key key = in_group(attribute_key<D, D + 1>(simplex, code), group_);
    const Key *at =
        std::lower_bound(keys_.begin() + begin_, keys_.begin() + end_, key, KeyBefore{});
    for (; at != keys_.begin() + end_ && *at == key; ++at) {
        const auto row = static_cast<std::size_t>(at - keys_.begin());
        is_found_[row] |= rows_.owner(row) == simplex;
    }
}

template <int D> void LabelSweep<D>::report(std::size_t row, const Report &kept) {
    for (unsigned i = 0; i < columns_; ++i) values_[i] = rows_.value(row, i);
    kept(rows_.owner(row), values_.data());
}

template <int D> void LabelSweep<D>::take_away(std::size_t row, const Report &gone) {
    const Simplex simplex = rows_.owner(row);
    if (gone) {
        pages_.get(simplex, code_of(keys_[row]), values_.data());
        gone(simplex, values_.data());
    }
    pages_.erase(simplex, code_of(keys_[row]));
}

template <int D> abacus_counters LabelSweep<D>::finish() {
    pages_.flush();
    return pages_.take_counters();
}

template class LabelSweep<2>;
template class LabelSweep<3>;

} // namespace abacus
