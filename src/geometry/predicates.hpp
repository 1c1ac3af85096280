// Exact predicates: orientation, and what follows from it; in-sphere under symbolic
// perturbation.
//
// Each predicate first evaluates the determinant in doubles and compares it with a
// bound on the rounding error; only when that does not decide does it call the exact
// form in predicates.cpp: 128-bit integers where they hold the determinant, else CGAL's
// filtered kernel. The bounds are Shewchuk's ("Adaptive Precision Floating-Point
// Arithmetic and Fast Robust Geometric Predicates", 1997, the A estimates) for the very
// expressions below. The in-sphere tests replace the permanent in them by a value that
// is no less and quicker to compute; their constant is rounded up far enough for the
// roundings of that value. The bounds hold while nothing underflows or overflows. An
// overflow makes the bound infinite, which nothing exceeds. An underflow changes a
// product by at most the least double, and this error grows with the factors that
// follow. Where it could exceed what the constants are rounded up by, the exact form
// decides.
//
// Degeneracy: cospherical points are resolved by perturbing the lifting to the
// paraboloid symbolically, in the lexicographic order of the points (Devillers
// and Teillaud, "Perturbations for Delaunay and Weighted Delaunay 3D
// Triangulations", 2011), exactly as CGAL does. The Delaunay triangulation is
// then unique: a function of the point set alone.
//
// Signs: orientation is +1 when the corners are in positive order, which is
// counterclockwise in 2D; in 3D, the right hand's fingers curl along the first
// three corners and the thumb points to the fourth (dissertation, Figure 4.4),
// that is det(b-a, c-a, d-a) > 0.
#pragma once

#include "geometry/in_sphere.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace abacus {

/// The D+1 corners of a simplex, by reference.
template <int D> using Corners = std::array<const Point<D> *, D + 1>;

namespace exact {
int orientation(const Point<2> &a, const Point<2> &b, const Point<2> &c);
int orientation(const Point<3> &a, const Point<3> &b, const Point<3> &c, const Point<3> &d);
/// As side_of_parallel() below.
int side_of_parallel(const Point<3> &a, const Point<3> &b, const Point<3> &c, const Point<3> &d,
                     const Point<3> &p);
/// As in_sphere() below.
template <int D> int in_sphere(const Corners<D> &corners, const Point<D> &p);
/// The same without perturbation: 0 on the sphere.
template <int D> int unperturbed_in_sphere(const Corners<D> &corners, const Point<D> &p);
/// As in_hull_facet() below.
int in_hull_facet(const Corners<3> &corners, const Point<3> &p);
} // namespace exact

/// Twice the signed area of a triangle, and a bound on its rounding error, which is infinite
/// where none is known.
struct SignedArea {
    double value, error;

    bool is_positive() const { return value > error; }
    bool is_negative() const { return value < -error; }
    bool is_sure() const { return is_positive() | is_negative(); }
};

/// Of two points as seen from a third, by rounded differences: positive if these are
/// counterclockwise.
inline SignedArea signed_area(const Point<2> &a, const Point<2> &b) {
    const double left = a[0] * b[1], right = a[1] * b[0];
    const double sum = std::fabs(left) + std::fabs(right);
    constexpr double unknown = std::numeric_limits<double>::infinity();
    return {left - right, sum > 1e-290 ? 3.3307e-16 * sum : unknown};
}

/// +1 if a, b, c are counterclockwise, -1 if clockwise, 0 if collinear.
inline int orientation(const Point<2> &a, const Point<2> &b, const Point<2> &c) {
    const SignedArea area = signed_area({a[0] - c[0], a[1] - c[1]}, {b[0] - c[0], b[1] - c[1]});
    if (area.is_positive()) return 1;
    if (area.is_negative()) return -1;
    return exact::orientation(a, b, c);
}

/// The sign of det(a, b, c), of rounded differences of points; 0 where it is not sure.
inline int sure_volume_sign(const Point<3> &a, const Point<3> &b, const Point<3> &c) {
    const auto [ax, ay, az] = a;
    const auto [bx, by, bz] = b;
    const auto [cx, cy, cz] = c;
    const double bc = bx * cy, cb = cx * by, ca = cx * ay, ac = ax * cy, ab = ax * by, ba = bx * ay;
    const double det = az * (bc - cb) + bz * (ca - ac) + cz * (ab - ba);
    const double permanent = std::fabs(az) * (std::fabs(bc) + std::fabs(cb)) +
                             std::fabs(bz) * (std::fabs(ca) + std::fabs(ac)) +
                             std::fabs(cz) * (std::fabs(ab) + std::fabs(ba));
    const double bound = 7.7716e-16 * permanent;
    const double size = std::fabs(az) + std::fabs(bz) + std::fabs(cz);
    if (permanent > 1e-250 && permanent > 1e-290 * size) [[likely]] {
        if (det > bound) return 1;
        if (det < -bound) return -1;
    }
    return 0;
}

