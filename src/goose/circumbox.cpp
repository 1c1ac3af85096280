#include "goose/circumbox.hpp"

#include "geometry/sphere_box.hpp"
#include "geometry/sphere_intervals.hpp"

#include <algorithm>
#include <cmath>

namespace abacus {

namespace {

using intervals::cross, intervals::Interval, intervals::Vector;

/// Perpendicular to a facet with these edges, into the half-space of its ghost.
Vector<2> normal(const std::array<Vector<2>, 1> &edges) { return {-edges[0][1], edges[0][0]}; }
Vector<3> normal(const std::array<Vector<3>, 2> &edges) { return cross(edges[0], edges[1]); }

/// The edges of a facet from its first corner.
template <int D>
std::array<Vector<D>, D - 1> edges_of(const double (*corner)[ABACUS_MAX_DIMENSION]) {
    std::array<Vector<D>, D - 1> edges;
    for (int i = 0; i < D - 1; ++i)
        for (int k = 0; k < D; ++k) edges[i][k] = Interval(corner[i + 1][k]) - corner[0][k];
    return edges;
}

template <int D> Box<D> around_sphere(const double (*corner)[ABACUS_MAX_DIMENSION]) {
    std::array<Point<D>, D + 1> points;
    std::array<const Point<D> *, D + 1> corners;
    for (int i = 0; i <= D; ++i) {
        std::copy_n(corner[i], D, points[i].begin());
        corners[i] = &points[i];
    }
    return sphere_box<D>(corners);
}

/// The box of the half-space n (p - a) >= 0 within a domain: each axis is bounded by the most that
/// the others can contribute.
template <int D>
Box<D> around_half_space(const double (*corner)[ABACUS_MAX_DIMENSION], Box<D> bounds) {
    const Interval::Protector rounding;
    const Vector<D> n = normal(edges_of<D>(corner));
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
    const Box<D> bounds = row.simplex.ghost
                              ? around_half_space<D>(row.simplex.corner, {lower_, upper_})
                              : around_sphere<D>(row.simplex.corner);
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
