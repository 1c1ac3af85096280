// Segments in the plane that cross: they have exactly one point in common, which is an end of
// neither. Exact.
#pragma once

#include "geometry/predicates.hpp"

namespace abacus {

/// Whether the segments from a to b and from c to d cross. Those that share an end, or touch in
/// one, or overlap along a stretch do not; nor does a segment of length 0.
inline bool cross(const Point<2> &a, const Point<2> &b, const Point<2> &c, const Point<2> &d) {
    if (a == c || a == d || b == c || b == d) return false; // most neighbours on a line
    return orientation(a, b, c) * orientation(a, b, d) < 0 &&
           orientation(c, d, a) * orientation(c, d, b) < 0;
}

struct CrossingPlace {
    Point<2> place; // each coordinate rounded once
    bool is_exact;  // whether nothing was rounded
};
/// Where two segments cross that do.
CrossingPlace crossing_place(const Point<2> &a, const Point<2> &b, const Point<2> &c,
                             const Point<2> &d);

} // namespace abacus
