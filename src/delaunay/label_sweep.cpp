#include "delaunay/label_sweep.hpp"

namespace abacus {

namespace {

/// The least key of a code among the rows of a group; that behind them for the end of the curve.
constexpr Key row_begin(unsigned group, std::uint64_t code) {
    return code < key_word_end ? in_group(code_begin(code), group) : group_begin(group + 1);
}

} // namespace

template <int D>
LabelSweep<D>::LabelSweep(const Host &host, const abacus_header &header, const Domain<D> &domain,
                          unsigned columns, unsigned first)
    : host_(host), domain_(domain), columns_(AttributeGroups(columns).columns(0)), group_(first),
      pages_(host, domain, columns, first), keys_(host), is_found_(host),
      simplices_(host, header, domain) {}

template <int D>
std::uint64_t LabelSweep<D>::sweep(const StoredPages::Stretch &stretch, const Gone &gone) {
    std::uint64_t count = 0;
    const Key begin = row_begin(group_, stretch.least);
    const Key end = row_begin(group_, stretch.greatest + 1);
    abacus_page page;
    bool more = host_.find(ABACUS_ATTRIBUTE_PAGES, begin, page) && group_of(page.key) == group_;
    while (more) {
        const Key key = page.key;
        if (read(page, stretch)) {
            simplices_.each({code_of(keys_[begin_]), code_of(keys_[end_ - 1])},
                            [&](const Simplex &s, std::uint64_t code) { find(s, code); });
            for (std::size_t row = begin_; row < end_; ++row) {
                if (is_found_[row]) continue;
                take_away(row, gone);
                ++count;
            }
        }
        // The pages that follow are as they were: what is written is this one at most, and one that
        // has been taken into it.
        host_.poll();
        more = host_.next(ABACUS_ATTRIBUTE_PAGES, &key, page) && page.key < end;
    }
    return count;
}

template <int D>
bool LabelSweep<D>::read(const abacus_page &page, const StoredPages::Stretch &stretch) {
    std::memcpy(bytes_.data(), page.bytes, std::min(page.size, bytes_.size()));
    rows_.read(bytes_.data(), page.size, group_, columns_);
    rows_.keys(domain_, page.key, group_begin(group_ + 1), keys_);
    const auto first_from = [&](std::uint64_t code) {
        const Key key = row_begin(group_, code);
        return static_cast<std::size_t>(
            std::lower_bound(keys_.begin(), keys_.end(), key, KeyBefore{}) - keys_.begin());
    };
    begin_ = first_from(stretch.least);
    end_ = first_from(stretch.greatest + 1);
    is_found_.resize(rows_.rows());
    std::fill(is_found_.begin(), is_found_.end(), false);
    return begin_ < end_;
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

template <int D> void LabelSweep<D>::take_away(std::size_t row, const Gone &gone) {
    const Simplex simplex = rows_.owner(row);
    if (gone) {
        std::array<double, AttributeGroups::widest> values;
        for (unsigned i = 0; i < columns_; ++i) values[i] = rows_.value(row, i);
        gone(simplex, values.data());
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
