// Exact predicates: orientation, and in-sphere under symbolic perturbation.
//
// Each predicate first evaluates the determinant in doubles and compares it with
// a bound on the rounding error; only when that does not decide does it call the
// exact form in predicates.cpp, which is CGAL's filtered kernel. The bounds are
// Shewchuk's ("Adaptive Precision Floating-Point Arithmetic and Fast Robust
// Geometric Predicates", 1997, the A estimates) for the very expressions below;
// the 3D in-sphere bounds the permanent by the largest coordinate differences. They
// hold while nothing underflows or overflows, so magnitudes outside a safe range
// go to the exact form too: within it, what an underflow can change is far below the
// bound.
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

#include "geometry/point.hpp"

#include <algorithm>
#include <cmath>

namespace abacus {

/// The D+1 corners of a simplex, by reference.
template <int D> using Corners = std::array<const Point<D> *, D + 1>;

namespace exact {
int orientation(const Point<2> &a, const Point<2> &b, const Point<2> &c);
int orientation(const Point<3> &a, const Point<3> &b, const Point<3> &c, const Point<3> &d);
/// As in_sphere() below.
template <int D> int in_sphere(const Corners<D> &corners, const Point<D> &p);
/// As in_hull_facet() below.
int in_hull_facet(const Corners<3> &corners, const Point<3> &p);
} // namespace exact

/// +1 if a, b, c are counterclockwise, -1 if clockwise, 0 if collinear.
inline int orientation(const Point<2> &a, const Point<2> &b, const Point<2> &c) {
    const double left = (a[0] - c[0]) * (b[1] - c[1]);
    const double right = (a[1] - c[1]) * (b[0] - c[0]);
    const double det = left - right;
    const double sum = std::fabs(left) + std::fabs(right);
    const double bound = 3.3306690738754716e-16 * sum;
    if (sum > 1e-290) [[likely]] {
        if (det > bound) return 1;
        if (det < -bound) return -1;
    }
    return exact::orientation(a, b, c);
}

/// +1 if det(b-a, c-a, d-a) > 0, -1 if < 0, 0 if coplanar.
inline int orientation(const Point<3> &a, const Point<3> &b, const Point<3> &c,
                       const Point<3> &d) {
    const double ax = a[0] - d[0], ay = a[1] - d[1], az = a[2] - d[2];
    const double bx = b[0] - d[0], by = b[1] - d[1], bz = b[2] - d[2];
    const double cx = c[0] - d[0], cy = c[1] - d[1], cz = c[2] - d[2];
    const double bc = bx * cy, cb = cx * by, ca = cx * ay, ac = ax * cy, ab = ax * by, ba = bx * ay;
    const double det = az * (bc - cb) + bz * (ca - ac) + cz * (ab - ba);
    const double permanent = std::fabs(az) * (std::fabs(bc) + std::fabs(cb)) +
                             std::fabs(bz) * (std::fabs(ca) + std::fabs(ac)) +
                             std::fabs(cz) * (std::fabs(ab) + std::fabs(ba));
    const double bound = 7.7715611723761027e-16 * permanent;
    if (permanent > 1e-250) [[likely]] {
        if (det > bound) return -1;
        if (det < -bound) return 1;
    }
    return exact::orientation(a, b, c, d);
}

template <int D> inline int orientation(const Corners<D> &c) {
    if constexpr (D == 2) return orientation(*c[0], *c[1], *c[2]);
    else return orientation(*c[0], *c[1], *c[2], *c[3]);
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
    const double ax = (*corners[0])[0] - p[0], ay = (*corners[0])[1] - p[1];
    const double bx = (*corners[1])[0] - p[0], by = (*corners[1])[1] - p[1];
    const double cx = (*corners[2])[0] - p[0], cy = (*corners[2])[1] - p[1];
    const double bc = bx * cy, cb = cx * by, ca = cx * ay, ac = ax * cy, ab = ax * by, ba = bx * ay;
    const double a2 = ax * ax + ay * ay, b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
    const double det = a2 * (bc - cb) + b2 * (ca - ac) + c2 * (ab - ba);
    const double permanent = a2 * (std::fabs(bc) + std::fabs(cb)) +
                             b2 * (std::fabs(ca) + std::fabs(ac)) +
                             c2 * (std::fabs(ab) + std::fabs(ba));
    const double bound = 1.1102230246251577e-15 * permanent;
    if (permanent > 1e-250 && a2 + b2 + c2 < 1e50) [[likely]] {
        if (det > bound) return 1;
        if (det < -bound) return -1;
    }
    return exact::in_sphere<2>(corners, p);
}

inline int in_sphere(const Corners<3> &corners, const Point<3> &p) {
    double x[4], y[4], z[4], lift[4];
    double mx = 0, my = 0, mz = 0;
    for (int i = 0; i < 4; ++i) {
        x[i] = (*corners[i])[0] - p[0];
        y[i] = (*corners[i])[1] - p[1];
        z[i] = (*corners[i])[2] - p[2];
        lift[i] = x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
        mx = std::max(mx, std::fabs(x[i]));
        my = std::max(my, std::fabs(y[i]));
        mz = std::max(mz, std::fabs(z[i]));
    }
    const double ab = x[0] * y[1] - x[1] * y[0], bc = x[1] * y[2] - x[2] * y[1];
    const double cd = x[2] * y[3] - x[3] * y[2], da = x[3] * y[0] - x[0] * y[3];
    const double ac = x[0] * y[2] - x[2] * y[0], bd = x[1] * y[3] - x[3] * y[1];
    const double abc = z[0] * bc - z[1] * ac + z[2] * ab;
    const double bcd = z[1] * cd - z[2] * bd + z[3] * bc;
    const double cda = z[2] * da + z[3] * ac + z[0] * cd;
    const double dab = z[3] * ab + z[0] * bd + z[1] * da;
    const double det = (lift[3] * abc - lift[2] * dab) + (lift[1] * cda - lift[0] * bcd);
    // 16 u times the permanent, which is at most 24 mx my mz (mx^2 + my^2 + mz^2).
    const double bound = 4.2632564145606087e-14 * (mx * my * mz) * (mx * mx + my * my + mz * mz);
    if (std::min({mx, my, mz}) > 1e-58 && std::max({mx, my, mz}) < 1e61) [[likely]] {
        if (det > bound) return -1;
        if (det < -bound) return 1;
    }
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
