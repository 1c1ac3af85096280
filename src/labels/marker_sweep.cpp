#include "labels/marker_sweep.hpp"

#include <cmath>

namespace abacus {

template <int D>
MarkerSweep<D>::MarkerSweep(const Host &host, const abacus_facts &facts, const Domain<D> &domain,
                            std::size_t memory)
    : host_(host), domain_(domain), rows_(host, facts, domain, D + 1, marker_group),
      spool_(host, D * D + 1), room_(std::max(least_room, memory / sizeof(Marked))), marked_(host),
      found_(host) {}

template <int D>
std::uint64_t MarkerSweep<D>::sweep(const Arena<StoredPages::Stretch> &stretches,
                                    std::uint64_t marked, MarkerHeirs<D> *heirs) {
    std::uint64_t gone = 0, come = 0;
    const auto lose = [&](const Simplex &s, const double *markers) { add(s, markers, heirs); };
    const auto keep = [&](const Simplex &s, const double *markers) { add(s, markers, nullptr); };
    for (const StoredPages::Stretch &stretch : stretches) gone += rows_.sweep(stretch, lose, keep);
    if (gone > marked) throw_corrupted("The header counts too few markers.");
    if (heirs != nullptr)
        heirs->each([this](const Owner<D, D> &facet, double marker) { add(facet, marker); });
    spool_.rewind();
    while (read_marked())
        for (const StoredPages::Stretch &stretch : stretches) {
            const auto look = [&](const Simplex &s, std::uint64_t code) { look_at(s, code); };
            rows_.simplices().each(stretch, look, [&] { come += mark_found(); });
        }
    spool_.close();
    return marked - gone + come;
}

template <int D>
void MarkerSweep<D>::add(const Simplex &simplex, const double *markers, MarkerHeirs<D> *heirs) {
    for (int i = 0; i <= D; ++i) {
        if (!has_marker(markers[i])) continue;
        const Owner<D, D> facet = facet_of<D>(simplex, i);
        add(facet, markers[i]);
        if (heirs != nullptr) heirs->add(facet, markers[i]);
    }
}

template <int D> void MarkerSweep<D>::add(const Owner<D, D> &facet, double marker) {
    std::uint64_t *const record = spool_.add();
    std::memcpy(record, facet.data(), sizeof facet);
    record[D * D] = std::bit_cast<std::uint64_t>(marker);
}

template <int D> bool MarkerSweep<D>::read_marked() {
    marked_.clear();
    while (marked_.size() < room_) {
        const std::uint64_t *record = spool_.next();
        if (record == nullptr) break;
        Marked marked;
        std::memcpy(marked.facet.data(), record, sizeof marked.facet);
        marked.marker = std::bit_cast<double>(record[D * D]);
        marked.key = attribute_key<D, D>(marked.facet, code_of<D, D>(domain_, marked.facet));
        marked_.push_back(marked);
    }
    std::sort(marked_.begin(), marked_.end(), [this](const Marked &a, const Marked &b) {
        host_.poll(); // there may be millions
        return a.key < b.key;
    });
    return !marked_.empty();
}

template <int D> void MarkerSweep<D>::look_at(const Simplex &simplex, std::uint64_t code) {
    for (int i = 0; i <= D; ++i) {
        const Owner<D, D> facet = facet_of<D>(simplex, i);
        const Key key = attribute_key<D, D>(facet, code_of<D, D>(domain_, facet));
        const Marked *at =
            std::lower_bound(marked_.begin(), marked_.end(), key,
                             [](const Marked &a, const Key &b) { return a.key < b; });
        for (; at != marked_.end() && at->key == key; ++at) {
            if (at->facet != facet) continue;
            found_.push_back({simplex, code, static_cast<std::uint32_t>(i), at->marker});
            break; // the facet's entry for the other side has the same marker
        }
    }
}

template <int D> std::uint64_t MarkerSweep<D>::mark_found() {
    std::uint64_t new_rows = 0;
    sort_along_keys<D>(found_);
    for (const Found &found : found_)
        new_rows +=
            set_marker<D>(rows_.pages(), found.simplex, found.code, found.opposite, found.marker);
    found_.clear();
    return new_rows;
}

template class MarkerSweep<2>;
template class MarkerSweep<3>;

} // namespace abacus
