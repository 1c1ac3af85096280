// Labels of simplices and markers of facets while the mesh changes: those of simplices that have
// gone go (label_sweep.hpp), facets keep theirs (marker_sweep.hpp), and all follow the mesh to
// another domain.
#include "attributes/rewriting.hpp"
#include "blocks/counters.hpp"
#include "delaunay/build.hpp"
#include "delaunay/marker_sweep.hpp"

namespace abacus {

/// Of a change that has been stored.
template <int D> void Build<D>::sweep_labels() {
    if (core_->mesh.simplices() == 0) {
        erase_attributes(host_, first_group<D + 1>);
        erase_attributes(host_, marker_group);
        header_->labelled = header_->marked = 0;
    }
    if (header_->labelled > 0) {
        LabelSweep<D> sweep(host_, *header_, domain_, header_->labels, first_group<D + 1>);
        std::uint64_t gone = 0;
        for (const StoredPages::Stretch &stretch : stored_->stretches())
            gone += sweep.sweep(stretch);
        if (gone > header_->labelled) throw_corrupted("The header counts too few labels.");
        header_->labelled -= gone;
        core_->cache.counters += sweep.finish();
    }
    if (header_->marked > 0) {
        MarkerSweep<D> sweep(host_, *header_, domain_);
        header_->marked = sweep.sweep(stored_->stretches(), header_->marked);
        core_->cache.counters += sweep.finish();
    }
    stored_->clear();
}

template <int D> void Build<D>::rekey_labels(const Domain<D> &from, std::size_t memory) {
    if (header_->labelled > 0)
        core_->cache.counters +=
            rekey_attributes<D, D + 1>(host_, from, domain_, header_->labels, memory);
    if (header_->marked > 0)
        core_->cache.counters +=
            rekey_attributes<D, D + 1>(host_, from, domain_, D + 1, memory, marker_group);
}

template void Build<2>::sweep_labels();
template void Build<3>::sweep_labels();
template void Build<2>::rekey_labels(const Domain<2> &, std::size_t);
template void Build<3>::rekey_labels(const Domain<3> &, std::size_t);

} // namespace abacus
