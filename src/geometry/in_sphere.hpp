// The filter of the in-sphere test, in parts. A search that goes from simplex to simplex
// has already tested the simplex that shares a facet with the next one. So what the test
// needs of the facet's corners is already computed. in_sphere() of predicates.hpp puts
// the parts together for a single simplex, and says what is done where they are not
// sure.
//
// In the plane the parts are those of an edge: its ends and their cross product.
//
// In space, seen from the point that is tested, the determinant for corners s, t, u and e
// is |e|^2 [s t u] - e . n, with [s t u] the triple product and n = |s|^2 t x u + |t|^2 u
// x s + |u|^2 s x t. So three cross products tell all about a facet. For the next
// facet two of them are new, in other words three for each simplex that is entered.
#pragma once

#include "geometry/pair.hpp"

#include <cmath>

namespace abacus {

/// A point as seen from the one that is tested.
template <int D> struct SeenPoint;

// ---- The plane -----------------------------------------------------------------------

template <> struct SeenPoint<2> {
    Pair at;     // its difference to that one
    double lift; // the square of its distance
};

inline SeenPoint<2> seen(const Point<2> &point, const Point<2> &from) {
    const Pair at = pair(point) - pair(from), squares = at * at;
    return {at, squares[0] + squares[1]};
}

/// a x b, for two points as seen from a third.
inline double cross(const SeenPoint<2> &a, const SeenPoint<2> &b) {
    const Pair products = a.at * swapped(b.at);
    return products[0] - products[1];
}

/// Of a triangle beyond the edge from a to b, counterclockwise around the point that sees them.
struct InCircle {
    double cross_ac, cross_cb; // c is the corner opposite the edge
    bool is_sure;              // else the exact test has to decide
    bool is_inside;            // the point, in the circle through b, a, c
};

inline InCircle in_circle(const SeenPoint<2> &a, const SeenPoint<2> &b, double cross_ab,
                          const SeenPoint<2> &c) {
    const Pair ac = a.at * swapped(c.at), bc = swapped(b.at) * c.at;
    const Pair minors = firsts(ac, bc) - seconds(ac, bc);
    const Pair terms = Pair{b.lift, a.lift} * minors;
    const double det = terms[0] + terms[1] - c.lift * cross_ab;
    // No less than the permanent, since |ax cy| + |ay cx| <= |a||c| <= (a^2 + c^2) / 2.
    const double ends = a.lift + b.lift, permanent = a.lift * b.lift + c.lift * ends;
    // An underflow of a minor is multiplied by a lift.
    const bool is_sure = (permanent > 1e-250) & (permanent > 1e-250 * (ends + c.lift)) &
                         (std::fabs(det) > 1.1103e-15 * permanent);
    return {minors[0], minors[1], is_sure, det > 0};
}

// ---- Space ---------------------------------------------------------------------------

template <> struct SeenPoint<3> {
    Pair xy;     // its difference to that one
    Pair z_lift; // the lift is the square of its distance

    double z() const { return z_lift[0]; }
    double lift() const { return z_lift[1]; }
};

inline SeenPoint<3> seen(const Point<3> &point, const Point<3> &from) {
    const Pair xy = pair(point[0], point[1]) - pair(from[0], from[1]), squares = xy * xy;
    const double z = point[2] - from[2];
    return {xy, Pair{z, squares[0] + squares[1] + z * z}};
}

/// A cross product, the second component negated: so the first two are one difference.
struct Cross {
    Pair x_minus_y;
    double z;
};

inline Cross cross(const SeenPoint<3> &a, const SeenPoint<3> &b) {
    const Pair a_yx = swapped(a.xy), b_yx = swapped(b.xy), z = a.xy * b_yx;
    return {a_yx * pair(b.z(), b.z()) - pair(a.z(), a.z()) * b_yx, z[0] - z[1]};
}

/// What a facet says of the spheres through its corners.
struct LiftedPlane {
    Cross normal;  // n
    double volume; // [s t u]
    double lifts;  // their sum
};

/// Of a facet whose corners s, t, u are seen counterclockwise from the simplex before it. With
/// a sign of -1 the first cross product is that of t and s.
inline LiftedPlane lifted_plane(const SeenPoint<3> &s, const SeenPoint<3> &t, const SeenPoint<3> &u,
                                const Cross &st, const Cross &su, const Cross &tu, double sign) {
    const double lift = sign * u.lift();
    const Pair xy = u.xy * st.x_minus_y;
    return {{pair(lift, lift) * st.x_minus_y + pair(s.lift(), s.lift()) * tu.x_minus_y -
                 pair(t.lift(), t.lift()) * su.x_minus_y,
             lift * st.z + s.lift() * tu.z - t.lift() * su.z},
            sign * (xy[0] - xy[1] + u.z() * st.z),
            s.lift() + t.lift() + u.lift()};
}

struct InSphere {
    bool is_sure;   // else the exact test has to decide
    bool is_inside; // the point, in the sphere through the facet and the apex
};

/// Of the simplex behind the facet, with this apex.
inline InSphere in_sphere(const LiftedPlane &facet, const SeenPoint<3> &apex) {
    const Pair xy = apex.xy * facet.normal.x_minus_y;
    const double det = apex.lift() * facet.volume - (xy[0] - xy[1] + apex.z() * facet.normal.z);
    // The permanent of a 3x3 matrix is at most 2/sqrt(3) times the product of its rows'
    // lengths (Carlen, Lieb, Loss, "An inequality of Hadamard type for permanents",
    // 2006); so the whole is, for four corners whose lifts have this sum, at most
    // 1/(4 sqrt(3)) < 0.1444 times its power of 5/2. Each of its terms is rounded 17 times
    // on its way to the determinant. Squares are compared, which needs no root. An underflow
    // takes the least double, times the cube of the greatest length at most if that is more:
    // nothing beside the fifth power of a length above 1e-26.
    const double sum = facet.lifts + apex.lift();
    const double square = sum * sum, power = square * square * sum;
    const bool is_sure = (power > 1e-250) & (det * det > 7.46e-32 * power); // no branch
    return {is_sure, det > 0};
}

} // namespace abacus
