#include "mesh/inner_links.hpp"

#include <algorithm>
#include <bit>

namespace abacus {

template <int D>
void InnerLinks<D>::connect(const PageView<D> &page, Simplex<D> *slots, Handle first,
                            bool linked_ghosts, Arena<Link> &border, Arena<bool> &on_border) {
    join_trees(page, slots, first);
    match_open(page, slots, first, linked_ghosts);
    list_border(page, first, border, on_border);
    if (static_cast<int>(border.size()) != page.links())
        throw_corrupted("A page does not have as many links as facets on its border.");
}

template <int D>
void InnerLinks<D>::join_trees(const PageView<D> &page, Simplex<D> *slots, Handle first) {
    const int simplices = page.simplices();
    for (int s = 0; s < simplices; ++s) slots[s].link.fill(unset);
    for (int s = 0; s < simplices; ++s) {
        const PageLink parent = page.parent(s);
        if (parent == PageView<D>::no_link) [[unlikely]]
            continue;
        join(slots, first, make_link(Handle{page_simplex(parent)}, page_facet(parent)),
             make_link(static_cast<Handle>(s), page.facet_to_parent(s)));
    }
    // Gathers the open facets without a branch: which ones are open is hard to predict.
    open_.resize(std::size_t(simplices) * (D + 1) + 1); // one more, which is overwritten
    Link *open = open_.begin();
    for (int s = 0; s < simplices; ++s)
        for (int i = 0; i <= D; ++i) {
            *open = make_link(static_cast<Handle>(s), i);
            open += slots[s].link[i] == unset;
        }
    open_.resize(static_cast<std::size_t>(open - open_.begin()));
}

template <int D>
void InnerLinks<D>::match_open(const PageView<D> &page, Simplex<D> *slots, Handle first,
                               bool linked_ghosts) {
    chains_.resize(std::bit_ceil(open_.size() + 1));
    std::fill(chains_.begin(), chains_.end(), no_facet);
    const int shift = 64 - std::countr_zero(chains_.size());
    facets_.clear();
    facets_.reserve(open_.size());
    for (const Link link : open_) {
        const int s = static_cast<int>(link_simplex(link)), i = link_facet(link);
        if (is_loose_ridge<D>(linked_ghosts, page.is_ghost(s), i)) {
            slots[s].link[i] = link_from(first, link); // a link to itself
            continue;
        }
        const FacetVertices<D, std::uint32_t> facet(page.corners(s), i);
        std::uint64_t vertices = 0;
        for (const std::uint32_t v : facet.vertex) vertices = vertices << 16 | v;
        std::uint16_t &chain = chains_[shift == 64 ? 0 : vertices * 0x9e3779b97f4a7c15ull >> shift];
        std::uint16_t at = chain;
        while (at != no_facet && facets_[at].vertices != vertices) at = facets_[at].next;
        if (at == no_facet) {
            facets_.push_back({vertices, link, chain, facet.odd});
            chain = static_cast<std::uint16_t>(facets_.size() - 1);
            continue;
        }
        LocalFacet &other = facets_[at];
        if (other.link == unset) throw_corrupted("Three simplices share a facet.");
        if (other.odd == facet.odd) throw_corrupted("Neighbours have different orientations.");
        join(slots, first, other.link, link);
        other.link = unset;
    }
}

/// Lists the facets without a partner, in the order of their simplices.
template <int D>
void InnerLinks<D>::list_border(const PageView<D> &page, Handle first, Arena<Link> &border,
                                Arena<bool> &on_border) const {
    border.clear();
    on_border.resize(static_cast<std::size_t>(page.vertices()));
    std::fill(on_border.begin(), on_border.end(), false);
    for (const LocalFacet &facet : facets_) {
        if (facet.link == unset) continue;
        const Link link = facet.link;
        border.push_back(link_from(first, link));
        const int s = static_cast<int>(link_simplex(link));
        for (int j = 0; j <= D; ++j)
            if (j != link_facet(link) && page.corner(s, j) < page.vertices())
                on_border[page.corner(s, j)] = true;
    }
}

template class InnerLinks<2>;
template class InnerLinks<3>;

} // namespace abacus
