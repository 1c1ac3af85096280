// A piece of a triangle cut at the border of a trapezoid of a polygon, in floating-point arithmetic
// as pieces are.
#pragma once

#include "geometry/piece.hpp"
#include "geometry/polygon.hpp"

namespace abacus {

/// Calls visit(piece) for the parts of a piece in a trapezoid. `origin`: from where the piece is
/// seen.
template <class Visit>
void clip_trapezoid(const Piece<2> &piece, const Polygon::Trapezoid &part, const Point<2> &origin,
                    Visit &&visit) {
    const auto clip_edge = [&origin](const Piece<2> &whole, const Point<2> *const(&edge)[2],
                                     double sign, auto &&next) {
        const double ax = (*edge[0])[0] - origin[0], ay = (*edge[0])[1] - origin[1];
        // Half the edge, times a power of two: neither it nor products with it overflow.
        const double hx = (*edge[1])[0] / 2 - (*edge[0])[0] / 2,
                     hy = (*edge[1])[1] / 2 - (*edge[0])[1] / 2;
        const double size = std::fmax(std::fabs(hx), std::fabs(hy));
        const int exponent = size > 0 ? std::ilogb(size) : 0;
        const double ux = std::scalbn(hx, -exponent), uy = std::scalbn(hy, -exponent);
        Sides<2> side;
        for (int i = 0; i < 3; ++i)
            side[i] = sign * (ux * (whole.corner[i][1] - ay) - uy * (whole.corner[i][0] - ax));
        clip<2>(whole, side, next);
    };
    clip_axis<2>(piece, 0, part.left - origin[0], true, [&](const Piece<2> &right) {
        clip_axis<2>(right, 0, part.right - origin[0], false, [&](const Piece<2> &between) {
            clip_edge(between, part.lower, 1,
                      [&](const Piece<2> &above) { clip_edge(above, part.upper, -1, visit); });
        });
    });
}

} // namespace abacus
