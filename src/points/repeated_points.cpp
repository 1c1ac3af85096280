#include "points/repeated_points.hpp"

#include "points/vertex_page.hpp"

#include <algorithm>

namespace abacus {
namespace {

struct RepeatedPageHeader {
    static constexpr std::uint32_t current_magic = 0x31525041; // "APR1": format version 1

    std::uint32_t magic;
    std::uint16_t dimension;
    std::uint16_t attributes;
    std::uint64_t count;

    static constexpr std::size_t words = 2;
};
static_assert(sizeof(RepeatedPageHeader) == 8 * RepeatedPageHeader::words);

constexpr std::size_t entry_words(unsigned dimension, unsigned attributes) {
    return 1 + record_words(dimension, attributes);
}

static_assert(RepeatedPageHeader::words +
                  entry_words(ABACUS_MAX_DIMENSION, ABACUS_MAX_ATTRIBUTES) <=
              ABACUS_MAX_PAGE_BYTES / 8);

[[noreturn]] void throw_bad_page(const char *what) {
    throw_corrupted(std::string("A page of repeated points ") + what + ".");
}

/// Copies the entries of a page to `entries` and checks them.
template <int D>
void decode(const abacus_page &page, const Domain<D> &domain, unsigned attributes,
            Arena<std::uint64_t> &entries) {
    const std::size_t stride = entry_words(D, attributes);
    RepeatedPageHeader header;
    if (page.size < sizeof header) throw_bad_page("is too short");
    std::memcpy(&header, page.bytes, sizeof header);
    if (header.magic != RepeatedPageHeader::current_magic)
        throw_bad_page("is not of this format version");
    if (header.dimension != D || header.attributes != attributes)
        throw_bad_page("has points of another kind than the mesh");
    const std::size_t room = page.size - sizeof header;
    if (header.count > room / (8 * stride) || header.count * 8 * stride != room)
        throw_bad_page("has a size that does not fit its number of points");
    entries.clear();
    if (room > 0)
        std::memcpy(entries.extend(header.count * stride), page.bytes + sizeof header, room);
    Key last = page.key;
    for (std::size_t i = 0; i < header.count; ++i) {
        const std::uint64_t *entry = entries.data() + i * stride;
        const Point<D> p = record_point<D>(entry + 1);
        if (!is_canonical<D>(p)) throw_bad_page("has a coordinate that is not a finite number");
        const Key key{domain.code(p), entry[0]};
        if (i == 0 ? key < last : key <= last) throw_bad_page("is not in order");
        last = key;
    }
}

} // namespace

template <int D>
RepeatedPoints<D>::RepeatedPoints(const Host &host, const Domain<D> &domain, unsigned attributes)
    : host_(host), domain_(domain), attributes_(attributes), stride_(entry_words(D, attributes)),
      capacity_(records_in_page(stride_, RepeatedPageHeader::words)), records_(host), taken_(host) {
}

template <int D> bool RepeatedPoints<D>::go_to(Key key) {
    if (at_page_ && lower_ <= key && key < upper_) return true;
    flush();
    abacus_page page;
    at_page_ = host_.find(ABACUS_REPEATED_PAGES, key, page);
    if (!at_page_) return false;
    decode(page, domain_, attributes_, records_);
    lower_ = page.key;
    location_ = page.location;
    upper_ = host_.next(ABACUS_REPEATED_PAGES, &lower_, page) ? page.key : end_key;
    // A search for a point of this page would look in the next one.
    if (count() > 0 && upper_ <= key_of(entry(count() - 1)))
        throw_bad_page("has points that the next page owns");
    return true;
}

template <int D> bool RepeatedPoints<D>::go_on(std::uint64_t code) {
    return upper_ < end_key && upper_.code <= code && go_to(upper_);
}

template <int D> void RepeatedPoints<D>::create_first_page() {
    at_page_ = true;
    lower_ = first_key;
    upper_ = end_key;
    location_ = 0;
    records_.clear();
}

template <int D> std::size_t RepeatedPoints<D>::lower_bound(const Key &key) {
    std::size_t low = 0, high = count();
    while (low < high) {
        const std::size_t middle = (low + high) / 2;
        if (key_of(entry(middle)) < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

template <int D> void RepeatedPoints<D>::add(std::uint64_t serial, const std::uint64_t *record) {
    const Key key{domain_.code(record_point<D>(record)), serial};
    if (!go_to(key)) create_first_page();
    const std::size_t at = lower_bound(key);
    records_.extend(stride_);
    std::copy_backward(entry(at), records_.end() - stride_, records_.end());
    entry(at)[0] = serial;
    std::copy_n(record, stride_ - 1, entry(at) + 1);
    dirty_ = true;
    if (count() > capacity_) split();
}

/// Writes the upper half as a page of its own.
template <int D> void RepeatedPoints<D>::split() {
    const std::size_t middle = count() / 2;
    const Key border = key_of(entry(middle)), upper = upper_;
    Arena<std::uint64_t> half(host_);
    std::copy(entry(middle), records_.end(), half.extend((count() - middle) * stride_));
    records_.resize(middle * stride_);
    upper_ = border;
    dirty_ = true;
    flush();
    lower_ = border;
    upper_ = upper;
    location_ = 0;
    records_.clear();
    std::copy(half.begin(), half.end(), records_.extend(half.size()));
    dirty_ = true;
    flush();
}

template <int D> void RepeatedPoints<D>::remove(std::size_t i) {
    std::copy(entry(i + 1), records_.end(), entry(i));
    records_.resize(records_.size() - stride_);
    dirty_ = true;
}

template <int D> bool RepeatedPoints<D>::contains(const Point<D> &p) {
    return find(p, [](const std::uint64_t *) { return true; }) != none;
}

template <int D> void RepeatedPoints<D>::offer(const Point<D> &p, Leaving &leaving) {
    find(p, [&](const std::uint64_t *entry) {
        const std::uint64_t *record = record_of(entry);
        return !leaving.offer(record_id(record), record_attributes<D>(record), entry[0]);
    });
}

template <int D> std::uint64_t RepeatedPoints<D>::take(const Point<D> &p, const Leaving &leaving) {
    const std::uint64_t code = domain_.code(p);
    std::uint64_t taken = 0;
    leaving.each_other([&](std::uint64_t serial) {
        host_.poll();
        go_to({code, serial});
        remove(lower_bound({code, serial}));
        ++taken;
    });
    return taken;
}

template <int D> const std::uint64_t *RepeatedPoints<D>::take_first(const Point<D> &p) {
    const std::size_t i = find(p, [](const std::uint64_t *) { return true; });
    if (i == none) return nullptr;
    taken_.resize(stride_ - 1);
    std::copy_n(record_of(entry(i)), stride_ - 1, taken_.data());
    remove(i);
    return taken_.data();
}

template <int D> std::uint64_t RepeatedPoints<D>::take_all(const Point<D> &p) {
    const Key from{domain_.code(p), 0};
    std::uint64_t taken = 0;
    if (!go_to(from)) return 0;
    // In one run: a new search from the beginning would pass all erased pages.
    do {
        for (std::size_t i = lower_bound(from); i < count() && key_of(entry(i)).code == from.code;)
            if (record_point<D>(record_of(entry(i))) == p) {
                remove(i);
                ++taken;
            } else {
                ++i;
            }
        host_.poll();
    } while (go_on(from.code));
    return taken;
}

template <int D> void RepeatedPoints<D>::flush() {
    if (!dirty_) return;
    dirty_ = false;
    if (count() == 0 && (!(lower_ == first_key) || upper_ == end_key)) {
        // The page before, if there is one, takes over the interval.
        at_page_ = false;
        if (location_ != 0) host_.erase(ABACUS_REPEATED_PAGES, {lower_, nullptr, 0, location_});
        return;
    }
    std::uint64_t words[ABACUS_MAX_PAGE_BYTES / 8];
    const RepeatedPageHeader header{RepeatedPageHeader::current_magic, D,
                                    static_cast<std::uint16_t>(attributes_), count()};
    std::memcpy(words, &header, sizeof header);
    std::copy(records_.begin(), records_.end(), words + RepeatedPageHeader::words);
    abacus_page page{lower_, reinterpret_cast<const unsigned char *>(words),
                     8 * (RepeatedPageHeader::words + records_.size()), location_};
    host_.put(ABACUS_REPEATED_PAGES, page);
    location_ = page.location;
}

template <int D> bool RepeatedReader<D>::advance() {
    const std::size_t stride = entry_words(D, attributes_);
    at_ += stride;
    while (at_ >= entries_.size()) {
        abacus_page page;
        host_.poll();
        if (!host_.next(ABACUS_REPEATED_PAGES, started_ ? &key_ : nullptr, page)) return false;
        if (started_ && page.key <= last_) throw_bad_page("is not in order");
        started_ = true;
        key_ = page.key;
        decode(page, domain_, attributes_, entries_);
        if (erase_) host_.erase(ABACUS_REPEATED_PAGES, page);
        at_ = 0;
        if (!entries_.empty()) {
            const std::uint64_t *entry = entries_.end() - stride;
            last_ = {domain_.code(record_point<D>(entry + 1)), entry[0]};
        }
    }
    return true;
}

template class RepeatedPoints<2>;
template class RepeatedPoints<3>;
template class RepeatedReader<2>;
template class RepeatedReader<3>;

} // namespace abacus
