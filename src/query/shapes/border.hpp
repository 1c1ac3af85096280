// The border between triangles that are kept and what is not, edge by edge.
//
// The edges have the kept triangles on their left. At a vertex where several of them end, each
// continues along the triangles on its left: so parts that are connected only in a vertex have
// separate borders.
//
// Between two steps blocks may leave the cache. So an edge is named by its ends, and by the page
// that has its triangle.
#pragma once

#include "query/shapes/kept_simplices.hpp"

namespace abacus {

class Border {
public:
    struct Edge {
        Point<2> from, to;
        Key page;
        Handle triangle;
        int facet;

        bool is(const Edge &other) const { return from == other.from && to == other.to; }
        /// A total order of edges.
        bool comes_before(const Edge &other) const {
            return from != other.from ? lexicographically_less<2>(from, other.from)
                                      : lexicographically_less<2>(to, other.to);
        }
    };

    Border(Cache<2> &cache, const Kept &kept) : cache_(cache), kept_(kept) {}

    bool is_kept(Handle h) const { return abacus::is_kept<2>(kept_, cache_, h); }
    /// For a kept triangle: whether its neighbour across a facet is not kept.
    bool is_border(Handle h, int facet) { return !is_kept(link_simplex(cache_.cross(h, facet))); }
    Edge edge(Handle h, int facet) const;
    Edge next(const Edge &edge) { return turn(edge, true); }
    Edge before(const Edge &edge) { return turn(edge, false); }
    std::int64_t id(const Edge &edge) const {
        return cache_.vertices().id(cache_.simplex(edge.triangle).vertex[(edge.facet + 1) % 3]);
    }

    /// Lets blocks leave the cache, if it is full. `edges` will be used again.
    template <std::size_t n> void make_room(const std::array<Edge *, n> &edges) {
        for (const Edge *edge : edges) cache_.use(edge->triangle);
        const std::uint64_t evictions = cache_.counters.evictions;
        cache_.trim();
        if (cache_.counters.evictions == evictions) return;
        for (Edge *edge : edges) find(*edge);
    }
    /// Finds the triangle of an edge again.
    void find(Edge &edge);
    /// Whether no edge of its ring comes before this one. Steps go both ways in turn: so they go at
    /// most twice as far as to the nearest edge that comes before, and all edges of a ring of n
    /// together take some n log n steps.
    bool is_first_of_ring(Edge edge);

private:
    /// To the edge that begins where this one ends, or ends where it begins.
    Edge turn(const Edge &edge, bool is_forward);

    Cache<2> &cache_;
    const Kept kept_;
    std::uint64_t steps_ = 0;
};

} // namespace abacus
