// Straight on from a vertex of a mesh in the plane: along an edge, or across a triangle.
#pragma once

#include "mesh/cache.hpp"

#include <optional>

namespace abacus {

/// For three points on one line: whether p lies on the same side of `from` as `to` does.
inline bool is_same_way(const Point<2> &from, const Point<2> &to, const Point<2> &p) {
    const int axis = to[0] == from[0] ? 1 : 0;
    return p[axis] != from[axis] && (to[axis] > from[axis]) == (p[axis] > from[axis]);
}
/// Whether p lies on the ray from a point through another one, and is not the first.
inline bool is_on_ray(const Point<2> &from, const Point<2> &to, const Point<2> &p) {
    return is_same_way(from, to, p) && orientation(from, to, p) == 0;
}
/// For p on the ray from a point through another one: whether p comes behind this one.
inline bool is_behind(const Point<2> &from, const Point<2> &to, const Point<2> &p) {
    return is_same_way(to, p, p) && !is_same_way(to, from, p);
}

/// Calls visit(triangle, corner) for the triangles around a vertex, counterclockwise, until it
/// returns false. `corner`: the vertex's in the first one, as a link.
template <class Visit> void turn_around(Cache<2> &cache, Link corner, Visit visit) {
    const Handle first = link_simplex(corner);
    Handle h = first;
    int at = link_facet(corner);
    std::size_t turns = 0;
    do {
        if (!visit(h, at)) return;
        const Link next = cache.cross(h, (at + 1) % 3);
        h = link_simplex(next);
        at = (link_facet(next) + 1) % 3;
        if (++turns % 4096 == 0) cache.poll();
    } while (h != first);
}

/// The other end of the fixed edge at a vertex that leads straight away from a place `behind` it.
inline std::optional<Point<2>> fixed_straight_on(Cache<2> &cache, Link corner,
                                                 const Point<2> &behind) {
    const Point<2> at = cache.point(cache.simplex(link_simplex(corner)).vertex[link_facet(corner)]);
    std::optional<Point<2>> found;
    turn_around(cache, corner, [&](Handle h, int i) {
        const VertexIndex x = cache.simplex(h).vertex[(i + 1) % 3];
        if (x == infinite_vertex || !cache.is_fixed(make_link(h, (i + 2) % 3))) return true;
        const Point<2> &p = cache.point(x);
        if (orientation(behind, at, p) == 0 && is_behind(behind, at, p)) found = p;
        return !found;
    });
    return found;
}

/// A triangle and its corner at the vertex. The way leads along the edge that begins there
/// counterclockwise, or across the triangle to the edge opposite.
struct Way {
    Handle triangle = no_handle;
    int corner = 0;
    bool is_edge = false;
};

/// The way from a vertex to another point within the hull.
inline Way straight_on(Cache<2> &cache, Link corner, const Point<2> &to) {
    const Point<2> from =
        cache.point(cache.simplex(link_simplex(corner)).vertex[link_facet(corner)]);
    Way way;
    turn_around(cache, corner, [&](Handle h, int at) {
        const auto &vertex = cache.simplex(h).vertex;
        const VertexIndex x = vertex[(at + 1) % 3], y = vertex[(at + 2) % 3];
        if (x == infinite_vertex) return true;
        const int side = orientation(from, cache.point(x), to);
        const bool is_edge = side == 0 && is_same_way(from, to, cache.point(x));
        if (is_edge ||
            (side > 0 && y != infinite_vertex && orientation(from, cache.point(y), to) < 0))
            way = {h, at, is_edge};
        return way.triangle == no_handle;
    });
    return way;
}

/// Goes across triangles to the next vertex on the way, which it returns: the point at infinity if
/// the way leaves the hull. Calls leave(edge) before each edge that it crosses, and goes no further
/// if that returns false: then it returns the vertex where it began. Else it calls enter(triangle,
/// corner opposite, turn). The turn is 1 if that corner lies left of the way, 0 on it, -1 right of
/// it. The corner is followed, counterclockwise, by the end of the edge on the left.
template <class Leave, class Enter>
VertexIndex go_across(Cache<2> &cache, const Way &way, const Point<2> &to, Leave leave,
                      Enter enter) {
    Handle h = way.triangle;
    int facet = way.corner;
    const VertexIndex begin = cache.simplex(h).vertex[facet];
    const Point<2> from = cache.point(begin);
    for (std::size_t crossed = 1;; ++crossed) {
        if (!leave(make_link(h, facet))) return begin;
        const Link beyond = cache.cross(h, facet);
        h = link_simplex(beyond);
        const int apex = link_facet(beyond);
        const VertexIndex z = cache.simplex(h).vertex[apex];
        if (z == infinite_vertex) return z;
        const int turn = orientation(from, to, cache.point(z));
        enter(h, apex, turn);
        if (turn == 0) return z;
        facet = (apex + (turn > 0 ? 1 : 2)) % 3;
        if (crossed % 4096 == 0) cache.poll();
    }
}

} // namespace abacus
