#include "query/levels/contour_cut.hpp"

#include "query/values/barycentric.hpp"
#include "query/values/weighted_mean.hpp"

#include <algorithm>
#include <cmath>

namespace abacus {

namespace {

/// The share of the way from a to b at x, which lies between them; a and b are finite and not
/// equal.
double share(double a, double b, double x) {
    const double whole = b - a;
    return std::isfinite(whole) ? (x - a) / whole : (x / 2 - a / 2) / (b / 2 - a / 2);
}

} // namespace

ContourWindow::ContourWindow(const abacus_window &window) {
    if (window.kind == ABACUS_NO_WINDOW) return;
    box_.emplace();
    for (int i = 0; i < 2; ++i) {
        box_->lower[i] = window.lower[i] + 0.0; // -0.0 is +0.0
        box_->upper[i] = window.upper[i] + 0.0;
    }
}

ContourEdge::ContourEdge(const ContourPoint &p, double value_p, const ContourPoint &q,
                         double value_q)
    : a(&p), b(&q), value_a(value_p), value_b(value_q) {
    if (*a < *b) return;
    std::swap(a, b);
    std::swap(value_a, value_b);
}

// std::lerp is exact at both ends, and monotonic between them.
Point<2> ContourEdge::crossing(double level) const {
    const double t = share(value_a, value_b, level);
    return {std::lerp((*a)[0], (*b)[0], t), std::lerp((*a)[1], (*b)[1], t)};
}

Point<2> ContourEdge::crossing(double level, const Point<2> &from, const Point<2> &to) const {
    Point<2> p = crossing(level);
    for (int i = 0; i < 2; ++i)
        p[i] = std::clamp(p[i], std::min(from[i], to[i]), std::max(from[i], to[i]));
    return p;
}

ContourCorner meet(const ContourEdge &edge, int side, const ContourWindow &window,
                   const ContourLevels &levels) {
    const int axis = ContourWindow::axis(side), other = 1 - axis;
    const double bound = window.bound(side);
    const double t = share((*edge.a)[axis], (*edge.b)[axis], bound);
    ContourCorner corner;
    corner.place[axis] = bound;
    corner.place[other] = std::lerp((*edge.a)[other], (*edge.b)[other], t);
    // Sides of x come first; anything still beyond them is rounding.
    if (other == 0) corner.place[0] = std::clamp(corner.place[0], window.bound(0), window.bound(1));
    corner.value = std::lerp(edge.value_a, edge.value_b, t);
    corner.rank = levels.rank(corner.value);
    corner.node = {ContourKind::edge_at_side + side, edge.a, edge.b};
    return corner;
}

bool clip(const ContourEdge &edge, const ContourWindow &window, const ContourLevels &levels,
          ContourCorner &from, ContourCorner &to) {
    for (int side = 0; side < 4 && window.is_bounded(); ++side) {
        const bool has_from = window.is_inside(from.place, side),
                   has_to = window.is_inside(to.place, side);
        if (!has_from && !has_to) return false;
        if (!has_from) from = meet(edge, side, window, levels);
        if (!has_to) to = meet(edge, side, window, levels);
    }
    return true;
}

bool ContourCut::take(const ContourCorners &corners, const std::array<double, 3> &values,
                      const std::array<std::int64_t, 3> &ranks) {
    corners_ = corners;
    values_ = values;
    ranks_ = ranks;
    is_cut_ = false;
    size_ = 3;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        edges_[i] = ContourEdge(*corners[i], values[i], *corners[j], values[j]);
        polygon_[i] = {*corners[i], values[i], ranks[i], {}, i};
        is_cut_ |= !window_.contains(*corners[i]);
    }
    if (is_cut_) clip();
    return size_ > 0;
}

