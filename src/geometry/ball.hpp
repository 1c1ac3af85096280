// Closed balls: which points and simplices they meet. Exact.
#pragma once

#include "geometry/distance.hpp"
#include "geometry/predicates.hpp"

namespace abacus {

/// A radius of 0 leaves the centre.
template <int D> struct Ball {
    Point<D> center;
    double radius;

    /// -1 inside, 0 on the sphere, 1 outside.
    int side(const Point<D> &p) const;
    bool contains(const Point<D> &p) const { return side(p) <= 0; }
};

namespace exact {
/// As Ball::side().
template <int D> int side(const Ball<D> &ball, const Point<D> &p);
/// Whether the ball meets an edge in a point that is nearest to its centre and no end.
template <int D> bool meets_edge(const Point<D> &a, const Point<D> &b, const Ball<D> &ball);
/// Whether the ball meets a facet of the simplex, whose corners it does not contain.
template <int D> bool meets_facet(const Corners<D> &corners, const Ball<D> &ball);
} // namespace exact

// The bound is that of compare_distance(), of which one side is rounded once.
template <int D> int Ball<D>::side(const Point<D> &p) const {
    const double square = rounded_square<D>(center, p), most = radius * radius;
    const double sum = square + most, difference = square - most;
    if (sum > 1e-290) [[likely]] {
        if (difference > 1e-15 * sum) return 1;
        if (difference < -1e-15 * sum) return -1;
    }
    return exact::side<D>(*this, p);
}

/// Whether two points are at most so far from one another.
template <int D> bool is_within(double length, const Point<D> &a, const Point<D> &b) {
    return Ball<D>{a, length}.contains(b);
}

/// Whether a finite simplex of positive orientation meets the ball.
template <int D> bool meets(const Corners<D> &corners, const Ball<D> &ball) {
    for (const Point<D> *corner : corners)
        if (ball.contains(*corner)) return true;
    return in_simplex<D>(corners, ball.center) >= 0 || exact::meets_facet<D>(corners, ball);
}

} // namespace abacus
