// A triangle cut at the border of a box, so that the cuts of neighbours fit.
//
// Invariants:
// 1. Which corners the part has is decided by exact predicates on the triangle's own corners.
// 2. A corner on a border is computed from the edge that it is on and from that border, or, at a
//    corner of the box, from where the triangle crosses the vertical border. So it is the same, to
//    the last bit, in all boxes and for all triangles that have it.
// 3. `borders` says on which borders a corner is, exactly, however its place is rounded.
#pragma once

#include "geometry/box.hpp"

#include <cstdint>
#include <span>

namespace abacus {

enum TileBorder : std::uint8_t {
    west_border = 1,
    east_border = 2,
    south_border = 4,
    north_border = 8
};

struct CutCorner {
    Point<2> at;
    double height;
    std::uint8_t borders;
    // The edge of the triangle on which the side to the next corner is; -1: a border.
    std::int8_t side;
    // The edge that crosses a vertical border here; -1: none does.
    std::int8_t crosses;
};

class TileCut {
public:
    /// The box may be flat, for what a triangle has on one border.
    explicit TileCut(const Box<2> &box) : box_(box) {}

    /// The part in the box of a triangle in counterclockwise order: x, y and height of its corners.
    /// A part with less than three corners has no area. Valid until the next call.
    std::span<const CutCorner> cut(const std::array<Point<3>, 3> &triangle);

private:
    void keep(int axis, double at, int sign, TileBorder border);
    int side_of(const CutCorner &corner, int axis, double at) const;
    CutCorner crossing(const CutCorner &from, const CutCorner &to, int axis, double at) const;
    void note_stretch(int n, TileBorder border);

    const Box<2> box_;
    std::array<Point<3>, 3> corners_{};
    std::array<CutCorner, 8> part_{}; // each border adds at most one corner
    std::size_t size_ = 0;
    // What the triangle has of the lines of the west and the east border: lower end, upper end.
    std::array<std::array<CutCorner, 2>, 2> stretches_{};
};

} // namespace abacus
