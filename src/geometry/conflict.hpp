// Whether a point conflicts with a simplex: lies in its open circumsphere, or for a
// ghost in the open half-space beyond its hull facet, under the perturbation.
#pragma once

#include "geometry/predicates.hpp"

namespace abacus {

enum class Side { inside, outside, vertex };

/// Of a finite simplex: `vertex` if and only if p equals a corner.
template <int D> inline Side side_of_simplex(const Corners<D> &corners, const Point<D> &p) {
    const int sign = in_sphere(corners, p);
    return sign > 0 ? Side::inside : sign < 0 ? Side::outside : Side::vertex;
}

/// Of a ghost, whose last corner is not read: `vertex` if and only if p lies on the hyperplane
/// of its facet and equals one of its corners.
template <int D> inline Side side_of_ghost(const Corners<D> &corners, const Point<D> &p) {
    const int sign = facet_side<D>(corners, D, p);
    if (sign != 0) return sign > 0 ? Side::inside : Side::outside;
    const int place = in_hull_facet(corners, p);
    return place > 0 ? Side::inside : place < 0 ? Side::outside : Side::vertex;
}

} // namespace abacus
