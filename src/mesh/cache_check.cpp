// The invariants of the mesh cache: see mesh/cache.hpp.
#include "mesh/cache.hpp"

namespace abacus {

template <int D> const char *Cache<D>::check_links(Handle h) const {
    const Simplex<D> &s = slots_[h];
    for (int i = 0; i < D; ++i)
        if (s.vertex[i] == infinite_vertex) return "the point at infinity is not a last corner";
    for (int i = 0; i <= D; ++i) {
        const Link here = make_link(h, i), there = s.link[i];
        if (there == unset) return "a link is unset";
        if (is_absent(there)) {
            const std::uint32_t entry = visible_facet(there);
            if (!visible_.has(entry)) return "an absent link names no visible facet";
            if (visible_[entry].owner != here) return "a visible facet has another owner";
            if (visible_[entry].hash != hash(here)) return "a visible facet has another hash";
            for (int j = 0; j <= D; ++j)
                if (j != i && s.vertex[j] != infinite_vertex && !vertices_.is_shared(s.vertex[j]))
                    return "a vertex of a visible facet is not shared";
            continue;
        }
        if (there == here) {
            if (!is_loose_ridge<D>(options_.linked_ghosts, s.is_ghost(), i))
                return "a simplex is its own neighbour";
            continue;
        }
        if (!this->is_live(link_simplex(there)) || link_facet(there) > D)
            return "a link leads to no simplex";
        if (slots_[link_simplex(there)].link[link_facet(there)] != here)
            return "a link does not lead back";
        const auto a = facet(here), b = facet(there);
        if (a.vertex != b.vertex) return "a link leads to another facet";
        if (a.odd == b.odd) return "neighbours have the same orientation";
        if (fixed(here) != fixed(there)) return "an edge is fixed on one side only";
        if (!is_fixed(here) && region(link_simplex(here)) != region(link_simplex(there)))
            return "a region ends at an edge that is not fixed";
    }
    return nullptr;
}

template <int D> const char *Cache<D>::check_vertices() const {
    Arena<std::uint32_t, VertexIndex> uses(host_);
    uses.resize(vertices_.end());
    std::fill(uses.begin(), uses.end(), 0);
    for_each_cached([&](BlockIndex b) {
        for_each_record(b, [&](Handle h) {
            for (const VertexIndex v : slots_[h].vertex) ++uses[v];
        });
    });
    for (std::uint32_t n = 0; n < uses.size(); ++n)
        if (const VertexIndex v{n}; uses[v] != vertices_.references(v))
            return "a vertex counts its simplices wrong";
    return nullptr;
}

template <int D> const char *Cache<D>::check_invariants(bool forged) const {
    if (const char *fault = Blocks::check_invariants(forged)) return fault;
    const char *fault = nullptr;
    std::size_t absents = 0;
    for_each_cached([&](BlockIndex b) {
        for_each_record(b, [&](Handle h) {
            if (fault == nullptr) fault = check_links(h);
            for (const Link link : slots_[h].link) absents += is_absent(link);
        });
    });
    if (fault != nullptr) return fault;
    if (absents != visible_.count()) return "a visible facet has no owner";
    return check_vertices();
}

} // namespace abacus
