// A straight line from a place on, and how it passes simplices: through which faces it enters and
// leaves them. Exact.
//
// All follows from one sign. In the plane it tells on which side of the line a point lies; in
// space, how the line passes another one, through two points: det(d, a - o, b - o) for the origin
// o and the direction d. On the facet of a simplex these signs, one for each of its ridges, say
// whether the line meets it. Their values are, but for a factor, the weights of the facet's corners
// in the place where it does: a corner of weight 0 has no part in that place. So the corners with a
// weight span the face in whose inside the place lies: a facet, an edge or a vertex.
//
// The line leaves a simplex through a facet of which all weights are positive or 0, and not all
// are 0; it enters where they are negative or 0. A facet in which the line runs has only zeros, and
// says nothing; the facets beside it tell. If it enters and leaves by the same face it only touches
// the simplex, in a point: places inside of different faces are different.
//
// The determinant is computed in doubles and compared with a bound on its error, as in
// predicates.hpp. The direction is exact, or the rounded difference of two points as everything
// else in the determinant is: so the bounds there hold here. Where they do not decide the sign the
// orientation predicate does, or rational numbers if the line has no second point in doubles.
#pragma once

#include "geometry/predicates.hpp"

#include <optional>

namespace abacus {

template <int D> struct Line {
    /// From one place to another one, which is at the parameter 1 and its end.
    static Line between(const Point<D> &from, const Point<D> &to);
    /// Without an end. The parameter counts the direction.
    static Line towards(const Point<D> &from, const Point<D> &direction);

    /// The parameter of a place on the line, rounded.
    double along(const Point<D> &p) const;

    Point<D> from, direction; // the latter rounded, of a line with an end
    std::optional<Point<D>> to;
    std::optional<Point<D>> second; // a second place on the line
    int axis;                       // on which it is longest
};

/// A value whose sign is exact, and a bound on its error.
struct Estimate {
    double value, error;
};

namespace exact {
/// The signs of line_side().
int line_side(const Line<2> &line, const Point<2> &a);
int line_side(const Line<3> &line, const Point<3> &a, const Point<3> &b);
} // namespace exact

/// Of a value that is not sure, whose sign is now known.
inline Estimate signed_as(int sign, double value, double error) {
    if (sign == 0) return {0, 0};
    constexpr double least = std::numeric_limits<double>::min();
    const double size = sign * value > least ? sign * value : least;
    return {sign * size, error};
}

/// Positive if a is on the left.
inline Estimate line_side(const Line<2> &line, const Point<2> &a) {
    const SignedArea area = signed_area(line.direction, {a[0] - line.from[0], a[1] - line.from[1]});
    if (area.is_sure()) [[likely]]
        return {area.value, area.error};
    return signed_as(exact::line_side(line, a), area.value, area.error);
}

/// Sign of det(d, a - o, b - o).
inline Estimate line_side(const Line<3> &line, const Point<3> &a, const Point<3> &b) {
    const auto &[dx, dy, dz] = line.direction;
    const auto &[ox, oy, oz] = line.from;
    const double ax = a[0] - ox, ay = a[1] - oy, az = a[2] - oz;
    const double bx = b[0] - ox, by = b[1] - oy, bz = b[2] - oz;
    const double yz = ay * bz, zy = az * by, zx = az * bx, xz = ax * bz, xy = ax * by, yx = ay * bx;
    const double value = dx * (yz - zy) + dy * (zx - xz) + dz * (xy - yx);
    const double permanent = std::fabs(dx) * (std::fabs(yz) + std::fabs(zy)) +
                             std::fabs(dy) * (std::fabs(zx) + std::fabs(xz)) +
                             std::fabs(dz) * (std::fabs(xy) + std::fabs(yx));
    const double size = std::fabs(dx) + std::fabs(dy) + std::fabs(dz);
    const bool is_bounded = permanent > 1e-250 && permanent > 1e-290 * size;
    const double error =
        is_bounded ? 7.7716e-16 * permanent : std::numeric_limits<double>::infinity();
    if (std::fabs(value) > error) [[likely]]
        return {value, error};
    return signed_as(exact::line_side(line, a, b), value, error);
}

/// Where a line meets a facet.
template <int D> struct FacetPlace {
    int facet = -1;
    std::array<int, D> corner{};    // of the simplex
    std::array<double, D> weight{}; // none negative, with the sum 1
    double error = 0;               // bound on that of each weight

    /// The corners with a weight, bit by bit.
    unsigned face() const {
        unsigned face = 0;
        for (int i = 0; i < D; ++i) face |= static_cast<unsigned>(weight[i] > 0) << corner[i];
        return face;
    }
};

template <int D> struct Passage { FacetPlace<D> enters, leaves; };

/// How the line, without beginning or end, passes a simplex of positively oriented corners;
/// nothing if they have no more than a point in common.
template <int D> std::optional<Passage<D>> passage(const Line<D> &line, const Corners<D> &corners);

/// Where the line meets a facet of points of which the orientation with the line's origin behind
/// them is positive; false if it does not. `ridge` is then the number of a point across whose
/// opposite ridge the line passes the facet by, the `choice`-th of them.
template <int D>
bool meets_facet(const Line<D> &line, const std::array<const Point<D> *, D> &facet,
                 FacetPlace<D> &place, unsigned choice, int &ridge);

namespace exact {
/// The parameter where the line meets a facet, rounded once.
template <int D> double parameter(const Line<D> &line, const std::array<Point<D>, D> &facet);
/// Of two places where the line meets facets: -1 if it comes to the first one earlier, +1 if later.
template <int D>
int compare_along(const Line<D> &line, const std::array<Point<D>, D> &a,
                  const std::array<Point<D>, D> &b);
} // namespace exact

} // namespace abacus
