// Whether a point conflicts with a simplex of the cache: see geometry/conflict.hpp.
#pragma once

#include "geometry/conflict.hpp"
#include "mesh/cache.hpp"

namespace abacus {

template <int D>
inline Side side_of(const Cache<D> &cache, const Simplex<D> &s, const Point<D> &p) {
    if (!s.is_ghost()) [[likely]]
        return side_of_simplex<D>(cache.corners(s), p);
    Corners<D> facet;
    for (int i = 0; i < D; ++i) facet[i] = &cache.point(s.vertex[i]);
    return side_of_ghost<D>(facet, p);
}

} // namespace abacus
