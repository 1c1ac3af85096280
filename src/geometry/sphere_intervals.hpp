// Vectors of intervals, for bounds that are rounded outwards. Only between the ends of an
// Interval::Protector, which sets the rounding mode.
#pragma once

#include "geometry/point.hpp"

#include <CGAL/Interval_nt.h>

namespace abacus::intervals {

using Interval = CGAL::Interval_nt<false>;
template <int D> using Vector = std::array<Interval, D>;

inline Interval determinant(const Interval &a, const Interval &b, const Interval &c,
                            const Interval &d) {
    return a * d - b * c;
}
inline Vector<3> cross(const Vector<3> &a, const Vector<3> &b) {
    return {determinant(a[1], a[2], b[1], b[2]), determinant(a[2], a[0], b[2], b[0]),
            determinant(a[0], a[1], b[0], b[1])};
}
template <std::size_t D> Interval squared(const std::array<Interval, D> &v) {
    Interval sum = square(v[0]);
    for (std::size_t k = 1; k < D; ++k) sum += square(v[k]);
    return sum;
}

} // namespace abacus::intervals
