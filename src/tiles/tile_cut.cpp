#include "tiles/tile_cut.hpp"

#include "geometry/predicates.hpp"

#include <utility>

namespace abacus {

namespace {

/// How far `at` is from a to b. Halves, as differences may be too large.
double share_of(double a, double b, double at) {
    const double length = b / 2 - a / 2;
    return length == 0 ? 0 : std::clamp((at / 2 - a / 2) / length, 0.0, 1.0);
}

Point<2> in_plane(const Point<3> &p) { return {p[0], p[1]}; }

/// The ends of an edge, in an order that all triangles and boxes share.
std::pair<const Point<3> *, const Point<3> *> ends_of(const std::array<Point<3>, 3> &corners,
                                                      int edge) {
    const Point<3> *a = &corners[edge], *b = &corners[(edge + 1) % 3];
    if (lexicographically_less<3>(*b, *a)) std::swap(a, b);
    return {a, b};
}

} // namespace

std::span<const CutCorner> TileCut::cut(const std::array<Point<3>, 3> &triangle) {
    corners_ = triangle;
    size_ = 3;
    for (int i = 0; i < 3; ++i)
        part_[i] = {in_plane(triangle[i]), triangle[i][2], 0, static_cast<std::int8_t>(i), -1};
    keep(0, box_.lower[0], 1, west_border);
    keep(0, box_.upper[0], -1, east_border);
    note_stretch(0, west_border);
    note_stretch(1, east_border);
    keep(1, box_.lower[1], 1, south_border);
    keep(1, box_.upper[1], -1, north_border);
    for (std::size_t i = 0; i < size_; ++i) part_[i].at = box_.nearest(part_[i].at);
    return {part_.data(), size_};
}

/// Keeps what lies on the side of `sign`, and what lies on the border.
void TileCut::keep(int axis, double at, int sign, TileBorder border) {
    const std::array<CutCorner, 8> whole = part_;
    const std::size_t whole_size = std::exchange(size_, 0);
    std::array<int, 8> side{};
    for (std::size_t i = 0; i < whole_size; ++i) side[i] = sign * side_of(whole[i], axis, at);
    for (std::size_t i = 0; i < whole_size; ++i) {
        const std::size_t next = (i + 1) % whole_size;
        if (side[i] >= 0) {
            CutCorner &corner = part_[size_++] = whole[i];
            if (side[i] == 0) {
                corner.at[axis] = at;
                corner.borders |= border;
                if (side[next] < 0) corner.side = -1;
            }
        }
        if (side[i] * side[next] >= 0) continue;
        CutCorner &corner = part_[size_++] = crossing(whole[i], whole[next], axis, at);
        corner.borders |= border;
        if (side[next] < 0) corner.side = -1;
    }
}

/// +1 beyond the border, 0 on it, -1 before it.
int TileCut::side_of(const CutCorner &corner, int axis, double at) const {
    if (axis == 1 && corner.crosses >= 0) {
        // Is the edge above or below the corner of the box where it crosses the vertical border?
        const auto [a, b] = ends_of(corners_, corner.crosses);
        return -orientation(in_plane(*a), in_plane(*b), {corner.at[0], at});
    }
    return (corner.at[axis] > at) - (corner.at[axis] < at);
}

/// Where the side between two corners crosses a border.
CutCorner TileCut::crossing(const CutCorner &from, const CutCorner &to, int axis, double at) const {
    CutCorner corner{};
    corner.borders = from.borders & to.borders;
    corner.side = from.side;
    corner.crosses = -1;
    corner.at[axis] = at;
    if (from.side < 0) { // along a vertical border
        const auto &[lower, upper] = stretches_[(corner.borders & west_border) != 0 ? 0 : 1];
        corner.at[0] = lower.at[0];
        corner.height =
            std::lerp(lower.height, upper.height, share_of(lower.at[1], upper.at[1], at));
        return corner;
    }
    const auto [a, b] = ends_of(corners_, from.side);
    const double share = share_of((*a)[axis], (*b)[axis], at);
    corner.at[1 - axis] = std::lerp((*a)[1 - axis], (*b)[1 - axis], share);
    corner.height = std::lerp((*a)[2], (*b)[2], share);
    if (axis == 0) corner.crosses = from.side;
    return corner;
}

void TileCut::note_stretch(int n, TileBorder border) {
    std::array<CutCorner, 2> &stretch = stretches_[n];
    bool is_first = true;
    for (std::size_t i = 0; i < size_; ++i) {
        const CutCorner &corner = part_[i];
        if ((corner.borders & border) == 0) continue;
        if (is_first || corner.at[1] < stretch[0].at[1]) stretch[0] = corner;
        if (is_first || corner.at[1] > stretch[1].at[1]) stretch[1] = corner;
        is_first = false;
    }
}

} // namespace abacus
