// Whether triangles have more in common than their borders. Exact.
//
// The inner parts of two convex polygons are disjoint if and only if the line along an edge of one
// of them has one polygon on its one side and the other on its other side, each perhaps touching
// it. A segment is a polygon of one edge here. Its ends do not matter: where it comes into the
// inner part of a triangle, points next to an end do, too.
#pragma once

#include "geometry/predicates.hpp"

namespace abacus {

/// Whether n points are beyond one edge of a triangle of positive orientation, or on its line;
/// with `strictly` none is on it.
inline bool lie_beyond_edge(const Corners<2> &triangle, const Point<2> *const *points, int n,
                            bool strictly) {
    const int most = strictly ? -1 : 0;
    for (int edge = 0; edge < 3; ++edge) {
        int i = 0;
        while (i < n && facet_side<2>(triangle, edge, *points[i]) <= most) ++i;
        if (i == n) return true;
    }
    return false;
}

/// Whether two triangles of positive orientation overlap: have a part with an area in common.
inline bool overlap(const Corners<2> &a, const Corners<2> &b) {
    return !lie_beyond_edge(a, b.data(), 3, false) && !lie_beyond_edge(b, a.data(), 3, false);
}

/// Whether the segment between two different points has points strictly inside of a triangle.
inline bool passes_through(const Point<2> &a, const Point<2> &b, const Corners<2> &triangle) {
    const Point<2> *const ends[2] = {&a, &b};
    if (lie_beyond_edge(triangle, ends, 2, false)) return false;
    bool is_left = false, is_right = false;
    for (const Point<2> *corner : triangle) {
        const int side = orientation(a, b, *corner);
        is_left = is_left || side > 0;
        is_right = is_right || side < 0;
    }
    return is_left && is_right;
}

} // namespace abacus
