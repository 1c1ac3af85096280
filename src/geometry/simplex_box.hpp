// Whether a simplex and a box have a point in common. Exact.
//
// Two convex polytopes are disjoint if and only if a plane keeps them apart that is parallel to a
// facet of one, or to an edge of each (the separating axis theorem). The facets of a box are
// compared by coordinates. For a facet of the simplex the orientation predicate tells on which
// side each corner of the box lies. A plane along an edge of the box is a line where one axis is
// left out: so in space the edges are those of three flat pictures, and the predicate is that of
// the plane. No coordinate is computed, so no rounding occurs.
#pragma once

#include "geometry/box.hpp"
#include "geometry/predicates.hpp"

namespace abacus {

/// Whether all of the box lies strictly beyond a facet, on the side where the simplex is not; the
/// corner opposite is not read.
template <int D> bool lies_beyond(const Box<D> &box, const Corners<D> &corners, int facet) {
    for (int i = 0; i < 1 << D; ++i)
        if (facet_side<D>(corners, facet, box.corner(i)) >= 0) return false;
    return true;
}

/// Whether a line through two of n points in the plane has all of them on one side, or on it, and
/// all of the box on the other; with `strictly` no corner of the box is on the line.
inline bool is_kept_apart(const Point<2> *points, int n, const Box<2> &box, bool strictly) {
    const int most = strictly ? -1 : 0;
    const auto keeps_apart = [&](const Point<2> &a, const Point<2> &b) {
        for (int i = 0; i < n; ++i)
            if (orientation(a, b, points[i]) < 0) return false;
        for (int i = 0; i < 4; ++i)
            if (orientation(a, b, box.corner(i)) > most) return false;
        return true;
    };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            if (!(points[i] == points[j]) && keeps_apart(points[i], points[j])) return true;
    return false;
}

/// Whether a finite simplex of positive orientation meets the closed box.
template <int D> bool meets(const Corners<D> &corners, const Box<D> &box) {
    Box<D> around;
    for (const Point<D> *corner : corners) around.extend(*corner);
    if (!around.meets(box)) return false;
    for (const Point<D> *corner : corners)
        if (box.contains(*corner)) return true;
    for (int facet = 0; facet <= D; ++facet)
        if (lies_beyond<D>(box, corners, facet)) return false;
    if constexpr (D == 3) {
        for (int k = 0; k < 3; ++k) { // the axis that is left out
            const auto flat = [k](const Point<3> &p) {
                return Point<2>{p[(k + 1) % 3], p[(k + 2) % 3]};
            };
            Point<2> points[4];
            for (int i = 0; i < 4; ++i) points[i] = flat(*corners[i]);
            if (is_kept_apart(points, 4, {flat(box.lower), flat(box.upper)}, true)) return false;
        }
    }
    return true;
}

} // namespace abacus
