#include "attributes/attribute_pages.hpp"

#include <algorithm>

namespace abacus {

// ---- Those of a group -----------------------------------------------------------------

template <int D, int K>
AttributeGroup<D, K>::AttributeGroup(const Host &host, const Domain<D> &domain, unsigned group,
                                     unsigned columns, std::size_t held_bytes,
                                     abacus_counters &counters)
    : host_(host), domain_(domain), group_(group), columns_(columns), stride_(D * K + columns),
      held_bytes_(held_bytes), counters_(counters), writer_(host, D, K, group, columns),
      keys_(host), page_keys_(host), rows_(host) {}

template <int D, int K> Key AttributeGroup<D, K>::end_of_page(const Key &lower) {
    abacus_page page;
    const Key end = group_begin(group_ + 1);
    return host_.next(ABACUS_ATTRIBUTE_PAGES, &lower, page) && page.key < end ? page.key : end;
}

/// Finds the upper end of the page held, which begins at lower_.
template <int D, int K> void AttributeGroup<D, K>::find_end() {
    upper_ = end_of_page(lower_);
    // A search for such an owner would look in the next page.
    if (count() > 0 && upper_ <= keys_.back())
        throw_corrupted("An attribute page has attributes that another page owns.");
}

/// Adds the rows of a page to those held.
template <int D, int K>
void AttributeGroup<D, K>::append(const abacus_page &page, const Key &upper) {
    ++counters_.loads;
    counters_.bytes_read += page.size;
    std::size_t at = count();
    keys_.resize(at + view_.rows());
    rows_.resize((at + view_.rows()) * stride_);
    view_.keys(domain_, page.key, upper, page_keys_);
    for (std::size_t n = 0; n < view_.rows(); ++n, ++at) {
        keys_[at] = page_keys_[n];
        for (unsigned i = 0; i < stride_; ++i) row(at)[i] = view_.rank(n, i);
    }
}

template <int D, int K> void AttributeGroup<D, K>::go_to(const Key &key) {
    if (at_page_ && lower_ <= key && (key < upper_ || goes_on_to(key))) return;
    flush();
    at_page_ = false;
    keys_.clear();
    rows_.clear();
    most_ = held_bytes_ / (stride_ * sizeof(std::uint64_t));
    location_ = 0;
    lower_ = group_begin(group_);
    upper_ = group_begin(group_ + 1);
    abacus_page page;
    if (host_.find(ABACUS_ATTRIBUTE_PAGES, key, page) && group_of(page.key) == group_) {
        view_.read(page.bytes, page.size, group_, columns_);
        append(page, upper_);
        lower_ = page.key;
        location_ = page.location;
        find_end();
    }
    at_page_ = true;
}

template <int D, int K> std::size_t AttributeGroup<D, K>::lower_bound(const Key &key) const {
    return static_cast<std::size_t>(std::lower_bound(keys_.begin(), keys_.end(), key, KeyBefore{}) -
                                    keys_.begin());
}

template <int D, int K>
std::size_t AttributeGroup<D, K>::find(const Key &key, const Name &owner) const {
    for (std::size_t i = lower_bound(key); i < count() && keys_[i] == key; ++i) {
        const std::uint64_t *rank = row(i);
        bool is_it = true;
        for (const Point<D> &p : points_of<D, K>(owner))
            for (const double x : p) is_it = is_it && *rank++ == ordered(x);
        if (is_it) return i;
    }
    return none;
}

/// A page that stays as it is need not be written.
template <int D, int K> void AttributeGroup<D, K>::assign(std::uint64_t &to, double value) {
    const std::uint64_t rank = ordered(value);
    dirty_ = dirty_ || to != rank;
    to = rank;
}

/// Makes room for a row; returns its number.
template <int D, int K> std::size_t AttributeGroup<D, K>::insert(const Key &key) {
    std::size_t at = lower_bound(key);
    if (count() >= most_) {
        if (!write_before(at)) {
            if (rows_of_page(count()) == count()) {
                most_ *= 2; // they all fit a page
            } else {
                flush();
                go_to(key);
            }
        }
        at = lower_bound(key);
    }
    const std::size_t n = count();
    keys_.resize(n + 1);
    std::copy_backward(keys_.begin() + at, keys_.begin() + n, keys_.end());
    keys_[at] = key;
    rows_.resize((n + 1) * stride_);
    std::copy_backward(row(at), row(n), rows_.end());
    return at;
}

template <int D, int K> void AttributeGroup<D, K>::remove_rows(std::size_t begin, std::size_t end) {
    std::copy(keys_.begin() + end, keys_.end(), keys_.begin() + begin);
    std::copy(row(end), rows_.data() + rows_.size(), row(begin));
    keys_.resize(count() - (end - begin));
    rows_.resize(count() * stride_);
}

template <int D, int K>
void AttributeGroup<D, K>::put(const Key &first, const Name &owner, const double *values) {
    const Key key = in_group(first, group_);
    go_to(key);
    std::size_t i = find(key, owner);
    if (i == none) {
        i = insert(key);
        dirty_ = true;
        std::uint64_t *rank = row(i);
        for (const Point<D> &p : points_of<D, K>(owner))
            for (const double x : p) *rank++ = ordered(x);
    }
    for (unsigned n = 0; n < columns_; ++n) assign(row(i)[D * K + n], values[n]);
}

template <int D, int K>
bool AttributeGroup<D, K>::set(const Key &first, const Name &owner, unsigned first_attribute,
                               std::span<const std::uint32_t> which, const double *values) {
    const Key key = in_group(first, group_);
    go_to(key);
    const std::size_t i = find(key, owner);
    if (i == none) return false;
    for (const std::uint32_t attribute : which)
        assign(row(i)[D * K + attribute - first_attribute], *values++);
    return true;
}

template <int D, int K> bool AttributeGroup<D, K>::erase(const Key &first, const Name &owner) {
    const Key key = in_group(first, group_);
    go_to(key);
    const std::size_t i = find(key, owner);
    if (i == none) return false;
    remove_rows(i, i + 1);
    return dirty_ = shrunk_ = true;
}

template <int D, int K>
bool AttributeGroup<D, K>::get(const Key &first, const Name &owner, double *values) {
    const Key key = in_group(first, group_);
    go_to(key);
    const std::size_t i = find(key, owner);
    if (i == none) return false;
    for (unsigned n = 0; n < columns_; ++n) values[n] = from_ordered(row(i)[D * K + n]);
    return true;
}

template <int D, int K> bool AttributeGroup<D, K>::contains(const Key &first, const Name &owner) {
    const Key key = in_group(first, group_);
    go_to(key);
    return find(key, owner) != none;
}

// ---- Writing --------------------------------------------------------------------------

template <int D, int K> std::size_t AttributeGroup<D, K>::rows_of_page(std::size_t n) {
    std::size_t rows = writer_.count_that_fits(rows_.data(), n);
    // Owners of one key stay together.
    while (rows > 0 && rows < count() && keys_[rows - 1] == keys_[rows]) --rows;
    if (rows == 0)
        throw Error(ABACUS_ERROR_LIMIT,
                    std::string("too many ") +
                        (K == 1   ? "vertices"
                         : K == D ? "facets"
                                  : "simplices") +
                        " share a key of the attribute pages",
                    "Their coordinates have the same hash, within one cell of the curve.");
    return rows;
}

template <int D, int K> void AttributeGroup<D, K>::write_rows(std::size_t n) {
    host_.poll();
    writer_.write(rows_.data(), n);
    abacus_page page{lower_, writer_.bytes(), writer_.size(), location_};
    host_.put(ABACUS_ATTRIBUTE_PAGES, page);
    ++counters_.stores;
    counters_.rewrites += location_ != 0;
    counters_.bytes_written += page.size;
    location_ = page.location;
    if (n == count()) return;
    lower_ = keys_[n];
    location_ = 0;
    remove_rows(0, n);
}

template <int D, int K> bool AttributeGroup<D, K>::write_before(std::size_t at) {
    bool any = false;
    while (at > 0) {
        const std::size_t n = rows_of_page(at);
        if (n >= at) break;
        write_rows(n);
        at -= n;
        any = grown_ = true;
    }
    return any;
}

template <int D, int K> void AttributeGroup<D, K>::absorb_next() {
    abacus_page page;
    if (!(upper_ < group_begin(group_ + 1)) || !host_.next(ABACUS_ATTRIBUTE_PAGES, &lower_, page) ||
        !(page.key == upper_))
        return;
    view_.read(page.bytes, page.size, group_, columns_);
    append(page, group_begin(group_ + 1));
    host_.erase(ABACUS_ATTRIBUTE_PAGES, page);
    find_end();
}

/// If these rows have outgrown their page and full pages were split off, continues with the next
/// page if it has the key; returns whether it did. So a round along the curve leaves no page half
/// full.
template <int D, int K> bool AttributeGroup<D, K>::goes_on_to(const Key &key) {
    if (!dirty_ || shrunk_ || !(upper_ <= key)) return false;
    if (!grown_ && rows_of_page(count()) == count()) return false;
    abacus_page page;
    if (!host_.find(ABACUS_ATTRIBUTE_PAGES, key, page) || !(page.key == upper_)) return false;
    write_before(count());
    absorb_next();
    return key < upper_;
}

template <int D, int K> void AttributeGroup<D, K>::flush() {
    if (!dirty_) return;
    dirty_ = grown_ = false;
    constexpr std::size_t few_bytes = ABACUS_PAGE_BYTES / 4;
    if (shrunk_ && writer_.size(rows_.data(), count()) < few_bytes) absorb_next();
    shrunk_ = false;
    if (count() == 0 && (!(lower_ == group_begin(group_)) || upper_ == group_begin(group_ + 1))) {
        // The page before, if there is one, takes over the interval.
        at_page_ = false;
        if (location_ != 0) host_.erase(ABACUS_ATTRIBUTE_PAGES, {lower_, nullptr, 0, location_});
        return;
    }
    for (;;) {
        std::size_t n = count() == 0 ? 0 : rows_of_page(count());
        if (n == count()) break;
        // The last two pages share the remaining rows, so that both have room for more.
        const std::size_t half = count() / 2;
        if (half > 0 && half < n && !(keys_[half - 1] == keys_[half])) n = half;
        write_rows(n);
    }
    write_rows(count());
}

// ---- All of them ----------------------------------------------------------------------

template <int D, int K>
AttributePages<D, K>::AttributePages(const Host &host, const Domain<D> &domain, unsigned attributes,
                                     unsigned first)
    : groups_(attributes), memory_(host), pages_(&memory_) {
    const std::size_t held =
        std::clamp(held_together / std::max(groups_.count(), 1u), least_held, most_held);
    for (unsigned group = 0; group < groups_.count(); ++group)
        pages_.emplace_back(host, domain, first + group, groups_.columns(group), held, counters_);
}

template <int D, int K>
void AttributePages<D, K>::put(const Name &owner, std::uint64_t code, const double *values) {
    const Key key = attribute_key<D, K>(owner, code);
    for (unsigned group = 0; group < groups_.count(); ++group)
        pages_[group].put(key, owner, values + groups_.first(group));
}

template <int D, int K>
bool AttributePages<D, K>::put_new(const Name &owner, std::uint64_t code, const double *values) {
    if (pages_[0].contains(attribute_key<D, K>(owner, code), owner)) return false;
    put(owner, code, values);
    return true;
}

template <int D, int K>
bool AttributePages<D, K>::set(const Name &owner, std::uint64_t code,
                               std::span<const std::uint32_t> which, const double *values) {
    const Key key = attribute_key<D, K>(owner, code);
    for (std::size_t begin = 0, end = 0; begin < which.size(); begin = end) {
        const unsigned group = groups_.group_of(which[begin]);
        while (end < which.size() && groups_.group_of(which[end]) == group) ++end;
        if (pages_[group].set(key, owner, groups_.first(group), which.subspan(begin, end - begin),
                              values + begin))
            continue;
        if (begin > 0) throw_no_attributes<D, K>();
        return false;
    }
    return true;
}

template <int D, int K> bool AttributePages<D, K>::erase(const Name &owner, std::uint64_t code) {
    const Key key = attribute_key<D, K>(owner, code);
    for (unsigned group = 0; group < groups_.count(); ++group)
        if (!pages_[group].erase(key, owner)) {
            if (group > 0) throw_no_attributes<D, K>(); // group 0 has it
            return false;
        }
    return groups_.count() > 0;
}

template <int D, int K>
void AttributePages<D, K>::get(const Name &owner, std::uint64_t code, double *values) {
    const Key key = attribute_key<D, K>(owner, code);
    for (unsigned group = 0; group < groups_.count(); ++group)
        if (!pages_[group].get(key, owner, values + groups_.first(group)))
            throw_no_attributes<D, K>();
}

template <int D, int K> bool AttributePages<D, K>::contains(const Name &owner, std::uint64_t code) {
    return pages_.front().contains(attribute_key<D, K>(owner, code), owner);
}

template class AttributePages<2>;
template class AttributePages<3>;
template class AttributePages<2, 3>;
template class AttributePages<3, 4>;

} // namespace abacus
