// The edges of a mesh in the plane that make up a segment between two vertices.
#pragma once

#include "query/locate/reader.hpp"
#include "traverse/straight.hpp"

namespace abacus {

/// A corner of a triangle at a place; nothing if there is no vertex.
inline std::optional<Link> corner_at(Reader<2> &reader, const Point<2> &p) {
    Cache<2> &cache = reader.cache();
    const Handle h = reader.simplex_around(p);
    if (h == no_handle) return {};
    for (int i = 0; i < cache.simplex(h).finite_vertices(); ++i)
        if (cache.point(cache.simplex(h).vertex[i]) == p) return make_link(h, i);
    return {};
}

/// Calls visit(a, b, how) for the vertices at both ends of each edge, in the order from p to
/// q. False if an end is not a vertex, or an edge is missing, where this stops.
template <class Visit>
bool edges_along(Reader<2> &reader, const Point<2> &p, const Point<2> &q, Visit visit) {
    Cache<2> &cache = reader.cache();
    for (Point<2> at = p; at != q;) {
        const std::optional<Link> corner = corner_at(reader, at);
        if (!corner) return false;
        const Way way = straight_on(cache, *corner, q);
        if (!way.is_edge) return false;
        const auto &vertex = cache.simplex(way.triangle).vertex;
        const VertexIndex end = vertex[(way.corner + 1) % 3];
        const Point<2> next = cache.point(end);
        if (is_behind(at, q, next)) return false;
        visit(vertex[way.corner], end, cache.fixed(make_link(way.triangle, (way.corner + 2) % 3)));
        at = next;
    }
    return true;
}

} // namespace abacus
