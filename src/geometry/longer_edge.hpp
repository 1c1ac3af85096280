// By how long edges are users leave out simplices, such as those across open water.
#pragma once

#include "geometry/distance.hpp"

namespace abacus {

/// Whether one of the edges between n points, point(0) to point(n - 1), is longer than a bound.
template <int D, class PointOf> bool has_longer_edge(int n, double bound, PointOf point) {
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < i; ++j)
            if (distance<D>(point(i), point(j)) > bound) return true;
    return false;
}

} // namespace abacus
