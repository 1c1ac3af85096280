// Labels of simplices and markers of facets while the mesh changes: those of simplices that have
// gone go (label_sweep.hpp), or others inherit them (label_heirs.hpp), facets keep theirs
// (marker_sweep.hpp), and all follow the mesh to another domain.
#include "attributes/rewriting.hpp"
#include "blocks/counters.hpp"
#include "delaunay/build.hpp"
#include "labels/label_heirs.hpp"
#include "labels/marker_sweep.hpp"

namespace abacus {

namespace {
constexpr std::size_t share = 4; // of the cache's memory, beside it
} // namespace

/// Of a change that has been stored.
template <int D> void Build<D>::sweep_labels() {
    if (core_->mesh.simplices() == 0) {
        erase_attributes(host_, first_group<D + 1>);
        erase_attributes(host_, marker_group);
        facts_->census.labelled = facts_->census.marked = 0;
    }
    if (facts_->census.labelled > 0) {
        LabelSweep<D> sweep(host_, *facts_, domain_, facts_->columns.labels, first_group<D + 1>);
        std::optional<LabelHeirs<D>> heirs;
        typename LabelSweep<D>::Report lose;
        if (facts_->columns.inherits != 0) {
            heirs.emplace(host_, facts_->columns.labels, cache_bytes_ / share);
            lose = [&](const auto &simplex, const double *v) { heirs->lose(simplex, v); };
        }
        std::uint64_t gone = 0;
        for (const StoredPages::Stretch &stretch : stored_->stretches())
            gone += sweep.sweep(stretch, lose);
        if (gone > facts_->census.labelled) throw_corrupted("The header counts too few labels.");
        facts_->census.labelled -= gone;
        if (heirs) facts_->census.labelled += heirs->pass_on(sweep, stored_->stretches());
        core_->cache.counters += sweep.finish();
    }
    if (facts_->census.marked > 0) {
        MarkerSweep<D> sweep(host_, *facts_, domain_, cache_bytes_ / share);
        facts_->census.marked = sweep.sweep(stored_->stretches(), facts_->census.marked);
        core_->cache.counters += sweep.finish();
    }
    stored_->clear();
}

template <int D> void Build<D>::rekey_labels(const Domain<D> &from, std::size_t memory) {
    if (facts_->census.labelled > 0)
        core_->cache.counters +=
            rekey_attributes<D, D + 1>(host_, from, domain_, facts_->columns.labels, memory);
    if (facts_->census.marked > 0)
        core_->cache.counters +=
            rekey_attributes<D, D + 1>(host_, from, domain_, D + 1, memory, marker_group);
}

template void Build<2>::sweep_labels();
template void Build<3>::sweep_labels();
template void Build<2>::rekey_labels(const Domain<2> &, std::size_t);
template void Build<3>::rekey_labels(const Domain<3> &, std::size_t);

} // namespace abacus
