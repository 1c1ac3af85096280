// Arithmetic of pictures, rounded: pictures need no more.
#pragma once

#include "geometry/point.hpp"

#include <cmath>
#include <limits>

namespace abacus {

inline double dot(const Point<3> &a, const Point<3> &b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Point<3> cross(const Point<3> &a, const Point<3> &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// An infinite or undefined number becomes a large one, so that no product with it is undefined.
inline double finite(double x) {
    constexpr double most = std::numeric_limits<double>::max();
    return std::fmin(std::fmax(x, -most), most);
}

} // namespace abacus
