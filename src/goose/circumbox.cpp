#include "goose/circumbox.hpp"

#include <CGAL/Interval_nt.h>

#include <algorithm>
#include <cmath>

namespace abacus {

namespace {

using Interval = CGAL::Interval_nt<false>; // between a Protector's two ends
template <int D> using Vector = std::array<Interval, D>;

Interval determinant(const Interval &a, const Interval &b, const Interval &c, const Interval &d) {
    return a * d - b * c;
}
Vector<3> cross(const Vector<3> &a, const Vector<3> &b) {
    return {determinant(a[1], a[2], b[1], b[2]), determinant(a[2], a[0], b[2], b[0]),
            determinant(a[0], a[1], b[0], b[1])};
}
template <int D> Interval squared(const Vector<D> &v) {
    Interval sum = square(v[0]);
    for (int k = 1; k < D; ++k) sum += square(v[k]);
    return sum;
}

/// From the corner where a simplex's edges start to the centre of its circumsphere: formulas 2.1
/// and 2.2 of the dissertation, and the same in space.
Vector<2> to_centre(const std::array<Vector<2>, 2> &edges) {
    const auto &[b, c] = edges;
    const Interval bb = squared<2>(b), cc = squared<2>(c);
    const Interval twice = 2 * determinant(b[0], b[1], c[0], c[1]);
    return {determinant(bb, b[1], cc, c[1]) / twice, determinant(b[0], bb, c[0], cc) / twice};
}
Vector<3> to_centre(const std::array<Vector<3>, 3> &edges) {
    const auto &[b, c, d] = edges;
    const Vector<3> cd = cross(c, d), db = cross(d, b), bc = cross(b, c);
    const Interval bb = squared<3>(b), cc = squared<3>(c), dd = squared<3>(d);
    const Interval twice = 2 * (b[0] * cd[0] + b[1] * cd[1] + b[2] * cd[2]);
    Vector<3> centre;
    for (int k = 0; k < 3; ++k) centre[k] = (bb * cd[k] + cc * db[k] + dd * bc[k]) / twice;
    return centre;
}

/// Perpendicular to a facet with these edges, into the half-space of its ghost.
Vector<2> normal(const std::array<Vector<2>, 1> &edges) { return {-edges[0][1], edges[0][0]}; }
Vector<3> normal(const std::array<Vector<3>, 2> &edges) { return cross(edges[0], edges[1]); }

template <int D> struct Bounds { Point<D> lower, upper; };

/// The N edges from the first corner of a simplex.
template <int D, std::size_t N>
std::array<Vector<D>, N> edges_of(const double (*corner)[ABACUS_MAX_DIMENSION]) {
    std::array<Vector<D>, N> edges;
    for (std::size_t i = 0; i < N; ++i)
        for (int k = 0; k < D; ++k) edges[i][k] = Interval(corner[i + 1][k]) - corner[0][k];
    return edges;
}

template <int D> Bounds<D> around_sphere(const double (*corner)[ABACUS_MAX_DIMENSION]) {
    const Vector<D> centre = to_centre(edges_of<D, D>(corner));
    const Interval radius = sqrt(squared<D>(centre));
    Bounds<D> bounds;
    for (int k = 0; k < D; ++k) {
        const Interval at = centre[k] + corner[0][k];
        bounds.lower[k] = (at - radius).inf();
        bounds.upper[k] = (at + radius).sup();
    }
    return bounds;
}

/// The box of the half-space n (p - a) >= 0 within a domain: each axis is bounded by the most that
/// the others can contribute.
template <int D>
Bounds<D> around_half_space(const double (*corner)[ABACUS_MAX_DIMENSION], Bounds<D> bounds) {
    const Vector<D> n = normal(edges_of<D, D - 1>(corner));
    Vector<D> share; // n (p - a) of each axis, anywhere in the domain
    for (int k = 0; k < D; ++k)
        share[k] = n[k] * (Interval(bounds.lower[k], bounds.upper[k]) - corner[0][k]);
    for (int k = 0; k < D; ++k) {
        Interval others = 0;
        for (int j = 0; j < D; ++j)
            if (j != k) others += share[j];
        if (!std::isfinite(others.sup())) continue;
        const Interval end = Interval(-others.sup()) / n[k] + corner[0][k];
        if (n[k].inf() > 0) bounds.lower[k] = end.inf();
        if (n[k].sup() < 0) bounds.upper[k] = end.sup();
    }
    return bounds;
}

/// Coordinates nearer to 0 move to 0 or to this value, so that no area underflows.
constexpr double least_coordinate = 0x1p-100;

double lower_end(double x, double unit) {
    const double scaled = x * unit;
    if (std::fabs(scaled) >= least_coordinate) return scaled;
    return x < 0 ? -least_coordinate : 0;
}

} // namespace

template <int D> Circumboxes<D>::Circumboxes(const abacus_facts &facts) {
    double half = 0; // of the widest side, which itself may overflow
    for (int k = 0; k < D; ++k) {
        lower_[k] = facts.form.lower[k];
        upper_[k] = facts.form.upper[k];
        half = std::max(half, upper_[k] / 2 - lower_[k] / 2);
    }
    constexpr int smallest = -4, largest = 300, between = 40;
    const int exponent = half > 0 ? std::ilogb(half) + 1 : 0;
    const bool fits = exponent >= smallest && exponent <= largest;
    unit_ = fits ? 1 : std::ldexp(1.0, std::min(between - exponent, 1000));
}

template <int D> void Circumboxes<D>::enclose(abacus_boxed_simplex &row) const {
    Bounds<D> bounds;
    {
        const Interval::Protector rounding;
        bounds = row.simplex.ghost ? around_half_space<D>(row.simplex.corner, {lower_, upper_})
                                   : around_sphere<D>(row.simplex.corner);
    }
    // These comparisons are false for a NaN, which an infinite interval may lead to: then it is no
    // bound.
    for (int k = 0; k < D; ++k) {
        const double lower = bounds.lower[k] > lower_[k] ? bounds.lower[k] : lower_[k];
        const double upper = bounds.upper[k] < upper_[k] ? bounds.upper[k] : upper_[k];
        row.lower[k] = lower_end(lower, unit_);
        row.upper[k] = 0 - lower_end(-upper, unit_);
    }
}

template class Circumboxes<2>;
template class Circumboxes<3>;

} // namespace abacus
