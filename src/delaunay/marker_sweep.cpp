#include "delaunay/marker_sweep.hpp"

#include <cmath>

namespace abacus {

template <int D>
MarkerSweep<D>::MarkerSweep(const Host &host, const abacus_header &header, const Domain<D> &domain)
    : domain_(domain), rows_(host, header, domain, D + 1, marker_group), spool_(host, D * D + 1),
      lost_(host), found_(host) {}

template <int D>
std::uint64_t MarkerSweep<D>::sweep(const Arena<StoredPages::Stretch> &stretches,
                                    std::uint64_t marked) {
    std::uint64_t gone = 0, come = 0;
    for (const StoredPages::Stretch &stretch : stretches)
        gone += rows_.sweep(stretch, [&](const Simplex &simplex, const double *markers) {
            lose(simplex, markers);
        });
    if (gone > marked) throw_corrupted("The header counts too few markers.");
    spool_.rewind();
    while (read_lost())
        for (const StoredPages::Stretch &stretch : stretches) {
            rows_.simplices().each(stretch, [&](const Simplex &simplex, std::uint64_t code) {
                look_at(simplex, code);
            });
            come += mark_found();
        }
    spool_.close();
    return marked - gone + come;
}

template <int D> void MarkerSweep<D>::lose(const Simplex &simplex, const double *markers) {
    for (int i = 0; i <= D; ++i) {
        if (std::isnan(markers[i])) continue;
        const Owner<D, D> facet = facet_of<D>(simplex, i);
        std::uint64_t *const record = spool_.add();
        std::memcpy(record, facet.data(), sizeof facet);
        record[D * D] = std::bit_cast<std::uint64_t>(markers[i]);
    }
}

template <int D> bool MarkerSweep<D>::read_lost() {
    lost_.clear();
    while (lost_.size() < looked_for_at_once) {
        const std::uint64_t *record = spool_.next();
        if (record == nullptr) break;
        Lost lost;
        std::memcpy(lost.facet.data(), record, sizeof lost.facet);
        lost.marker = std::bit_cast<double>(record[D * D]);
        lost.key = attribute_key<D, D>(lost.facet, code_of<D, D>(domain_, lost.facet));
        lost_.push_back(lost);
    }
    std::sort(lost_.begin(), lost_.end(),
              [](const Lost &a, const Lost &b) { return a.key < b.key; });
    return !lost_.empty();
}

template <int D> void MarkerSweep<D>::look_at(const Simplex &simplex, std::uint64_t code) {
    for (int i = 0; i <= D; ++i) {
        const Owner<D, D> facet = facet_of<D>(simplex, i);
        const Key key = attribute_key<D, D>(facet, code_of<D, D>(domain_, facet));
        const Lost *at = std::lower_bound(lost_.begin(), lost_.end(), key,
                                          [](const Lost &a, const Key &b) { return a.key < b; });
        for (; at != lost_.end() && at->key == key; ++at) {
            if (at->facet != facet) continue;
            found_.push_back({simplex, code, static_cast<std::uint32_t>(i), at->marker});
            break; // its other side has the same
        }
    }
}

template <int D> std::uint64_t MarkerSweep<D>::mark_found() {
    std::uint64_t new_rows = 0;
    for (const Found &found : found_)
        new_rows +=
            set_marker<D>(rows_.pages(), found.simplex, found.code, found.opposite, found.marker);
    found_.clear();
    return new_rows;
}

template class MarkerSweep<2>;
template class MarkerSweep<3>;

} // namespace abacus
