// The simplex in which a place should be found: if several contain it, the first by code and ids.
#pragma once

#include "geometry/predicates.hpp"
#include "support/oracle.hpp"

#include <tuple>
#include <vector>

namespace abacus::test {

template <int D> auto rank(const abacus_simplex &s) {
    return std::tuple(s.code, std::vector<std::int64_t>(s.id, s.id + D + 1));
}

/// Sign of the orientation with corner i replaced by p; p = null: of the simplex itself.
template <int D> int side(const abacus_simplex &s, int i, const Point<D> *p) {
    std::array<Point<D>, D + 1> at;
    Corners<D> corners;
    for (int k = 0; k <= D; ++k) {
        std::copy_n(s.corner[k], D, at[k].begin());
        corners[k] = k == i && p != nullptr ? p : &at[k];
    }
    return orientation<D>(corners);
}

/// Whether a finite simplex contains p, border included.
template <int D> bool contains(const abacus_simplex &s, const Point<D> &p) {
    for (int i = 0; i <= D; ++i)
        if (side<D>(s, i, &p) < 0) return false;
    return true;
}

} // namespace abacus::test
