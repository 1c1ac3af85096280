#include "attributes/widen.hpp"

#include "attributes/attribute_reader.hpp"
#include "sort/record_spool.hpp"

namespace abacus {

namespace {

constexpr std::size_t held_bytes = std::size_t{1} << 20; // of pages that are read

/// Adds what all owners have to a spool, in the order of their keys.
template <int D, int K>
std::uint64_t copy_out(const Host &host, const Domain<D> &domain, unsigned attributes,
                       RecordSpool &rows) {
    AttributeReader<D, K> reader(host, domain, attributes, held_bytes);
    AttributeScan<D, K> scan(host, domain, attributes);
    std::uint64_t pages = 0;
    for (; scan.fetch() && scan.group() == 0; ++pages) {
        scan.read();
        for (std::size_t row = 0; row < scan.page().rows(); ++row) {
            const Owner<D, K> owner = scan.page().owner(row);
            std::uint64_t *const record = rows.add();
            std::memcpy(record, &owner, sizeof owner);
            reader.values(owner, reinterpret_cast<double *>(record + D * K));
        }
    }
    return pages + reader.pages_read();
}

template <int D, int K> void erase_all(const Host &host) {
    constexpr unsigned first = first_group<D, K>();
    const Key before = predecessor(group_begin(first));
    abacus_page page;
    while (host.next(ABACUS_ATTRIBUTE_PAGES, &before, page) &&
           group_of(page.key) < first + groups_of_kind) {
        host.erase(ABACUS_ATTRIBUTE_PAGES, page);
        host.poll();
    }
}

} // namespace

template <int D, int K>
abacus_counters widen_attributes(const Host &host, const Domain<D> &domain, unsigned attributes,
                                 unsigned more) {
    RecordSpool rows(host, D * K + attributes);
    const std::uint64_t pages_read = copy_out<D, K>(host, domain, attributes, rows);
    erase_all<D, K>(host);
    AttributePages<D, K> pages(host, domain, attributes + more);
    Arena<double> values(host);
    values.resize(attributes + more);
    std::fill(values.begin(), values.end(), null_value);
    rows.rewind();
    while (const std::uint64_t *record = rows.next()) {
        Owner<D, K> owner;
        std::memcpy(&owner, record, sizeof owner);
        std::memcpy(values.data(), record + D * K, attributes * sizeof(double));
        pages.put(owner, code_of<D, K>(domain, owner), values.data());
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

} // namespace abacus
