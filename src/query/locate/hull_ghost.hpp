// Where a walk around the hull of a mesh begins.
#pragma once

#include "query/locate/reader.hpp"

namespace abacus {

/// Some ghost of a convex mesh that is not empty.
template <int D> Handle hull_ghost(Reader<D> &reader) {
    Cache<D> &cache = reader.cache();
    Point<D> away;
    away.fill(std::numeric_limits<double>::lowest());
    const Handle h = reader.simplex_around(away);
    if (cache.simplex(h).is_ghost()) return h;
    // A simplex can have that place only as a corner, which is then on the hull.
    VertexIndex corner = cache.simplex(h).vertex[0];
    for (const VertexIndex v : cache.simplex(h).vertex)
        if (cache.point(v) == away) corner = v;
    Handle found = no_handle;
    reader.flood().around(cache, h, corner, [&](Handle met) {
        if (cache.simplex(met).is_ghost()) found = met;
        return found == no_handle;
    });
    if (found == no_handle) throw_corrupted("A vertex of the hull has no ghost.");
    return found;
}

} // namespace abacus
