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
#include "geometry/scaled_number.hpp"

#include <array>
#include <cmath>
#include <tuple>

namespace abacus {

template <int D> using Sides = std::array<double, D + 1>;

template <class Number>
Number determinant(const std::array<Number, 2> &a, const std::array<Number, 2> &b) {
    return a[0] * b[1] - a[1] * b[0];
}
template <class Number>
Number determinant(const std::array<Number, 3> &a, const std::array<Number, 3> &b,
                   const std::array<Number, 3> &c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// Whether doubles hold the determinant: no product overflows, or loses digits that count.
inline bool is_in_range(const Point<2> &a, const Point<2> &b) {
    const double permanent = std::fabs(a[0] * b[1]) + std::fabs(a[1] * b[0]);
    return permanent > 1e-290 && std::isfinite(permanent);
}
inline bool is_in_range(const Point<3> &a, const Point<3> &b, const Point<3> &c) {
    double permanent = 0, size = 0;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        permanent += std::fabs(a[i]) * (std::fabs(b[j] * c[k]) + std::fabs(b[k] * c[j]));
        size += std::fabs(a[i]);
    }
    return permanent > 1e-250 && permanent > 1e-290 * size && std::isfinite(permanent);
}

/// The edges from the first corner, by minus(a, b).
template <int D, class Minus> auto edges_of(const Piece<D> &piece, Minus minus) {
    std::array<std::array<decltype(minus(0.0, 0.0)), D>, D> edges;
    for (int i = 0; i < D; ++i)
        for (int axis = 0; axis < D; ++axis)
            edges[i][axis] = minus(piece.corner[i + 1][axis], piece.corner[0][axis]);
    return edges;
}

/// Area, or volume, of any size.
template <int D> ScaledNumber scaled_measure(const Piece<D> &piece) {
    constexpr double factorial = D == 2 ? 2 : 6;
    const auto edges = edges_of<D>(piece, [](double a, double b) { return a - b; });
    if (std::apply([](const auto &...edge) { return is_in_range(edge...); }, edges)) [[likely]] {
        const double value =
            std::apply([](const auto &...edge) { return determinant<double>(edge...); }, edges);
        return {std::fabs(value) / factorial, 0};
    }
    const ScaledNumber number =
        std::apply([](const auto &...edge) { return determinant<ScaledNumber>(edge...); },
                   edges_of<D>(piece, scaled_difference));
    return {std::fabs(number.value) / factorial, number.exponent};
}

/// Area, or volume.
template <int D> double measure(const Piece<D> &piece) { return rounded(scaled_measure(piece)); }

/// Mean of its values.
template <int D> double mean(const Piece<D> &piece) {
    double sum = 0;
    for (const double value : piece.value) sum += value;
    if (std::isfinite(sum)) [[likely]]
        return sum / (D + 1);
    sum = 0;
    for (const double value : piece.value) sum += value / (D + 1);
    return sum;
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
        const double whole = side[a] - side[b];
        const double share =
            std::isfinite(whole) ? side[a] / whole : side[a] / 2 / (side[a] / 2 - side[b] / 2);
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

/// Area of the triangle between three points in space, of any size.
inline ScaledNumber triangle_area(const Point<3> &a, const Point<3> &b, const Point<3> &c) {
    const auto normal = [&](auto minus) {
        const auto ux = minus(b[0], a[0]), uy = minus(b[1], a[1]), uz = minus(b[2], a[2]);
        const auto wx = minus(c[0], a[0]), wy = minus(c[1], a[1]), wz = minus(c[2], a[2]);
        return std::array{uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx};
    };
    const auto [x, y, z] = normal([](double p, double q) { return p - q; });
    const double square = x * x + y * y + z * z;
    if (square > 1e-250 && std::isfinite(square)) [[likely]]
        return {std::sqrt(square) / 2, 0};
    ScaledNumber area =
        std::apply([](auto... parts) { return length(parts...); }, normal(scaled_difference));
    --area.exponent;
    return area;
}

/// Area of the section of a tetrahedron where a linear function is 0. A facet all in the section
/// is one of the tetrahedron on whose other side the function is negative.
inline ScaledNumber section_area(const Piece<3> &piece, const Sides<3> &side) {
    const Split<3> split(piece, side);
    if (split.count == 0 || split.count == 4) return {0, 0};
    Piece<3> cut; // its corners in order
    const int left = 4 - split.count;
    for (int n = 0; n < split.count * left; ++n) {
        const int i = n / left, j = n % left;
        split.pierce(i, i == 1 && left == 2 ? 1 - j : j, cut, n);
    }
    const ScaledNumber area = triangle_area(cut.corner[0], cut.corner[1], cut.corner[2]);
    return split.count == 2 ? area + triangle_area(cut.corner[0], cut.corner[2], cut.corner[3])
                            : area;
}

} // namespace abacus
