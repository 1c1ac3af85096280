// The filter of the in-circle test, in parts. A search that goes from triangle to triangle
// has tested the one before, with which the next shares an edge: what the test needs of
// its two corners has been computed. in_sphere() of predicates.hpp puts the parts together
// for a triangle by itself, and says what is done where they are not sure.
#pragma once

#include "geometry/pair.hpp"

#include <cmath>

namespace abacus {

/// A point as seen from the one that is tested.
struct SeenPoint {
    Pair at;     // its difference to that one
    double lift; // the square of its distance
};

inline SeenPoint seen(const Point<2> &point, const Point<2> &from) {
    const Pair at = pair(point) - pair(from), squares = at * at;
    return {at, squares[0] + squares[1]};
}

/// a x b, for two points as seen from a third.
inline double cross(const SeenPoint &a, const SeenPoint &b) {
    const Pair products = a.at * swapped(b.at);
    return products[0] - products[1];
}

/// Of a triangle beyond the edge from a to b, counterclockwise around the point that sees them.
struct InCircle {
    double cross_ac, cross_cb; // c is the corner opposite the edge
    bool is_sure;              // else the exact test has to decide
    bool is_inside;            // the point, in the circle through b, a, c
};

inline InCircle in_circle(const SeenPoint &a, const SeenPoint &b, double cross_ab,
                          const SeenPoint &c) {
    const Pair ac = a.at * swapped(c.at), bc = swapped(b.at) * c.at;
    const Pair minors = firsts(ac, bc) - seconds(ac, bc);
    const Pair terms = Pair{b.lift, a.lift} * minors;
    const double det = terms[0] + terms[1] - c.lift * cross_ab;
    // No less than the permanent, since |ax cy| + |ay cx| <= |a||c| <= (a^2 + c^2) / 2.
    const double permanent = a.lift * b.lift + c.lift * (a.lift + b.lift);
    return {minors[0], minors[1], permanent > 1e-250 && std::fabs(det) > 1.1103e-15 * permanent,
            det > 0};
}

} // namespace abacus
