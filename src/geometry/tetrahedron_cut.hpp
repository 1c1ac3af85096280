// Where a surface cuts a tetrahedron that has some corners below it and all others above: in a
// triangle or a quadrilateral, whose corners lie on the edges from below to above (marching
// tetrahedra; Doi and Koide, 1991).
//
// No corner is on the surface: what is there counts as above, as if the surface lay a little lower.
// So it passes through the facets of the tetrahedron in the same way as its neighbours see it, it
// never branches, and it ends only where the mesh does.
#pragma once

#include "geometry/point.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace abacus {

/// The cut of a tetrahedron of positive orientation. Its corners turn to the left as seen from
/// below: the normal points downwards. Of two that follow one another the edges share a vertex.
struct TetrahedronCut {
    struct Edge {
        std::uint8_t below, above; // corners of the tetrahedron
    };
    int corners = 0; // 0, 3 or 4
    std::array<Edge, 4> edge{};
};

/// Bit i of `above` stands for corner i.
constexpr TetrahedronCut cut_with(unsigned above) {
    // Corners in an even order, those below first.
    std::array<std::uint8_t, 4> order{};
    int below = 0;
    for (std::uint8_t i = 0; i < 4; ++i)
        if ((above >> i & 1) == 0) order[below++] = i;
    int n = below;
    for (std::uint8_t i = 0; i < 4; ++i)
        if ((above >> i & 1) != 0) order[n++] = i;
    int inversions = 0;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < i; ++j) inversions += order[j] > order[i];
    if (inversions % 2 != 0) {
        // Two of one side change places.
        if (below >= 2)
            std::swap(order[0], order[1]);
        else
            std::swap(order[2], order[3]);
    }
    const auto [a, b, c, d] = order;
    switch (below) {
    case 1: // from d to b: to the left as seen from a
        return {3, {{{a, d}, {a, c}, {a, b}, {}}}};
    case 2:
        return {4, {{{a, c}, {b, c}, {b, d}, {a, d}}}};
    case 3:
        return {3, {{{a, d}, {c, d}, {b, d}, {}}}};
    default:
        return {};
    }
}

inline constexpr auto tetrahedron_cuts = [] {
    std::array<TetrahedronCut, 16> cuts;
    for (unsigned above = 0; above < 16; ++above) cuts[above] = cut_with(above);
    return cuts;
}();

/// The share of the way from one number to another at which a third is met. It lies between them:
/// where it is one of them, the share is exactly 0 or 1.
inline double share_at(double number, double from, double to) {
    const double way = to - from;
    if (std::isfinite(way)) [[likely]]
        return (number - from) / way;
    return (number * 0.5 - from * 0.5) / (to * 0.5 - from * 0.5);
}

/// The point at a share of the way; the ends are exact. No coordinate is -0.
inline Point<3> point_between(const Point<3> &from, const Point<3> &to, double share) {
    Point<3> p;
    for (int i = 0; i < 3; ++i) p[i] = std::lerp(from[i], to[i], share) + 0.0;
    return p;
}

/// A value there; of an end that has no part in it the value does not count. NaN where another has
/// none, which std::lerp() may pass over.
inline double value_between(double from, double to, double share) {
    if (share == 0) return from;
    if (share == 1) return to;
    return std::isnan(from) ? from : std::lerp(from, to, share);
}

} // namespace abacus
