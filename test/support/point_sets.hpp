// Inputs that are hard in different ways: cospherical, coplanar, collinear, clustered, of
// any magnitude, with duplicates.
#pragma once

#include "geometry/point.hpp"

#include <functional>
#include <ostream>
#include <random>
#include <vector>

namespace abacus::test {

using Random = std::mt19937_64;

/// From 0 to 1.
inline double unit(Random &random) { return std::uniform_real_distribution<double>(0, 1)(random); }

template <int D> struct PointSet {
    const char *name;
    std::function<std::vector<Point<D>>(Random &)> points;
};
template <int D> void PrintTo(const PointSet<D> &set, std::ostream *stream) { *stream << set.name; }

template <int D> const std::vector<PointSet<D>> &point_sets();
template <> const std::vector<PointSet<2>> &point_sets<2>();
template <> const std::vector<PointSet<3>> &point_sets<3>();

} // namespace abacus::test
