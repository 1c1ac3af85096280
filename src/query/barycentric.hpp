// Where a place lies in a simplex: the weights of its corners, by which what varies linearly is
// found.
#pragma once

#include "geometry/point.hpp"

#include <abacus/read.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace abacus {

/// Weights of the corners at p, which lies in the closure of the simplex: none is negative, and
/// they sum to 1 up to rounding. At a corner they are exactly 1 and 0. Corners are taken as seen
/// from p, so the error is one of p's neighbourhood, not of its coordinates; and scaled, so nothing
/// overflows.
template <int D>
std::array<double, D + 1> barycentric_weights(const abacus_simplex &simplex, const Point<D> &p) {
    std::array<std::array<double, D>, D + 1> seen;
    for (int axis = 0; axis < D; ++axis) {
        double extent = 0;
        for (int i = 0; i <= D; ++i) {
            seen[i][axis] = simplex.corner[i][axis] / 4 - p[axis] / 4;
            extent = std::max(extent, std::abs(seen[i][axis]));
        }
        // Each axis to its own scale: weights are ratios of volumes.
        const int exponent = extent == 0 ? 0 : -std::ilogb(extent);
        for (int i = 0; i <= D; ++i) seen[i][axis] = std::scalbn(seen[i][axis], exponent);
    }
    const auto cross = [&](int a, int b, int i, int j) {
        return seen[a][i] * seen[b][j] - seen[a][j] * seen[b][i];
    };
    std::array<double, D + 1> weights;
    double sum = 0;
    for (int i = 0; i <= D; ++i) {
        if constexpr (D == 2) {
            weights[i] = cross((i + 1) % 3, (i + 2) % 3, 0, 1);
        } else {
            const int a = (i + 1) % 4, b = (i + 2) % 4, c = (i + 3) % 4;
            const double volume = seen[a][0] * cross(b, c, 1, 2) - seen[a][1] * cross(b, c, 0, 2) +
                                  seen[a][2] * cross(b, c, 0, 1);
            weights[i] = i % 2 == 0 ? volume : -volume;
        }
        weights[i] = std::max(weights[i], 0.0); // what is not is rounding
        sum += weights[i];
    }
    if (sum > 0)
        for (double &weight : weights) weight /= sum;
    else
        weights.fill(1.0 / (D + 1)); // a simplex too flat for doubles
    return weights;
}

} // namespace abacus
