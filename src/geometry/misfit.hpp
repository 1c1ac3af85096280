// How far a point with a value lies from the linear surface over a simplex, decided exactly.
//
// Let N be the determinant of the corners as seen from the point, with their values less that of
// the point as one column more, and V that of the simplex. The surface is then |N| / |V| from the
// value. Over one simplex, V is the same for all points, so that N alone decides which is worst.
//
// All is first computed in doubles with a bound on the rounding error, as in predicates.hpp: N of
// the plane is the determinant of an orientation in space, of Shewchuk's bound (7 + 56ε)ε times the
// permanent. In space there are a product and two sums more on each way, hence less than 14ε. The
// constants are rounded up, far enough for the roundings of what compares with the results. Where
// that does not decide, and where products may underflow, rational numbers do.
#pragma once

#include "geometry/linear_piece.hpp"
#include "geometry/linear_system.hpp"

#include <limits>

namespace abacus {

/// A number that is not negative, and a bound on its rounding error.
struct Magnitude {
    double value, error;

    double least() const { return value - error; }
    double most() const { return value + error; }
};

namespace exact {
/// Sign of |N| - bound · |V|.
template <int D>
int compare_misfit(const Piece<D> &piece, const Point<D> &p, double value, double bound);
/// Sign of the difference of two misfits, over the same simplex or different ones.
template <int D>
int compare_misfits(const Piece<D> &piece, const Point<D> &p, double value,
                    const Piece<D> &other_piece, const Point<D> &other_p, double other_value);
/// |N| / |V|, rounded to the nearest double.
template <int D> double misfit(const Piece<D> &piece, const Point<D> &p, double value);
/// Sign of the difference of how far p and q are from the line or plane of a facet.
template <int D>
int compare_heights(const std::array<Point<D>, D> &facet, const Point<D> &p, const Point<D> &q);
/// The same of the distances from the line through a and b, in space.
int compare_distances(const Point<3> &a, const Point<3> &b, const Point<3> &p, const Point<3> &q);
} // namespace exact

/// A determinant in doubles, and a bound on the error of its absolute value. The bound is infinite
/// where products may underflow or overflow.
template <int D> Magnitude magnitude(double determinant, double permanent) {
    constexpr double unit = D == 2 ? 1.1e-15 : 2.5e-15;
    const bool is_known = permanent > 1e-250 && permanent < 1e290;
    return {std::fabs(determinant),
            is_known ? unit * permanent : std::numeric_limits<double>::infinity()};
}

/// How far p is from the line or plane of a facet, times the facet's length or twice its area.
template <int D> Magnitude height_over(const std::array<Point<D>, D> &facet, const Point<D> &p) {
    using System = LinearSystem<double, D>;
    typename System::Matrix seen;
    for (int i = 0; i < D; ++i)
        for (int axis = 0; axis < D; ++axis) seen[i][axis] = facet[i][axis] - p[axis];
    return magnitude<D>(System::determinant(seen), System::permanent(seen));
}

/// The square of how far p is from the line through a and b, times that of their distance.
inline Magnitude distance_from(const Point<3> &a, const Point<3> &b, const Point<3> &p) {
    double sum = 0, size = 0;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const double left = (b[i] - a[i]) * (p[j] - a[j]), right = (b[j] - a[j]) * (p[i] - a[i]);
        sum += (left - right) * (left - right);
        size += (std::fabs(left) + std::fabs(right)) * (std::fabs(left) + std::fabs(right));
    }
    return magnitude<3>(sum, size);
}

/// The misfits of points over one simplex.
template <int D> class Misfit {
public:
    explicit Misfit(const Piece<D> &piece) : piece_(piece) {
        Matrix edges;
        for (int i = 0; i < D; ++i)
            for (int axis = 0; axis < D; ++axis)
                edges[i][axis] = piece.corner[i + 1][axis] - piece.corner[0][axis];
        volume_ = magnitude<D>(System::determinant(edges), System::permanent(edges));
    }

    /// |N| of a point.
    Magnitude of(const Point<D> &p, double value) const {
        std::array<Point<D>, D + 1> seen;
        for (int i = 0; i <= D; ++i)
            for (int axis = 0; axis < D; ++axis) seen[i][axis] = piece_.corner[i][axis] - p[axis];
        double sum = 0, size = 0;
        for (int i = 0; i <= D; ++i) {
            const double height = piece_.value[i] - value;
            Matrix others;
            for (int row = 0; row < D; ++row) others[row] = seen[row + (row >= i)];
            const double term = height * System::determinant(others);
            sum += i % 2 == 0 ? term : -term;
            size += std::fabs(height) * System::permanent(others);
        }
        return magnitude<D>(sum, size);
    }

    /// Whether the point is farther from the surface than `bound`; `of` is of().
    bool exceeds(const Point<D> &p, double value, const Magnitude &of, double bound) const {
        if (is_level_with(value)) return false;
        constexpr double rounding = 1e-15;
        const double most = bound * volume_.most() * (1 + rounding);
        const double least = bound * volume_.least() * (1 - rounding);
        if (bound == 0 || most > 1e-280) {
            if (of.least() > most) return true;
            if (of.most() < least) return false;
        }
        return exact::compare_misfit<D>(piece_, p, value, bound) > 0;
    }

    /// Whether |N| / |V| may be more than `known`: false only if it is not.
    bool may_exceed(double value, const Magnitude &of, double known) const {
        constexpr double rounding = 1e-15;
        const double least = known * volume_.least() * (1 - rounding);
        return !is_level_with(value) && !(least > 1e-280 && of.most() < least);
    }

    /// |N| / |V| is at most this; infinite where that is not known.
    double most(const Magnitude &of) const {
        constexpr double rounding = 1e-15;
        const double most = of.most() / volume_.least() * (1 + rounding);
        return volume_.least() > 1e-280 && most >= 0 ? most
                                                     : std::numeric_limits<double>::infinity();
    }

private:
    using System = LinearSystem<double, D>;
    using Matrix = typename System::Matrix;

    bool is_level_with(double value) const {
        for (const double corner : piece_.value)
            if (corner != value) return false;
        return true;
    }

    const Piece<D> piece_;
    Magnitude volume_;
};

} // namespace abacus
