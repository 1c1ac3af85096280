// The simplices of a page linked with one another.
//
// Half of the links inside a page are stored: those between a simplex and its parent in a tree.
// The other facets find their partners by the numbers of their vertices, in a hash table of short
// chains, small enough for the processor's first cache. What finds none is the page's border.
#pragma once

#include "host/arena.hpp"
#include "mesh/page_format.hpp"

namespace abacus {

/// Whether a facet is a ghost's ridge, in a mesh that does not link them.
template <int D> constexpr bool is_loose_ridge(bool linked_ghosts, bool ghost, int facet) {
    return !linked_ghosts && ghost && facet < D;
}

template <int D> class InnerLinks {
public:
    explicit InnerLinks(const Host &host) : open_(host), facets_(host), chains_(host) {}

    /// Sets the links of the page's simplices in `slots`, whose handles begin with `first`. Lists
    /// the facets on the border from inside, in the order of the page, and marks the vertices
    /// there. Throws Error (corrupted) if facets do not fit.
    void connect(const PageView<D> &page, Simplex<D> *slots, Handle first, bool linked_ghosts,
                 Arena<Link> &border, Arena<bool> &on_border);

private:
    // Links name simplices by their numbers in the page here.
    struct LocalFacet {
        std::uint64_t vertices;
        Link link; // unset once it has found its partner
        std::uint16_t next;
        bool odd;
    };
    static constexpr std::uint16_t no_facet = 0xffff;

    static void join(Simplex<D> *slots, Handle first, Link a, Link b) {
        slots[to_number(link_simplex(a))].link[link_facet(a)] = link_from(first, b);
        slots[to_number(link_simplex(b))].link[link_facet(b)] = link_from(first, a);
    }
    /// Sets the links that are stored, and lists the facets that are still open.
    void join_trees(const PageView<D> &page, Simplex<D> *slots, Handle first);
    void match_open(const PageView<D> &page, Simplex<D> *slots, Handle first, bool linked_ghosts);
    void list_border(const PageView<D> &page, Handle first, Arena<Link> &border,
                     Arena<bool> &on_border) const;

    Arena<Link> open_;            // facets whose partner has to be searched for
    Arena<LocalFacet> facets_;    // those met so far
    Arena<std::uint16_t> chains_; // hash table of them: the last one of each chain
};

extern template class InnerLinks<2>;
extern template class InnerLinks<3>;

} // namespace abacus
