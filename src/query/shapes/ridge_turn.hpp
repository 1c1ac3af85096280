// The simplices around a ridge, which is a vertex in the plane and an edge in space, in their
// order.
#pragma once

#include "mesh/cache.hpp"

namespace abacus {

/// Calls visit(simplex, kept) for the simplices around the ridge, from one of them on:
/// counterclockwise, in space as seen from the second vertex of the ridge. `kept` is the corner
/// that it shares with the next one, besides the ridge.
template <int D, class Visit>
void turn_around(Cache<D> &cache, Handle first, const std::array<VertexIndex, D - 1> &ridge,
                 Visit visit) {
    std::array<int, D + 1> order;
    int n = 0;
    for (const VertexIndex v : ridge) order[n++] = cache.simplex(first).index_of(v);
    for (int i = 0; i <= D; ++i)
        if (std::find(order.begin(), order.begin() + (D - 1), i) == order.begin() + (D - 1))
            order[n++] = i;
    if (!is_even(order)) std::swap(order[D - 1], order[D]);
    int dropped = order[D - 1], kept = order[D];
    Handle at = first;
    do {
        const VertexIndex stays = cache.simplex(at).vertex[kept];
        visit(at, stays);
        const Link link = cache.cross(at, dropped);
        at = link_simplex(link);
        dropped = cache.simplex(at).index_of(stays);
        kept = link_facet(link);
    } while (at != first);
}

} // namespace abacus
