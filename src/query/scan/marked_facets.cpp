#include "query/scan/marked_facets.hpp"

#include "attributes/attribute_reader.hpp"
#include "keys/domain_of.hpp"
#include "labels/marker_sweep.hpp"

#include <cmath>

namespace abacus {

template <int D>
MarkedFacets<D>::MarkedFacets(const Host &host, const abacus_facts &facts,
                              std::optional<double> marker, std::size_t memory,
                              std::size_t cache_bytes)
    : is_split_(facts.census.split > 0), mesh_(host, facts, cache_bytes),
      sort_(host, key_words, key_words, memory) {
    if (!marker) sort_.expect(static_cast<double>(facts.census.marked)); // at least one facet each
    if (facts.census.marked > 0) read(host, facts, marker);
    sort_.finish();
}

template <int D>
void MarkedFacets<D>::read(const Host &host, const abacus_facts &facts,
                           std::optional<double> marker) {
    const auto domain = domain_of<D>(facts.form);
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
                std::memcpy(record + facet_words, &simplex[i], sizeof simplex[i]);
            }
        }
    }
}

template <int D> bool MarkedFacets<D>::next(abacus_facet &facet) {
    const auto is_known = [&](const std::uint64_t *record) {
        return !is_first_ && std::equal(last_.begin(), last_.end(), record) &&
               (!is_split_ || ids_beside(record) == last_ids_);
    };
    const std::uint64_t *record = sort_.next();
    while (record != nullptr && is_known(record)) record = sort_.next();
    if (record == nullptr) {
        sort_.close();
        return false;
    }
    is_first_ = false;
    std::copy_n(record, facet_words, last_.begin());
    last_ids_ = is_split_ ? ids_beside(record) : ids_of(record);
    facet.marker = from_ordered(record[0]);
    std::copy(last_ids_.begin(), last_ids_.end(), facet.id);
    for (int i = 0; i < D; ++i) std::memcpy(facet.corner[i], record + 3 + i * D, sizeof(Point<D>));
    return true;
}

template <int D> auto MarkedFacets<D>::ids_of(const std::uint64_t *record) -> Ids {
    Ids ids;
    for (int i = 0; i < D; ++i) {
        Point<D> p;
        std::memcpy(p.data(), record + 3 + i * D, sizeof p);
        const auto id = mesh_.vertex_at(p);
        if (!id) throw_corrupted("A facet with a marker has a corner that is not a vertex.");
        ids[i] = *id;
    }
    return ids;
}

/// The ids as the simplex with the opposite corner has them.
template <int D> auto MarkedFacets<D>::ids_beside(const std::uint64_t *record) -> Ids {
    std::array<Point<D>, D + 1> corner; // the opposite one is the last
    std::memcpy(corner.data(), record + 3, sizeof corner);
    std::optional<Ids> ids;
    mesh_.star(corner[0], [&](const abacus_simplex &simplex) {
        std::array<std::int64_t, D + 1> here;
        int found = 0;
        for (int i = 0; i <= D; ++i)
            for (int k = 0; k <= D; ++k) {
                if (!std::equal(corner[i].begin(), corner[i].end(), simplex.corner[k])) continue;
                here[i] = simplex.id[k];
                ++found;
            }
        if (found == D + 1) std::copy_n(here.begin(), D, ids.emplace().begin());
    });
    if (!ids) throw_corrupted("A facet with a marker belongs to no simplex.");
    return *ids;
}

template class MarkedFacets<2>;
template class MarkedFacets<3>;

} // namespace abacus
