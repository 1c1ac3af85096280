#include "query/marked_facets.hpp"

#include "attributes/attribute_reader.hpp"
#include "delaunay/marker_sweep.hpp"
#include "keys/domain_of.hpp"

#include <cmath>

namespace abacus {

template <int D>
MarkedFacets<D>::MarkedFacets(const Host &host, const abacus_header &header,
                              std::optional<double> marker, std::size_t memory,
                              std::size_t cache_bytes)
    : mesh_(host, header, cache_bytes), sort_(host, key_words, key_words, memory) {
    if (header.marked > 0) read(host, header, marker);
    sort_.finish();
}

template <int D>
void MarkedFacets<D>::read(const Host &host, const abacus_header &header,
                           std::optional<double> marker) {
    const auto domain = domain_of<D>(header);
    AttributeScan<D, D + 1> scan(host, domain, D + 1, marker_group);
    while (scan.fetch()) {
        scan.read();
        for (std::size_t row = 0; row < scan.page().rows(); ++row) {
            const Owner<D, D + 1> simplex = scan.page().owner(row);
            for (int i = 0; i <= D; ++i) {
                const double found = scan.page().value(row, static_cast<unsigned>(i));
                if (!has_marker(found) || (marker && found != *marker)) continue;
                const Owner<D, D> facet = facet_of<D>(simplex, i);
                const Key key = attribute_key<D, D>(facet, code_of<D, D>(domain, facet));
                std::uint64_t *const record = sort_.add();
                record[0] = ordered(found);
                record[1] = key.code;
                record[2] = key.part;
                std::memcpy(record + 3, facet.data(), sizeof facet);
            }
        }
    }
}

template <int D> bool MarkedFacets<D>::next(abacus_facet &facet) {
    const std::uint64_t *record = sort_.next();
    while (record != nullptr && !is_first_ && std::equal(last_.begin(), last_.end(), record))
        record = sort_.next();
    if (record == nullptr) {
        sort_.close();
        return false;
    }
    is_first_ = false;
    std::copy_n(record, key_words, last_.begin());
    facet.marker = from_ordered(record[0]);
    for (int i = 0; i < D; ++i) {
        Point<D> p;
        std::memcpy(p.data(), record + 3 + i * D, sizeof p);
        const auto id = mesh_.vertex_at(p);
        if (!id) throw_corrupted("A facet with a marker has a corner that is no vertex.");
        facet.id[i] = *id;
        std::copy(p.begin(), p.end(), facet.corner[i]);
    }
    return true;
}

template class MarkedFacets<2>;
template class MarkedFacets<3>;

} // namespace abacus