void ContourCut::clip() {
    for (int side = 0; side < 4; ++side) clip(side);
    const auto lies_on = [&](int side) {
        return std::all_of(polygon_.begin(), polygon_.begin() + size_, [&](const auto &corner) {
            return corner.place[ContourWindow::axis(side)] == window_.bound(side);
        });
    };
    if (size_ < 3 || lies_on(0) || lies_on(1) || lies_on(2) || lies_on(3)) size_ = 0;
}

void ContourCut::clip(int side) {
    std::array<ContourCorner, most_corners> kept;
    int n = 0;
    const auto cross = [&](const ContourCorner &at) {
        return at.line < 3 ? meet(edges_[at.line], side, window_, levels_)
                           : window_corner(at.line - 3, side);
    };
    for (int i = 0; i < size_; ++i) {
        const ContourCorner &at = polygon_[i];
        const bool is_inside = window_.is_inside(at.place, side),
                   goes_inside = window_.is_inside(next(i).place, side);
        if (is_inside) kept[n++] = at;
        if (is_inside == goes_inside) continue;
        kept[n] = cross(at);
        kept[n++].line = is_inside ? 3 + side : at.line;
    }
    polygon_ = kept;
    size_ = n;
}

/// The corner in the triangle where one side meets another.
ContourCorner ContourCut::window_corner(int side, int other) const {
    ContourCorner corner;
    corner.place[ContourWindow::axis(side)] = window_.bound(side);
    corner.place[ContourWindow::axis(other)] = window_.bound(other);
    abacus_simplex triangle{};
    for (int i = 0; i < 3; ++i)
        std::copy(corners_[i]->begin(), corners_[i]->end(), triangle.corner[i]);
    const auto weights = barycentric_weights<2>(triangle, corner.place);
    corner.value = weighted_mean(
        3, [&](std::size_t i) { return weights[i]; }, [&](std::size_t i) { return values_[i]; });
    corner.rank = levels_.rank(corner.value);
    corner.node = {ContourKind::corner + (side % 2 + 2 * (other % 2)), nullptr, nullptr};
    return corner;
}

/// The point where the line from corner i crosses a level.
ContourEnd ContourCut::end(int i, std::int64_t level, ContourKind kind) const {
    const int line = polygon_[i].line;
    if (line < 3) {
        const ContourEdge &edge = edges_[line];
        return {edge.crossing(levels_.level(level), polygon_[i].place, next(i).place),
                {kind, edge.a, edge.b}};
    }
    if (kind == ContourKind::crossing)
        kind = ContourKind::end;
    else
        kind = ContourKind::crossing_at_side +
               (4 * (line - 3) + 2 * (polygon_[i].rank < level) + (kind == ContourKind::upper));
    // One edge of the triangle, in its direction, stands for the triangle.
    int least = 0;
    for (int k = 1; k < 3; ++k)
        if (*corners_[k] < *corners_[least]) least = k;
    return {crossing_at_side(i, level), {kind, corners_[least], corners_[(least + 1) % 3]}};
}

Point<2> ContourCut::crossing_at_side(int i, std::int64_t level) const {
    std::array<Point<2>, 2> ends; // of the contour in the whole triangle
    int n = 0;
    for (int k = 0; k < 3 && n < 2; ++k)
        if ((ranks_[k] < level) != (ranks_[(k + 1) % 3] < level))
            ends[n++] = edges_[k].crossing(levels_.level(level));
    std::sort(ends.begin(), ends.end());
    const int side = polygon_[i].line - 3, axis = ContourWindow::axis(side), other = 1 - axis;
    const double from = polygon_[i].place[other], to = next(i).place[other];
    Point<2> p;
    p[axis] = window_.bound(side);
    p[other] = ends[0][other]; // for a contour along the side, or a single point
    if (ends[0][axis] != ends[1][axis])
        p[other] =
            std::lerp(ends[0][other], ends[1][other], share(ends[0][axis], ends[1][axis], p[axis]));
    p[other] = std::clamp(p[other], std::min(from, to), std::max(from, to));
    return p;
}

} // namespace abacus
