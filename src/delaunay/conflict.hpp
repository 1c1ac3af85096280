// Whether a point conflicts with a simplex: lies in its open circumsphere, or for a
// ghost in the open half-space beyond its hull facet, under the perturbation.
#pragma once

#include "cache/cache.hpp"

namespace abacus {

enum class Side { inside, outside, vertex };

/// `vertex` if and only if p equals a corner of a finite simplex, or lies on the
/// hyperplane of a ghost's facet and equals one of its corners.
template <int D>
inline Side side_of(const Cache<D> &cache, const Simplex<D> &s, const Point<D> &p) {
    if (!s.is_ghost()) [[likely]] {
        const int sign = in_sphere(cache.corners(s), p);
        return sign > 0 ? Side::inside : sign < 0 ? Side::outside : Side::vertex;
    }
    Corners<D> corners;
    for (int i = 0; i < D; ++i) corners[i] = &cache.point(s.vertex[i]);
    corners[D] = &p;
    const int sign = orientation<D>(corners);
    if (sign != 0) return sign > 0 ? Side::inside : Side::outside;
    const int place = in_hull_facet(corners, p);
    return place > 0 ? Side::inside : place < 0 ? Side::outside : Side::vertex;
}

} // namespace abacus
