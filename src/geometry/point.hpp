// Points: exact doubles, ordered lexicographically.
#pragma once

#include <array>

namespace abacus {

template <int D> using Point = std::array<double, D>;

/// Lexicographic order of the coordinates; it ranks the points for the
/// symbolic perturbation (predicates.hpp). -0.0 equals +0.0.
template <int D> inline bool lexicographically_less(const Point<D> &a, const Point<D> &b) {
    for (int i = 0; i < D; ++i) {
        if (a[i] < b[i]) return true;
        if (b[i] < a[i]) return false;
    }
    return false;
}

} // namespace abacus
