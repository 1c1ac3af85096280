#include "attributes/attribute_pages.hpp"

#include <algorithm>

namespace abacus {

// ---- Those of a group -----------------------------------------------------------------

template <int D>
AttributeGroup<D>::AttributeGroup(const Host &host, const Domain<D> &domain, unsigned group,
                                  unsigned columns, abacus_counters &counters)
    : host_(host), domain_(domain), group_(group), columns_(columns), stride_(D + columns),
      counters_(counters), writer_(host, D, group, columns), keys_(host), page_keys_(host),
      rows_(host) {}

template <int D> Key AttributeGroup<D>::end_of_page(const Key &lower) {
    abacus_page page;
    const Key end = group_begin(group_ + 1);
    return host_.next(ABACUS_ATTRIBUTE_PAGES, &lower, page) && page.key < end ? page.key : end;
}

/// Of the page held, which begins at lower_.
template <int D> void AttributeGroup<D>::find_end() {
    upper_ = end_of_page(lower_);
    // A search for one of these would look in the next page.
    if (count() > 0 && upper_ <= keys_.back())
        throw_corrupted("An attribute page has vertices that another page owns.");
}

/// Adds the rows of a page to those held.
template <int D> void AttributeGroup<D>::append(const abacus_page &page, const Key &upper) {
    ++counters_.loads;
    counters_.bytes_read += page.size;
    std::size_t at = count();
    keys_.resize(at + view_.vertices());
    rows_.resize((at + view_.vertices()) * stride_);
    view_.keys(domain_, page.key, upper, page_keys_);
    for (std::size_t v = 0; v < view_.vertices(); ++v, ++at) {
        keys_[at] = page_keys_[v];
        for (unsigned i = 0; i < stride_; ++i) row(at)[i] = view_.rank(v, i);
    }
}

template <int D> void AttributeGroup<D>::go_to(const Key &key) {
    if (at_page_ && lower_ <= key && (key < upper_ || goes_on_to(key))) return;
    flush();
    at_page_ = false;
    keys_.clear();
    rows_.clear();
    most_ = held_bytes / (stride_ * sizeof(std::uint64_t));
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

template <int D> std::size_t AttributeGroup<D>::lower_bound(const Key &key) const {
    return static_cast<std::size_t>(std::lower_bound(keys_.begin(), keys_.end(), key, KeyBefore{}) -
                                    keys_.begin());
}

template <int D> std::size_t AttributeGroup<D>::find(const Key &key, const Point<D> &p) const {
    for (std::size_t i = lower_bound(key); i < count() && keys_[i] == key; ++i) {
        bool is_it = true;
        for (int axis = 0; axis < D; ++axis) is_it = is_it && row(i)[axis] == ordered(p[axis]);
        if (is_it) return i;
    }
    return none;
}

/// A page that stays as it is need not be written.
template <int D> void AttributeGroup<D>::assign(std::uint64_t &to, double value) {
    const std::uint64_t rank = ordered(value);
    dirty_ = dirty_ || to != rank;
    to = rank;
}

/// Makes room for a row; its number.
template <int D> std::size_t AttributeGroup<D>::insert(const Key &key) {
    std::size_t at = lower_bound(key);
    if (count() >= most_) {
        if (!write_before(at)) {
            if (rows_of_page(count()) == count()) {
                most_ *= 2; // all of it fits a page
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

template <int D> void AttributeGroup<D>::remove_rows(std::size_t begin, std::size_t end) {
    std::copy(keys_.begin() + end, keys_.end(), keys_.begin() + begin);
    std::copy(row(end), rows_.data() + rows_.size(), row(begin));
    keys_.resize(count() - (end - begin));
    rows_.resize(count() * stride_);
}

template <int D>
void AttributeGroup<D>::put(const Key &vertex, const Point<D> &p, const double *values) {
    const Key key = in_group(vertex, group_);
    go_to(key);
    std::size_t i = find(key, p);
    if (i == none) {
        i = insert(key);
        dirty_ = true;
        for (int axis = 0; axis < D; ++axis) row(i)[axis] = ordered(p[axis]);
    }
    for (unsigned n = 0; n < columns_; ++n) assign(row(i)[D + n], values[n]);
}

template <int D>
bool AttributeGroup<D>::set(const Key &vertex, const Point<D> &p, unsigned first,
                            std::span<const std::uint32_t> which, const double *values) {
    const Key key = in_group(vertex, group_);
    go_to(key);
    const std::size_t i = find(key, p);
    if (i == none) return false;
    for (const std::uint32_t attribute : which) assign(row(i)[D + attribute - first], *values++);
    return true;
}

template <int D> void AttributeGroup<D>::drop(const Key &vertex, const Point<D> &p) {
    const Key key = in_group(vertex, group_);
    go_to(key);
    const std::size_t i = find(key, p);
    if (i == none) throw_corrupted("A vertex has no attributes.");
    remove_rows(i, i + 1);
    dirty_ = shrunk_ = true;
}

template <int D> void AttributeGroup<D>::get(const Key &vertex, const Point<D> &p, double *values) {
    const Key key = in_group(vertex, group_);
    go_to(key);
    const std::size_t i = find(key, p);
    if (i == none) throw_corrupted("A vertex has no attributes.");
    for (unsigned n = 0; n < columns_; ++n) values[n] = from_ordered(row(i)[D + n]);
}

template <int D> bool AttributeGroup<D>::contains(const Key &vertex, const Point<D> &p) {
    const Key key = in_group(vertex, group_);
    go_to(key);
    return find(key, p) != none;
}

// ---- Writing --------------------------------------------------------------------------

template <int D> std::size_t AttributeGroup<D>::rows_of_page(std::size_t n) {
    std::size_t rows = writer_.count_that_fits(rows_.data(), n);
    // Vertices of one key stay together.
    while (rows > 0 && rows < count() && keys_[rows - 1] == keys_[rows]) --rows;
    if (rows == 0)
        throw Error(ABACUS_ERROR_LIMIT, "too many vertices share a key of the attribute pages",
                    "Their coordinates have the same hash, within one cell of the curve.");
    return rows;
}

template <int D> void AttributeGroup<D>::write_rows(std::size_t n) {
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

template <int D> bool AttributeGroup<D>::write_before(std::size_t at) {
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

template <int D> void AttributeGroup<D>::absorb_next() {
    abacus_page page;
    if (!(upper_ < group_begin(group_ + 1)) || !host_.next(ABACUS_ATTRIBUTE_PAGES, &lower_, page) ||
        !(page.key == upper_))
        return;
    view_.read(page.bytes, page.size, group_, columns_);
    append(page, group_begin(group_ + 1));
    host_.erase(ABACUS_ATTRIBUTE_PAGES, page);
    find_end();
}

/// Whether what has outgrown its page, and has left full ones behind, goes on with the next page,
/// which has the key. So a round along the curve leaves no page half full.
template <int D> bool AttributeGroup<D>::goes_on_to(const Key &key) {
    if (!dirty_ || shrunk_ || !(upper_ <= key)) return false;
    if (!grown_ && rows_of_page(count()) == count()) return false;
    abacus_page page;
    if (!host_.find(ABACUS_ATTRIBUTE_PAGES, key, page) || !(page.key == upper_)) return false;
    write_before(count());
    absorb_next();
    return key < upper_;
}

template <int D> void AttributeGroup<D>::flush() {
    if (!dirty_) return;
    dirty_ = grown_ = false;
    constexpr std::size_t few_bytes = ABACUS_PAGE_BYTES / 4;
    if (shrunk_ && writer_.size(rows_.data(), count()) < few_bytes) absorb_next();
    shrunk_ = false;
    if (count() == 0 && (!(lower_ == group_begin(group_)) || upper_ == group_begin(group_ + 1))) {
        // The page before, if there is one, gets the interval.
        at_page_ = false;
        if (location_ != 0) host_.erase(ABACUS_ATTRIBUTE_PAGES, {lower_, nullptr, 0, location_});
        return;
    }
    for (;;) {
        std::size_t n = count() == 0 ? 0 : rows_of_page(count());
        if (n == count()) break;
        // The last two share what is left: both have room for what comes.
        const std::size_t half = count() / 2;
        if (half > 0 && half < n && !(keys_[half - 1] == keys_[half])) n = half;
        write_rows(n);
    }
    write_rows(count());
}

// ---- All of them ----------------------------------------------------------------------

template <int D>
AttributePages<D>::AttributePages(const Host &host, const Domain<D> &domain, unsigned attributes)
    : groups_(attributes), memory_(host), pages_(&memory_) {
    for (unsigned group = 0; group < groups_.count(); ++group)
        pages_.emplace_back(host, domain, group, groups_.columns(group), counters_);
}

template <int D>
void AttributePages<D>::put(const Point<D> &p, std::uint64_t code, const double *values) {
    const Key key = attribute_key<D>(p, code);
    for (unsigned group = 0; group < groups_.count(); ++group)
        pages_[group].put(key, p, values + groups_.first(group));
}

template <int D>
void AttributePages<D>::put_new(const Point<D> &p, std::uint64_t code, const double *values) {
    if (!pages_[0].contains(attribute_key<D>(p, code), p)) put(p, code, values);
}

template <int D>
bool AttributePages<D>::set(const Point<D> &p, std::uint64_t code,
                            std::span<const std::uint32_t> which, const double *values) {
    const Key key = attribute_key<D>(p, code);
    for (std::size_t begin = 0, end = 0; begin < which.size(); begin = end) {
        const unsigned group = groups_.group_of(which[begin]);
        while (end < which.size() && groups_.group_of(which[end]) == group) ++end;
        if (pages_[group].set(key, p, groups_.first(group), which.subspan(begin, end - begin),
                              values + begin))
            continue;
        if (begin > 0) throw_corrupted("A vertex has no attributes.");
        return false;
    }
    return true;
}

template <int D> void AttributePages<D>::drop(const Point<D> &p, std::uint64_t code) {
    const Key key = attribute_key<D>(p, code);
    for (AttributeGroup<D> &group : pages_) group.drop(key, p);
}

template <int D>
void AttributePages<D>::get(const Point<D> &p, std::uint64_t code, double *values) {
    const Key key = attribute_key<D>(p, code);
    for (unsigned group = 0; group < groups_.count(); ++group)
        pages_[group].get(key, p, values + groups_.first(group));
}

template class AttributeGroup<2>;
template class AttributeGroup<3>;
template class AttributePages<2>;
template class AttributePages<3>;

} // namespace abacus
