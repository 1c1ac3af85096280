// The plane section of a tetrahedron, and of a mesh of them without gap or overlap.
//
// A plane in general position cuts a tetrahedron in a triangle or a quadrilateral. But
// planes mostly cut grids and octrees through their points. The sections still tile the
// plane if a vertex on the plane counts as one just above it. Corners that coincide
// then make a section smaller, down to an edge or a point, which is no patch. Of two
// tetrahedra that share a face in the plane, the lower one has it as its section, the
// upper one none. Only a face in the plane at the bottom of the hull has nothing below:
// it is the section of its ghost.
#pragma once

#include "draw/frame.hpp"
#include "draw/plane.hpp"

#include <cmath>

namespace abacus {

/// A corner of a tetrahedron: its place, and its value if it has one.
struct Cut {
    Place place;
    double value;
};

/// A value on the way from one to another; none if one of them is missing.
inline double between(double a, double b, double share) {
    return std::isnan(a) || std::isnan(b) ? NAN : std::lerp(a, b, share);
}

/// The section of a tetrahedron; false if it has none. Leaves the spacing alone.
inline bool cut_tetrahedron(const Cut (&corner)[4], Patch &patch) {
    const Cut *below[4], *above[4], *on[4];
    int low = 0, high = 0, level = 0;
    for (const Cut &c : corner) {
        if (c.place.side < 0)
            below[low++] = &c;
        else if (c.place.side > 0)
            above[high++] = &c;
        else
            on[level++] = &c;
    }
    patch.corners = level + low * high;
    if (low == 0 || patch.corners < 3) return false;

    int n = 0;
    const auto add = [&](const Cut &c) {
        patch.corner[n][0] = c.place.at[0];
        patch.corner[n][1] = c.place.at[1];
        patch.value[n++] = c.value;
    };
    const auto pierce = [&](const Cut &a, const Cut &b) {
        const double share = pierced(a.place, b.place);
        add({{{std::lerp(a.place.at[0], b.place.at[0], share),
               std::lerp(a.place.at[1], b.place.at[1], share)},
              0,
              0},
             between(a.value, b.value, share)});
    };
    for (int i = 0; i < level; ++i) add(*on[i]);
    // Of the four edges of a quadrilateral, those that follow one another share a vertex.
    for (int i = 0; i < low; ++i)
        for (int j = 0; j < high; ++j) pierce(*below[i], *above[i % 2 == 0 ? j : high - 1 - j]);
    return true;
}

/// The section of a ghost, by the corners of its facet, which turn to the left as seen
/// from outside: the facet, if it lies in the plane and faces downwards.
inline bool cut_ghost(const Cut (&corner)[3], Patch &patch) {
    for (int i = 0; i < 3; ++i) {
        if (corner[i].place.side != 0) return false;
        patch.corner[i][0] = corner[i].place.at[0];
        patch.corner[i][1] = corner[i].place.at[1];
        patch.value[i] = corner[i].value;
    }
    patch.corners = 3;
    return patch.turn(0, 1, 2) < 0;
}

} // namespace abacus
