// Boxes parallel to the axes.
#pragma once

#include "geometry/point.hpp"

#include <algorithm>
#include <limits>

namespace abacus {

/// A closed box; empty at first.
template <int D> struct Box {
    Point<D> lower, upper;

    Box() {
        lower.fill(std::numeric_limits<double>::infinity());
        upper.fill(-std::numeric_limits<double>::infinity());
    }
    Box(const Point<D> &lower, const Point<D> &upper) : lower(lower), upper(upper) {}

    void extend(const Point<D> &p) {
        for (int i = 0; i < D; ++i) {
            lower[i] = std::min(lower[i], p[i]);
            upper[i] = std::max(upper[i], p[i]);
        }
    }
    void extend(const Box &box) {
        for (int i = 0; i < D; ++i) {
            lower[i] = std::min(lower[i], box.lower[i]);
            upper[i] = std::max(upper[i], box.upper[i]);
        }
    }
    bool contains(const Point<D> &p) const {
        bool contains = true;
        for (int i = 0; i < D; ++i) contains &= lower[i] <= p[i] && p[i] <= upper[i];
        return contains;
    }
    /// The point of the box that is nearest to p. No coordinate is rounded.
    Point<D> nearest(const Point<D> &p) const {
        Point<D> nearest;
        for (int i = 0; i < D; ++i) nearest[i] = std::clamp(p[i], lower[i], upper[i]);
        return nearest;
    }
    /// Bit i of a corner's number chooses the upper end of axis i.
    Point<D> corner(int number) const {
        Point<D> corner;
        for (int i = 0; i < D; ++i) corner[i] = (number >> i & 1) != 0 ? upper[i] : lower[i];
        return corner;
    }
    bool operator==(const Box &) const = default;
    bool is_point() const { return lower == upper; }
    bool meets(const Box &box) const {
        bool meets = true;
        for (int i = 0; i < D; ++i) meets &= lower[i] <= box.upper[i] && box.lower[i] <= upper[i];
        return meets;
    }
};

} // namespace abacus
