// Pieces of simplices: what a line or a plane leaves of one, again as simplices.
//
// A linear function is given by its values at the corners, here called sides. Where it is not
// negative is a simplex, if one corner has it so, else a prism or all. A prism between the
// corners a0, a1 (, a2) and b0, b1 (, b2) is cut by its diagonals: each simplex has the a's up to
// some number, and the b's from there on. New corners are found on the edges from a corner with a
// side to one without, in this order: so the simplices on both sides of a facet get the same.
//
// This is floating-point arithmetic. Coordinates should be small, so seen from a corner: then
// errors are those of lengths within the simplex, not of where it lies.
#pragma once

#include "geometry/linear_piece.hpp"

#include <array>
#include <cmath>

namespace abacus {

template <int D> using Sides = std::array<double, D + 1>;

/// Area, or volume.
template <int D> double measure(const Piece<D> &piece) {
    std::array<Point<D>, D> edge;
    for (int i = 0; i < D; ++i)
        for (int axis = 0; axis < D; ++axis)
            edge[i][axis] = piece.corner[i + 1][axis] - piece.corner[0][axis];
    if constexpr (D == 2) {
        return std::fabs(edge[0][0] * edge[1][1] - edge[0][1] * edge[1][0]) / 2;
    } else {
        const auto &[a, b, c] = edge;
        return std::fabs(a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
                         a[2] * (b[0] * c[1] - b[1] * c[0])) /
               6;
    }
}

/// Mean of its values.
template <int D> double mean(const Piece<D> &piece) {
    double sum = 0;
    for (const double value : piece.value) sum += value;
    return sum / (D + 1);
}

/// The corners of a piece by the side of a linear function on which they are.
template <int D> struct Split {
    Split(const Piece<D> &piece, const Sides<D> &side) : piece(piece), side(side) {
        for (int i = 0; i <= D; ++i)
            if (side[i] >= 0)
                kept[count++] = i;
            else
                left[i - count] = i;
    }

    /// Sets corner `to` of a piece to where the function is 0 on the edge from kept[i] to left[j].
    void pierce(int i, int j, Piece<D> &target, int to) const {
        const int a = kept[i], b = left[j];
        const double share = side[a] / (side[a] - side[b]);
        for (int axis = 0; axis < D; ++axis)
            target.corner[to][axis] =
                std::lerp(piece.corner[a][axis], piece.corner[b][axis], share);
        target.value[to] = std::lerp(piece.value[a], piece.value[b], share);
    }
    void keep(int i, Piece<D> &target, int to) const {
        target.corner[to] = piece.corner[kept[i]];
        target.value[to] = piece.value[kept[i]];
    }

    const Piece<D> &piece;
    const Sides<D> &side;
    int count = 0; // of those kept
    std::array<int, D + 1> kept, left;
};

/// Calls visit(piece) for simplices that make up the part where a linear function is not negative.
template <int D, class Visit>
void clip(const Piece<D> &piece, const Sides<D> &side, Visit &&visit) {
    const Split<D> split(piece, side);
    if (split.count == 0) return;
    if (split.count == D + 1) return visit(piece);
    Piece<D> part;
    if (split.count == 1) {
        split.keep(0, part, 0);
        for (int j = 0; j < D; ++j) split.pierce(0, j, part, j + 1);
        return visit(part);
    }
    Piece<D> below, above; // of the prism; their last corners are not used
    for (int i = 0; i < D; ++i) {
        if (split.count == D) {
            split.keep(i, below, i);
            split.pierce(i, 0, above, i);
        } else if (i == 0) { // two corners of four: an edge, and its opposite
            split.keep(0, below, 0);
            split.keep(1, above, 0);
        } else {
            split.pierce(0, i - 1, below, i);
            split.pierce(1, i - 1, above, i);
        }
    }
    for (int last = 0; last < D; ++last) {
        for (int i = 0; i <= D; ++i) {
            const Piece<D> &from = i <= last ? below : above;
            const int at = i <= last ? i : i - 1;
            part.corner[i] = from.corner[at];
            part.value[i] = from.value[at];
        }
        visit(part);
    }
}

/// The part of a piece on one side of a bound on an axis; no corner is beyond it.
template <int D, class Visit>
void clip_axis(const Piece<D> &piece, int axis, double bound, bool is_lower, Visit &&visit) {
    Sides<D> side;
    bool is_all = true;
    for (int i = 0; i <= D; ++i) {
        side[i] = is_lower ? piece.corner[i][axis] - bound : bound - piece.corner[i][axis];
        is_all = is_all && side[i] >= 0;
    }
    if (is_all) return visit(piece);
    clip<D>(piece, side, [&](Piece<D> part) {
        for (Point<D> &corner : part.corner)
            corner[axis] =
                is_lower ? std::fmax(corner[axis], bound) : std::fmin(corner[axis], bound);
        visit(part);
    });
}

/// Area of the triangle between three points in space.
inline double triangle_area(const Point<3> &a, const Point<3> &b, const Point<3> &c) {
    const double ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
    const double wx = c[0] - a[0], wy = c[1] - a[1], wz = c[2] - a[2];
    const double x = uy * wz - uz * wy, y = uz * wx - ux * wz, z = ux * wy - uy * wx;
    return std::sqrt(x * x + y * y + z * z) / 2;
}

/// Area of the section of a tetrahedron where a linear function is 0. A facet all in the section
/// is one of the tetrahedron on whose other side the function is negative.
inline double section_area(const Piece<3> &piece, const Sides<3> &side) {
    const Split<3> split(piece, side);
    if (split.count == 0 || split.count == 4) return 0;
    Piece<3> cut; // its corners in order
    const int left = 4 - split.count;
    for (int n = 0; n < split.count * left; ++n) {
        const int i = n / left, j = n % left;
        split.pierce(i, i == 1 && left == 2 ? 1 - j : j, cut, n);
    }
    const double area = triangle_area(cut.corner[0], cut.corner[1], cut.corner[2]);
    return split.count == 2 ? area + triangle_area(cut.corner[0], cut.corner[2], cut.corner[3])
                            : area;
}

} // namespace abacus
