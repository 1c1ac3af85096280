// Whether a simplex is flat in doubles: so flat that its volume is lost in rounding.
#pragma once

#include "geometry/linear_system.hpp"
#include "geometry/predicates.hpp"

#include <algorithm>
#include <cmath>

namespace abacus {

/// Whether the volume, as computed in doubles from the corners in lexicographic order, is not
/// greater than the bound on its error, which is that of predicates.hpp. The order makes this a
/// property of the points. Where products would underflow or overflow, each axis is first scaled by
/// a power of two: so it is one of the simplex's shape.
template <int D> bool is_flat_in_doubles(Corners<D> corners) {
    std::sort(corners.begin(), corners.end(), [](const Point<D> *a, const Point<D> *b) {
        return lexicographically_less<D>(*a, *b);
    });
    using System = LinearSystem<double, D>;
    const auto is_within = [](double permanent, double volume) {
        constexpr double factor = D == 2 ? 3.3307e-16 : 7.7716e-16;
        return !(std::fabs(volume) > factor * permanent);
    };
    typename System::Matrix edges;
    for (int i = 0; i < D; ++i)
        for (int axis = 0; axis < D; ++axis)
            edges[i][axis] = (*corners[i + 1])[axis] - (*corners[0])[axis];
    const double permanent = System::permanent(edges);
    if (permanent > 1e-250 && permanent < 1e250) [[likely]]
        return is_within(permanent, System::determinant(edges));
    for (int axis = 0; axis < D; ++axis) {
        double extent = 0;
        for (int i = 0; i < D; ++i) extent = std::max(extent, std::fabs(edges[i][axis]));
        const double part = std::isfinite(extent) ? 1 : 0.25; // differences that overflow
        extent = 0;
        for (int i = 0; i < D; ++i) {
            edges[i][axis] = (*corners[i + 1])[axis] * part - (*corners[0])[axis] * part;
            extent = std::max(extent, std::fabs(edges[i][axis]));
        }
        const int exponent = extent == 0 ? 0 : -std::ilogb(extent);
        for (int i = 0; i < D; ++i) edges[i][axis] = std::scalbn(edges[i][axis], exponent);
    }
    return is_within(System::permanent(edges), System::determinant(edges));
}

} // namespace abacus
