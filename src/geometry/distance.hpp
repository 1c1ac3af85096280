// Which of two points is nearer to a third. Exact.
//
// The squares of the distances are compared in doubles first. Each coordinate is rounded once in
// its difference, twice with its square, at most twice more in the sum, and the difference of the
// two sums once: so the error is below 6 units in the last place of these. Where that does not
// decide, CGAL's filtered kernel does (distance.cpp).
#pragma once

#include "geometry/point.hpp"

#include <cmath>

namespace abacus {

namespace exact {
/// As compare_distance() below.
template <int D> int compare_distance(const Point<D> &p, const Point<D> &a, const Point<D> &b);
} // namespace exact

/// The square of the distance, rounded.
template <int D> double rounded_square(const Point<D> &p, const Point<D> &a) {
    double sum = 0;
    for (int i = 0; i < D; ++i) sum += (a[i] - p[i]) * (a[i] - p[i]);
    return sum;
}

/// The length of a vector, rounded; infinite only if no double is so large.
inline double length(const Point<2> &a) { return std::hypot(a[0], a[1]); }
inline double length(const Point<3> &a) {
    const double size = std::hypot(a[0], a[1], a[2]); // NaN if one is infinite
    return std::isnan(size) ? std::hypot(std::hypot(a[0], a[1]), a[2]) : size;
}

/// The distance, rounded; infinite only if no double is so large.
template <int D> double distance(const Point<D> &p, const Point<D> &a) {
    Point<D> way;
    for (int i = 0; i < D; ++i) way[i] = a[i] - p[i];
    return length(way);
}

/// -1 if a is nearer to p than b is, +1 if it is farther away, 0 if neither.
template <int D> int compare_distance(const Point<D> &p, const Point<D> &a, const Point<D> &b) {
    const double to_a = rounded_square<D>(p, a), to_b = rounded_square<D>(p, b);
    const double sum = to_a + to_b, difference = to_a - to_b;
    if (sum > 1e-290) [[likely]] {
        if (difference > 1e-15 * sum) return 1;
        if (difference < -1e-15 * sum) return -1;
    }
    return a == b ? 0 : exact::compare_distance<D>(p, a, b);
}

/// The order by distance from p; of points equally far the lexicographically least comes first.
template <int D> bool comes_nearer(const Point<D> &p, const Point<D> &a, const Point<D> &b) {
    const int sign = compare_distance<D>(p, a, b);
    return sign != 0 ? sign < 0 : lexicographically_less<D>(a, b);
}

} // namespace abacus
