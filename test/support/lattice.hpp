// Points on a grid of whole numbers, and points at random in the unit cube.
#pragma once

#include "support/point_sets.hpp"

namespace abacus::test {

/// All points with coordinates 0 to n - 1; the first coordinate varies fastest.
template <int D> std::vector<Point<D>> grid(int n) {
    std::vector<Point<D>> points;
    for (int i = 0; i < (D == 2 ? n * n : n * n * n); ++i) {
        Point<D> p{};
        for (int axis = 0, rest = i; axis < D; ++axis, rest /= n) p[axis] = rest % n;
        points.push_back(p);
    }
    return points;
}

template <int D> std::vector<Point<D>> random_points(int n, unsigned seed) {
    Random random(seed);
    std::vector<Point<D>> points(static_cast<std::size_t>(n));
    for (Point<D> &p : points)
        for (double &x : p) x = unit(random);
    return points;
}

} // namespace abacus::test
