#include "query/scan/label_range.hpp"

#include <algorithm>

namespace abacus {

template <int D>
LabelRange<D>::LabelRange(const Host &host, const abacus_facts &facts, const abacus_range &range)
    : host_(host), range_(range), has_labels_(facts.census.labelled > 0),
      group_(first_group<D + 1> + AttributeGroups(facts.columns.labels).group_of(range.attribute)),
      columns_(AttributeGroups(facts.columns.labels).columns(group_ - first_group<D + 1>)),
      column_(range.attribute -
              AttributeGroups(facts.columns.labels).first(group_ - first_group<D + 1>)),
      labels_(host, facts) {}

/// The stretch of the label page that owns a key of the group.
template <int D> auto LabelRange<D>::stretch_of(const Key &key) -> const Stretch & {
    if (last_.lower <= key && key < last_.upper) return last_;
    host_.poll();
    last_ = {group_begin(group_), group_begin(group_ + 1), false};
    abacus_page page{};
    if (!host_.find(ABACUS_ATTRIBUTE_PAGES, key, page) || group_of(page.key) != group_)
        return last_;
    std::memcpy(bytes_.data(), page.bytes, std::min(page.size, bytes_.size()));
    page_.read(bytes_.data(), page.size, group_, columns_);
    last_.lower = page.key;
    last_.may_have = page_.may_have(column_, range_.least, range_.greatest);
    if (host_.next(ABACUS_ATTRIBUTE_PAGES, &last_.lower, page) && page.key < last_.upper)
        last_.upper = page.key;
    return last_;
}

template <int D> bool LabelRange<D>::may_be_in(const PageView<D> &page) {
    if (!has_labels_) return false;
    const Key upper = page.upper();
    // If the interval ends within a code, it counts to the end of that code.
    const std::uint64_t end = upper.code + (upper.part != 0);
    const Key behind =
        end < key_word_end ? in_group(code_begin(end), group_) : group_begin(group_ + 1);
    for (Key at = in_group(code_begin(page.lower().code), group_); at < behind;) {
        const Stretch &stretch = stretch_of(at);
        if (stretch.may_have) return true;
        at = stretch.upper;
    }
    return false;
}

template <int D> bool LabelRange<D>::wants(const PageView<D> &page, int simplex) {
    const double label = labels_.of_page(page, simplex)[range_.attribute];
    return range_.least <= label && label <= range_.greatest;
}

template class LabelRange<2>;
template class LabelRange<3>;

} // namespace abacus
