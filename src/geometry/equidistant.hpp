// The place at the same distance from some points, on some sides of a box: D + 1 of both together.
// So a corner of a Voronoi cell is given by what it is a corner of, and not by other corners.
//
// Points are taken in lexicographic order. So every caller gets the same doubles for a place, and
// cells fit together without gaps. Where that matters, among cospherical points, they are asked for
// as rounded rational numbers: these do not depend on which of the points are named.
#pragma once

#include "geometry/box.hpp"

#include <optional>

namespace abacus {

/// Side 2 * axis of a box is where the axis has its least value, side 2 * axis + 1 where it has its
/// greatest.
template <int D> double side_value(const Box<D> &box, int side) {
    return side % 2 == 0 ? box.lower[side / 2] : box.upper[side / 2];
}

enum class Rounding { whenever, at_the_end };

template <int D> class Equidistant {
public:
    /// At least one point is added.
    void add(const Point<D> &point) { points_[count_++] = &point; }
    void add_side(int side, double value) { sides_[side_count_++] = {side / 2, value}; }
    /// Nothing if there is no such place, or more than one.
    std::optional<Point<D>> place(Rounding rounding);

private:
    struct Side {
        int axis;
        double value;
    };
    template <class T> auto system(bool is_seen_from_first) const;

    std::array<const Point<D> *, D + 1> points_;
    std::array<Side, D> sides_;
    int count_ = 0, side_count_ = 0;
};

/// The centre of a simplex's circumsphere.
template <int D>
Point<D> circumcentre(const std::array<const Point<D> *, D + 1> &corners, Rounding rounding);

extern template class Equidistant<2>;
extern template class Equidistant<3>;

} // namespace abacus
