// The edges of a mesh that is being changed on a segment between two of its vertices.
#pragma once

#include "delaunay/delaunay.hpp"
#include "traverse/straight.hpp"

namespace abacus {

/// Calls visit(edge) for each, in their order, with the triangle on its left; throws if one is
/// missing.
template <class Visit>
void each_edge_on(Delaunay<2> &mesh, const Point<2> &a, const Point<2> &b, Visit visit) {
    Cache<2> &cache = mesh.cache();
    for (Point<2> at = a; at != b;) {
        cache.poll();
        const Link corner = vertex_at(mesh, at);
        const Way way = corner == unset ? Way{} : straight_on(cache, corner, b);
        if (!way.is_edge) throw_corrupted("A segment of a line is not an edge of the mesh.");
        at = cache.point(cache.simplex(way.triangle).vertex[(way.corner + 1) % 3]);
        visit(make_link(way.triangle, (way.corner + 2) % 3));
        mesh.finish(mesh.anywhere);
    }
}

/// The triangle on the right of an edge.
inline Handle right_of(Cache<2> &cache, Link edge) {
    return link_simplex(cache.cross(link_simplex(edge), link_facet(edge)));
}

} // namespace abacus
