// A mesh cut into parts, and shares of it, behind the C interface.
#include "query/shares/part_sizes.hpp"
#include "query/shares/share.hpp"
#include "sort/pacer.hpp"

#include "capi/dispatch.hpp"
#include "capi/mesh.hpp"

namespace {

using namespace abacus;

/// The mesh's last cut, if it is this one, else a new one, which the handle keeps.
template <int D>
const Cut<D> &cut_of(abacus_mesh &mesh, const abacus_facts &facts, const abacus_cut &cut,
                     std::size_t memory) {
    auto &kept = std::get<D - 2>(mesh.cuts);
    if (!kept || !kept->is_same(cut)) {
        kept.reset();
        kept.emplace(mesh.host, facts, cut, memory);
    }
    return *kept;
}

/// Calls use(share), unless the part is empty.
template <int D, class Use>
void use_share(abacus_mesh &mesh, const abacus_facts &facts, const abacus_share &share,
               std::size_t memory, Use use) {
    if (facts.census.simplices == 0) return;
    const Cut<D> &cut = cut_of<D>(mesh, facts, share.cut, memory);
    const auto own = cut.piece_of(share.part);
    if (!own) return;
    Share<D> made(mesh.host, facts, cut, *own, share.halo, memory);
    use(made);
}

/// The markers of the facets of simplices.
template <int D> class FacetMarkers {
public:
    FacetMarkers(const Host &host, const abacus_facts &facts) {
        if (facts.census.marked > 0)
            stored_.emplace(host, domain_of<D>(facts.form), D + 1, SimplexLabels<D>::default_bytes,
                            marker_group);
    }

    /// Of the facet opposite each corner.
    void of(const abacus_simplex &simplex, double *markers) {
        std::fill_n(markers, D + 1, null_value);
        if (!stored_) return;
        std::array<Point<D>, D + 1> corners;
        for (int i = 0; i <= D; ++i) std::copy_n(simplex.corner[i], D, corners[i].begin());
        const Owner<D, D + 1> owner = owner_of<D, D + 1>(corners);
        std::array<double, D + 1> found;
        if (!stored_->values_if_any(owner, found.data())) return;
        for (int i = 0; i <= D; ++i)
            for (int k = 0; k <= D; ++k)
                if (owner[k] == corners[i]) markers[i] = found[k];
    }

private:
    std::optional<AttributeReader<D, D + 1>> stored_;
};

} // namespace

abacus_status abacus_mesh_parts(abacus_mesh *mesh, const abacus_cut *cut, size_t memory,
                                abacus_part_report report, void *context, abacus_error *error) {
    return dispatch(mesh->reader, error, [&]<int D>(Reader<D> &reader) {
        const auto visit = [&](const abacus_part &part) { host::require(report(context, &part)); };
        const abacus_facts &facts = reader.facts();
        if (facts.census.simplices > 0)
            return part_sizes<D>(mesh->host, facts, cut_of<D>(*mesh, facts, *cut, memory), memory,
                                 visit);
        for (std::uint32_t part = 0; part < cut->parts; ++part) {
            if (part % Pacer::stride == 0) mesh->host.poll();
            abacus_part none{};
            none.part = part;
            visit(none);
        }
    });
}

abacus_status abacus_mesh_share_vertices(abacus_mesh *mesh, const abacus_share *share,
                                         size_t memory, abacus_share_vertex_report report,
                                         void *context, abacus_error *error) {
    return dispatch(mesh->reader, error, [&]<int D>(Reader<D> &reader) {
        use_share<D>(*mesh, reader.facts(), *share, memory, [&](Share<D> &made) {
            made.vertices([&](const abacus_share_vertex &vertex) {
                host::require(report(context, &vertex));
            });
        });
    });
}

abacus_status abacus_mesh_share_simplices(abacus_mesh *mesh, const abacus_share *share,
                                          size_t memory, abacus_share_simplex_report report,
                                          void *context, abacus_error *error) {
    return dispatch(mesh->reader, error, [&]<int D>(Reader<D> &reader) {
        const abacus_facts &facts = reader.facts();
        FacetMarkers<D> markers(mesh->host, facts);
        use_share<D>(*mesh, facts, *share, memory, [&](Share<D> &made) {
            made.simplices([&](abacus_share_simplex &simplex) {
                simplex.labels = mesh->labels.get<D>().of(simplex.simplex);
                markers.of(simplex.simplex, simplex.markers);
                host::require(report(context, &simplex));
            });
        });
    });
}
