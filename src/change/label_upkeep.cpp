#include "change/label_upkeep.hpp"

#include "attributes/rewriting.hpp"
#include "blocks/counters.hpp"
#include "constrain/edge_heirs.hpp"
#include "labels/label_heirs.hpp"
#include "labels/marker_sweep.hpp"

namespace abacus {

namespace {
constexpr std::size_t share = 4; // of the cache's memory, beside it

class LineHeirs final : public MarkerHeirs<2> {
public:
    LineHeirs(Delaunay<2> &mesh, std::size_t memory) : heirs_(mesh, memory) {}

    void add(const Facet &facet, double marker) override { heirs_.add(facet[0], facet[1], marker); }
    void each(const std::function<void(const Facet &, double)> &visit) override {
        heirs_.each([&](const Point<2> &a, const Point<2> &b, double marker) {
            visit({a, b}, marker);
        });
    }

private:
    EdgeHeirs heirs_;
};

} // namespace

template <int D> void LabelUpkeep<D>::sweep() {
    abacus_census &census = work_.facts->census;
    if (work_.core->mesh.simplices() == 0) {
        erase_attributes(work_.host, first_group<D + 1>);
        erase_attributes(work_.host, marker_group);
        census.labelled = census.marked = 0;
    }
    if (census.labelled > 0) sweep_labels();
    if (census.marked > 0) sweep_markers();
    stored_->clear();
}

template <int D> void LabelUpkeep<D>::sweep_labels() {
    abacus_census &census = work_.facts->census;
    const abacus_columns &columns = work_.facts->columns;
    LabelSweep<D> sweep(work_.host, *work_.facts, work_.domain, columns.labels, first_group<D + 1>);
    std::optional<LabelHeirs<D>> heirs;
    typename LabelSweep<D>::Report lose;
    if (columns.inherits != 0) {
        heirs.emplace(work_.host, columns.labels, work_.cache_bytes / share);
        lose = [&](const auto &simplex, const double *v) { heirs->lose(simplex, v); };
    }
    std::uint64_t gone = 0;
    for (const StoredPages::Stretch &stretch : stored_->stretches())
        gone += sweep.sweep(stretch, lose);
    if (gone > census.labelled) throw_corrupted("The header counts too few labels.");
    census.labelled -= gone;
    lost_ += gone;
    if (heirs) census.labelled += heirs->pass_on(sweep, stored_->stretches());
    work_.counters() += sweep.finish();
}

template <int D> void LabelUpkeep<D>::sweep_markers() {
    abacus_census &census = work_.facts->census;
    MarkerSweep<D> sweep(work_.host, *work_.facts, work_.domain, work_.cache_bytes / share);
    std::optional<LineHeirs> of_lines;
    MarkerHeirs<D> *heirs = nullptr;
    if constexpr (D == 2)
        if (work_.core->mesh.is_constrained)
            heirs = &of_lines.emplace(work_.core->mesh, work_.cache_bytes / share);
    census.marked = sweep.sweep(stored_->stretches(), census.marked, heirs);
    work_.counters() += sweep.finish();
}

template <int D> void LabelUpkeep<D>::rekey(const Domain<D> &from, std::size_t memory) {
    const abacus_facts &facts = *work_.facts;
    if (facts.census.labelled > 0)
        work_.counters() += rekey_attributes<D, D + 1>(work_.host, from, work_.domain,
                                                       facts.columns.labels, memory);
    if (facts.census.marked > 0)
        work_.counters() +=
            rekey_attributes<D, D + 1>(work_.host, from, work_.domain, D + 1, memory, marker_group);
}

template class LabelUpkeep<2>;
template class LabelUpkeep<3>;

} // namespace abacus
