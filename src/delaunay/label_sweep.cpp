#include "delaunay/label_sweep.hpp"

#include "mesh/page_attributes.hpp"

namespace abacus {

namespace {

/// The least key of a code among labels; that behind them for the end of the curve.
constexpr Key label_begin(unsigned group, std::uint64_t code) {
    return code < key_word_end ? in_group(code_begin(code), group) : group_begin(group + 1);
}

} // namespace

template <int D>
LabelSweep<D>::LabelSweep(const Host &host, const abacus_header &header, const Domain<D> &domain)
    : host_(host), domain_(domain), labels_(header.labels), attributes_(page_attributes(header)),
      pages_(host, domain, header.labels), keys_(host), is_found_(host) {}

template <int D> std::uint64_t LabelSweep<D>::sweep(const StoredPages::Stretch &stretch) {
    std::uint64_t gone = 0;
    const Key begin = label_begin(group, stretch.least);
    const Key end = label_begin(group, stretch.greatest + 1);
    abacus_page page;
    bool more = host_.find(ABACUS_ATTRIBUTE_PAGES, begin, page) && group_of(page.key) == group;
    while (more) {
        const Key key = page.key;
        if (read(page, stretch)) {
            find_simplices();
            for (std::size_t row = begin_; row < end_; ++row) {
                if (is_found_[row]) continue;
                pages_.erase(rows_.owner(row), code_of(keys_[row]));
                ++gone;
            }
        }
        // The pages that follow are as they were: what is written is this one at most, and one that
        // has been taken into it.
        host_.poll();
        more = host_.next(ABACUS_ATTRIBUTE_PAGES, &key, page) && page.key < end;
    }
    return gone;
}

template <int D>
bool LabelSweep<D>::read(const abacus_page &page, const StoredPages::Stretch &stretch) {
    std::memcpy(bytes_.data(), page.bytes, std::min(page.size, bytes_.size()));
    rows_.read(bytes_.data(), page.size, group, AttributeGroups(labels_).columns(0));
    rows_.keys(domain_, page.key, group_begin(group + 1), keys_);
    const auto first_from = [&](std::uint64_t code) {
        const Key key = label_begin(group, code);
        return static_cast<std::size_t>(
            std::lower_bound(keys_.begin(), keys_.end(), key, KeyBefore{}) - keys_.begin());
    };
    begin_ = first_from(stretch.least);
    end_ = first_from(stretch.greatest + 1);
    is_found_.resize(rows_.rows());
    std::fill(is_found_.begin(), is_found_.end(), false);
    return begin_ < end_;
}

template <int D> void LabelSweep<D>::find_simplices() {
    const std::uint64_t least = code_of(keys_[begin_]), greatest = code_of(keys_[end_ - 1]);
    abacus_page page;
    bool more = host_.find(ABACUS_SIMPLEX_PAGES, {least, 0}, page);
    while (more) {
        const Key key = page.key;
        view_.read(page.bytes, page.size, attributes_);
        for (int s = 0; s < view_.simplices(); ++s) {
            if (view_.is_ghost(s)) continue;
            std::array<Point<D>, D + 1> points;
            for (int i = 0; i <= D; ++i) points[i] = view_.point(view_.corner(s, i));
            const Owner<D, D + 1> simplex = owner_of<D, D + 1>(points);
            const std::uint64_t code = code_of<D, D + 1>(domain_, simplex);
            if (least <= code && code <= greatest) find(simplex, code);
        }
        host_.poll();
        more = host_.next(ABACUS_SIMPLEX_PAGES, &key, page) && page.key.code <= greatest;
    }
}

template <int D> void LabelSweep<D>::find(const Owner<D, D + 1> &simplex, std::uint64_t code) {
    const Key key = in_group(attribute_key<D, D + 1>(simplex, code), group);
    const Key *at =
        std::lower_bound(keys_.begin() + begin_, keys_.begin() + end_, key, KeyBefore{});
    for (; at != keys_.begin() + end_ && *at == key; ++at) {
        const auto row = static_cast<std::size_t>(at - keys_.begin());
        is_found_[row] |= rows_.owner(row) == simplex;
    }
}

template <int D> abacus_counters LabelSweep<D>::finish() {
    pages_.flush();
    return pages_.take_counters();
}

template class LabelSweep<2>;
template class LabelSweep<3>;

} // namespace abacus
