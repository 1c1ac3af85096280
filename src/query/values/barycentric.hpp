// Where a place lies in a simplex: the weights of its corners, for values that vary linearly.
//
// A weight is the share of the simplex that the place spans with the facet opposite the corner.
// These volumes are computed in doubles, with bounds on their errors. If the bounds are small
// compared with the whole simplex, the weights are good; otherwise the simplex is flat, or nearly
// so, and they are computed in rational numbers. Whether a corner has a weight at all is decided
// exactly.
#pragma once

#include "geometry/predicates.hpp"

#include <abacus/simplex.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace abacus {

/// The total error of weights is at most twice this, unless they are computed in rational numbers.
/// So the error of a linearly varying value is at most this fraction of its range in the simplex.
inline constexpr double most_weight_error = 1e-10;

/// The least weight that is not 0.
inline constexpr double least_weight = std::numeric_limits<double>::min();

/// The volumes that the facets of a simplex span with a place, up to a factor, and bounds on their
/// errors.
template <int D> struct CornerVolumes {
    std::array<double, D + 1> volume, error;

    /// Computes them for the corners relative to the place, none of which equals it; false if the
    /// errors may be too large.
    bool compute(const std::array<Point<D>, D + 1> &seen);
    /// Whether corner i certainly has a weight.
    bool is_sure(int i) const { return volume[i] > error[i]; }
};

namespace exact {
/// As abacus::barycentric_weights(), in rational numbers.
template <int D>
std::array<double, D + 1> barycentric_weights(const abacus_simplex &simplex, const Point<D> &p);
/// Makes uncertain volumes 0 or positive, by their exact signs.
template <int D>
void settle(CornerVolumes<D> &volumes, const abacus_simplex &simplex, const Point<D> &p);
} // namespace exact

// The bounds are those of predicates.hpp, for these expressions.
template <int D> inline bool CornerVolumes<D>::compute(const std::array<Point<D>, D + 1> &seen) {
    constexpr double factor = D == 2 ? 3.3307e-16 : 7.7716e-16;
    double sum = 0, permanents = 0;
    for (int i = 0; i <= D; ++i) {
        const Point<D> &a = seen[(i + 1) % (D + 1)], &b = seen[(i + 2) % (D + 1)];
        double permanent;
        if constexpr (D == 2) {
            const double left = a[0] * b[1], right = a[1] * b[0];
            volume[i] = left - right;
            permanent = std::fabs(left) + std::fabs(right);
        } else {
            const Point<D> &c = seen[(i + 3) % 4];
            const double yz = b[1] * c[2], zy = b[2] * c[1], xz = b[0] * c[2], zx = b[2] * c[0],
                         xy = b[0] * c[1], yx = b[1] * c[0];
            const double det = a[0] * (yz - zy) - a[1] * (xz - zx) + a[2] * (xy - yx);
            volume[i] = i % 2 == 0 ? det : -det;
            permanent = std::fabs(a[0]) * (std::fabs(yz) + std::fabs(zy)) +
                        std::fabs(a[1]) * (std::fabs(xz) + std::fabs(zx)) +
                        std::fabs(a[2]) * (std::fabs(xy) + std::fabs(yx));
        }
        error[i] = factor * permanent;
        permanents += permanent;
        sum += std::max(volume[i], 0.0);
    }
    // Underflow is far less than 1e-30 of this.
    double least = 1e-250, size = 0;
    if constexpr (D == 3) {
        for (const Point<D> &corner : seen)
            size += std::fabs(corner[0]) + std::fabs(corner[1]) + std::fabs(corner[2]);
        least = std::max(least, 1e-290 * size);
    }
    for (double &bound : error) bound += 1e-30 * permanents;
    return permanents * (factor / most_weight_error) <= sum && permanents > least &&
           permanents < 1e250;
}

/// Weights of the corners at p, which lies in the closure of the simplex. Those that are not 0 are
/// positive, and their corners span the face whose interior contains p. They sum to 1, up to
/// rounding; at a corner they are exactly 1 and 0. Corners are taken relative to p, so the error
/// depends on the size of p's neighbourhood, not on its coordinates. At a place outside, where
/// rounding may have put it, a corner has no weight if the place lies beyond the facet opposite the
/// corner.
template <int D>
inline std::array<double, D + 1> barycentric_weights(const abacus_simplex &simplex,
                                                     const Point<D> &p) {
    std::array<double, D + 1> weights{};
    std::array<Point<D>, D + 1> seen;
    for (int i = 0; i <= D; ++i) {
        bool is_here = true;
        for (int axis = 0; axis < D; ++axis) {
            seen[i][axis] = simplex.corner[i][axis] - p[axis];
            is_here &= seen[i][axis] == 0;
        }
        if (is_here) {
            weights[i] = 1;
            return weights;
        }
    }
    CornerVolumes<D> volumes;
    if (!volumes.compute(seen)) [[unlikely]]
        return exact::barycentric_weights<D>(simplex, p);
    bool are_sure = true;
    for (int i = 0; i <= D; ++i) are_sure &= volumes.is_sure(i);
    if (!are_sure) exact::settle<D>(volumes, simplex, p);
    double sum = 0;
    for (int i = 0; i <= D; ++i) sum += volumes.volume[i];
    for (int i = 0; i <= D; ++i) {
        weights[i] = volumes.volume[i] / sum;
        if (volumes.volume[i] > 0) weights[i] = std::max(weights[i], least_weight);
    }
    return weights;
}

} // namespace abacus
