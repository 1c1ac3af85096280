// To which side of a facet a fixed direction leads. Exact.
//
// The direction is (1, e, e^2) with an infinitesimal e: parallel to no line and no plane that
// points with coordinates determine. So from a vertex it leads into the inside of exactly one of
// the simplices around it, or into none, at a boundary; and so it does from an edge.
//
// Where it leads from a plane its normal tells: the sign is that of the normal's first coordinate
// that is not zero, and that of a triangle's normal is the orientation of its picture where one
// axis is left out.
#pragma once

#include "geometry/facet_order.hpp"
#include "geometry/predicates.hpp"

namespace abacus {

/// Whether it leads from a facet of positively oriented corners to the side of the corner opposite,
/// which is not read.
inline bool leads_inside(const Corners<2> &corners, int facet) {
    const Point<2> &a = *corners[(facet + 1) % 3], &b = *corners[(facet + 2) % 3];
    return a[1] != b[1] ? b[1] < a[1] : a[0] < b[0];
}

inline bool leads_inside(const Corners<3> &corners, int facet) {
    const auto &[i, j, k] = facet_order<3>[facet];
    const Point<3> &a = *corners[i], &b = *corners[j], &c = *corners[k];
    for (int axis = 0; axis < 3; ++axis) {
        const auto flat = [axis](const Point<3> &p) {
            return Point<2>{p[(axis + 1) % 3], p[(axis + 2) % 3]};
        };
        if (const int sign = orientation(flat(a), flat(b), flat(c))) return sign > 0;
    }
    return false; // no facet of a simplex
}

/// Whether it leads from a face into the simplex. Bit i of `face` stands for corner i.
template <int D> bool leads_into(const Corners<D> &corners, unsigned face) {
    for (int facet = 0; facet <= D; ++facet)
        if ((face >> facet & 1) == 0 && !leads_inside(corners, facet)) return false;
    return true;
}

} // namespace abacus
