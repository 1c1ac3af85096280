#include "attributes/rewriting.hpp"

#include "attributes/attribute_reader.hpp"
#include "sort/record_sort.hpp"
#include "sort/record_spool.hpp"

namespace abacus {

namespace {

constexpr std::size_t held_bytes = std::size_t{1} << 20; // of pages being read
constexpr std::size_t key_words = 2;

/// Calls take(owner, values) for all owners, in the order of their keys. Returns how many pages
/// were read.
template <int D, int K, class Take>
std::uint64_t each_owner(const Host &host, const Domain<D> &domain, unsigned attributes,
                         unsigned first, const Take &take) {
    AttributeReader<D, K> reader(host, domain, attributes, held_bytes, first);
    AttributeScan<D, K> scan(host, domain, attributes, first);
    Arena<double> values(host);
    values.resize(attributes);
    std::uint64_t pages = 0;
    for (; scan.fetch() && scan.group() == 0; ++pages) {
        scan.read();
        for (std::size_t row = 0; row < scan.page().rows(); ++row) {
            const Owner<D, K> owner = scan.page().owner(row);
            reader.values(owner, values.data());
            take(owner, values.data());
        }
    }
    return pages + reader.pages_read();
}

/// An owner and its values as words.
template <int D, int K>
void write_record(const Owner<D, K> &owner, const double *values, unsigned attributes,
                  std::uint64_t *record) {
    std::memcpy(record, &owner, sizeof owner);
    std::memcpy(record + D * K, values, attributes * sizeof(double));
}
template <int D, int K>
Owner<D, K> read_record(const std::uint64_t *record, unsigned attributes, double *values) {
    Owner<D, K> owner;
    std::memcpy(&owner, record, sizeof owner);
    std::memcpy(values, record + D * K, attributes * sizeof(double));
    return owner;
}

} // namespace

void erase_attributes(const Host &host, unsigned first) {
    abacus_page page;
    const Key before = first > 0 ? predecessor(group_begin(first)) : first_key;
    bool more = host.next(ABACUS_ATTRIBUTE_PAGES, first > 0 ? &before : nullptr, page);
    // Go on from page to page: a new search for the first page would pass all erased ones.
    for (; more && group_of(page.key) < end_of_kind(first);
         more = host.next(ABACUS_ATTRIBUTE_PAGES, &page.key, page)) {
        host.erase(ABACUS_ATTRIBUTE_PAGES, page);
        host.poll();
    }
}

template <int D, int K>
abacus_counters widen_attributes(const Host &host, const Domain<D> &domain, unsigned attributes,
                                 unsigned more) {
    RecordSpool rows(host, D * K + attributes);
    const std::uint64_t pages_read = each_owner<D, K>(
        host, domain, attributes, first_group<K>, [&](const Owner<D, K> &owner, const double *v) {
            write_record<D, K>(owner, v, attributes, rows.add());
        });
    erase_attributes(host, first_group<K>);
    AttributePages<D, K> pages(host, domain, attributes + more);
    Arena<double> values(host);
    values.resize(attributes + more);
    std::fill(values.begin(), values.end(), null_value);
    rows.rewind();
    while (const std::uint64_t *record = rows.next()) {
        const Owner<D, K> owner = read_record<D, K>(record, attributes, values.data());
        pages.put(owner, code_of<D, K>(domain, owner), values.data());
    }
    pages.flush();
    rows.close();
    abacus_counters counters = pages.take_counters();
    counters.loads += pages_read;
    return counters;
}

template <int D, int K>
abacus_counters rekey_attributes(const Host &host, const Domain<D> &from, const Domain<D> &to,
                                 unsigned attributes, std::size_t memory, unsigned first) {
    RecordSort rows(host, key_words + D * K + attributes, key_words, memory);
    const std::uint64_t pages_read = each_owner<D, K>(
        host, from, attributes, first, [&](const Owner<D, K> &owner, const double *v) {
            std::uint64_t *const record = rows.add();
            const Key key = attribute_key<D, K>(owner, code_of<D, K>(to, owner));
            record[0] = key.code;
            record[1] = key.part;
            write_record<D, K>(owner, v, attributes, record + key_words);
        });
    erase_attributes(host, first);
    AttributePages<D, K> pages(host, to, attributes, first);
    Arena<double> values(host);
    values.resize(attributes);
    rows.finish();
    while (const std::uint64_t *record = rows.next()) {
        const Owner<D, K> owner = read_record<D, K>(record + key_words, attributes, values.data());
        pages.put(owner, code_of<D, K>(to, owner), values.data());
    }
    pages.flush();
    rows.close();
    abacus_counters counters = pages.take_counters();
    counters.loads += pages_read;
    return counters;
}

template abacus_counters widen_attributes<2, 3>(const Host &, const Domain<2> &, unsigned,
                                                unsigned);
template abacus_counters widen_attributes<3, 4>(const Host &, const Domain<3> &, unsigned,
                                                unsigned);
template abacus_counters rekey_attributes<2, 3>(const Host &, const Domain<2> &, const Domain<2> &,
                                                unsigned, std::size_t, unsigned);
template abacus_counters rekey_attributes<3, 4>(const Host &, const Domain<3> &, const Domain<3> &,
                                                unsigned, std::size_t, unsigned);

} // namespace abacus