inline Point<3> way(const Point<3> &from, const Point<3> &to) {
    return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
}

/// +1 if det(b-a, c-a, d-a) > 0, -1 if < 0, 0 if coplanar.
inline int orientation(const Point<3> &a, const Point<3> &b, const Point<3> &c, const Point<3> &d) {
    const int sign = sure_volume_sign(way(d, a), way(d, b), way(d, c));
    if (sign != 0) [[likely]]
        return -sign;
    return exact::orientation(a, b, c, d);
}

/// On which side p lies of the plane that contains a and b, and is parallel to the line through c
/// and d: the sign of det(b-a, d-c, p-a). Always 0 if the lines are parallel.
inline int side_of_parallel(const Point<3> &a, const Point<3> &b, const Point<3> &c,
                            const Point<3> &d, const Point<3> &p) {
    const int sign = sure_volume_sign(way(a, b), way(c, d), way(a, p));
    return sign != 0 ? sign : exact::side_of_parallel(a, b, c, d, p);
}

template <int D> inline int orientation(const Corners<D> &c) {
    if constexpr (D == 2)
        return orientation(*c[0], *c[1], *c[2]);
    else
        return orientation(*c[0], *c[1], *c[2], *c[3]);
}

/// Position of p to a facet of positively oriented corners: +1 on the side of the corner opposite,
/// which is not read, 0 on the facet's line or plane, -1 beyond.
template <int D> inline int facet_side(Corners<D> corners, int facet, const Point<D> &p) {
    corners[facet] = &p;
    return orientation<D>(corners);
}

/// Position of p to the simplex of positively oriented corners: +1 inside, 0 on a facet,
/// -1 outside.
template <int D> inline int in_simplex(const Corners<D> &corners, const Point<D> &p) {
    int position = 1;
    for (int i = 0; i <= D && position >= 0; ++i)
        position = std::min(position, facet_side<D>(corners, i, p));
    return position;
}

/// Whether p is affinely independent of the first n points, which are.
inline bool is_independent(const Corners<2> &points, int n, const Point<2> &p) {
    if (n == 0) return true;
    if (n == 1) return !(*points[0] == p);
    return orientation(*points[0], *points[1], p) != 0;
}
inline bool is_independent(const Corners<3> &points, int n, const Point<3> &p) {
    if (n == 0) return true;
    if (n == 1) return !(*points[0] == p);
    if (n == 3) return orientation(*points[0], *points[1], *points[2], p) != 0;
    // Collinear in space: in each of the three projections.
    const Point<3> &a = *points[0], &b = *points[1];
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        if (orientation({a[i], a[j]}, {b[i], b[j]}, {p[i], p[j]}) != 0) return true;
    }
    return false;
}

/// Position of p to the circumsphere of positively oriented corners: +1 inside,
/// -1 outside, points on the sphere perturbed to one or the other; 0 if and only
/// if p equals a corner.
inline int in_sphere(const Corners<2> &corners, const Point<2> &p) {
    const SeenPoint<2> a = seen(*corners[1], p), b = seen(*corners[0], p), c = seen(*corners[2], p);
    const InCircle test = in_circle(a, b, cross(a, b), c);
    if (test.is_sure) [[likely]]
        return test.is_inside ? 1 : -1;
    return exact::in_sphere<2>(corners, p);
}

inline int in_sphere(const Corners<3> &corners, const Point<3> &p) {
    const SeenPoint<3> s = seen(*corners[1], p), t = seen(*corners[0], p), u = seen(*corners[2], p);
    const LiftedPlane facet = lifted_plane(s, t, u, cross(s, t), cross(s, u), cross(t, u), 1);
    const InSphere test = in_sphere(facet, seen(*corners[3], p));
    if (test.is_sure) [[likely]]
        return test.is_inside ? 1 : -1;
    return exact::in_sphere<3>(corners, p);
}

/// For p on the line of the hull edge corners[0], corners[1] (corners[2] is not
/// read): +1 strictly between its ends, -1 outside, 0 at an end. The edge's ghost
/// has p in its half-space exactly when this is +1.
inline int in_hull_facet(const Corners<2> &corners, const Point<2> &p) {
    const Point<2> &a = *corners[0], &b = *corners[1];
    if (p == a || p == b) return 0;
    return lexicographically_less<2>(a, p) == lexicographically_less<2>(p, b) ? 1 : -1;
}

/// The same for p on the plane of the hull facet corners[0..2]: its place to the
/// facet's circumcircle in that plane, perturbed.
inline int in_hull_facet(const Corners<3> &corners, const Point<3> &p) {
    return exact::in_hull_facet(corners, p);
}

} // namespace abacus
