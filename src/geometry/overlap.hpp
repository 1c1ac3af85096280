// Whether simplices have more in common than their borders. Exact.
//
// The inner parts of two convex polygons are disjoint if and only if the line along an edge of one
// of them has one polygon on its one side and the other on its other side, each perhaps touching
// it. A segment is a polygon of one edge here. Its ends do not matter: where it comes into the
// inner part of a triangle, points next to an end do, too.
//
// In space a plane keeps two polytopes apart that is parallel to a facet of one, or to an edge of
// each. The latter touches both in these edges, so it contains the one and has the other on its far
// side or in it.
#pragma once

#include "geometry/predicates.hpp"

#include <algorithm>
#include <array>

namespace abacus {

/// The corners of a facet of a simplex, or of an edge of a triangle.
template <int D> using FacetCorners = std::array<const Point<D> *, D>;

/// Whether n points are beyond one facet of a simplex of positive orientation, or on its line or
/// plane; with `strictly` none is on it.
template <int D>
bool lie_beyond_facet(const Corners<D> &simplex, const Point<D> *const *points, int n,
                      bool strictly) {
    const int most = strictly ? -1 : 0;
    for (int facet = 0; facet <= D; ++facet) {
        int i = 0;
        while (i < n && facet_side<D>(simplex, facet, *points[i]) <= most) ++i;
        if (i == n) return true;
    }
    return false;
}

/// The pairs of corners of a tetrahedron at the ends of an edge, each before the other two corners.
inline constexpr std::array<std::array<int, 4>, 6> tetrahedron_edges{
    {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 0, 2}, {2, 3, 0, 1}}};

/// Whether a plane through an edge of a tetrahedron, and parallel to one of another, keeps their
/// inner parts apart.
inline bool are_kept_apart_at_edges(const Corners<3> &a, const Corners<3> &b) {
    for (const auto &of_a : tetrahedron_edges)
        for (const auto &of_b : tetrahedron_edges) {
            const auto side = [&](const Point<3> &p) {
                return side_of_parallel(*a[of_a[0]], *a[of_a[1]], *b[of_b[0]], *b[of_b[1]], p);
            };
            // All of a on one side of the plane through its edge, and not all in it.
            const int third = side(*a[of_a[2]]), fourth = side(*a[of_a[3]]);
            const int own = third != 0 ? third : fourth;
            if (own == 0 || third * fourth < 0) continue;
            const auto is_beyond = [&](int i) { return side(*b[of_b[i]]) * own <= 0; };
            if (is_beyond(0) && is_beyond(2) && is_beyond(3)) return true; // 1 is level with 0
        }
    return false;
}

/// Whether two simplices of positive orientation overlap: have a part with an area, or volume, in
/// common.
template <int D> bool overlap(const Corners<D> &a, const Corners<D> &b) {
    if (lie_beyond_facet<D>(a, b.data(), D + 1, false) ||
        lie_beyond_facet<D>(b, a.data(), D + 1, false))
        return false;
    if constexpr (D == 3) return !are_kept_apart_at_edges(a, b);
    return true;
}

/// Whether a facet, which is not flat, has points strictly inside of a simplex. In space also true
/// for some facets that only an edge keeps apart from it.
template <int D> bool may_pass_through(const FacetCorners<D> &facet, const Corners<D> &simplex) {
    if (lie_beyond_facet<D>(simplex, facet.data(), D, false)) return false;
    Corners<D> sides;
    std::copy(facet.begin(), facet.end(), sides.begin());
    bool is_left = false, is_right = false;
    for (const Point<D> *corner : simplex) {
        sides[D] = corner;
        const int side = orientation<D>(sides);
        is_left = is_left || side > 0;
        is_right = is_right || side < 0;
    }
    return is_left && is_right;
}

/// Whether the segment between two different points has points strictly inside of a triangle.
inline bool passes_through(const Point<2> &a, const Point<2> &b, const Corners<2> &triangle) {
    return may_pass_through<2>({&a, &b}, triangle);
}

} // namespace abacus
