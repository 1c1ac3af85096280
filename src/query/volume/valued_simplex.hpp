// Simplices with the values at their corners, cut at the border of a window or a polygon.
#pragma once

#include "geometry/clip_trapezoid.hpp"
#include "geometry/piece.hpp"
#include "geometry/polygon.hpp"
#include "query/scan/cell_scan.hpp"
#include "sort/pacer.hpp"

#include <abacus/volume.h>

#include <algorithm>
#include <limits>

namespace abacus {

/// A simplex with its corners in lexicographic order, and their values.
template <int D> struct ValuedSimplex {
    std::array<Point<D>, D + 1> corner;
    std::array<double, D + 1> value;

    template <class PointOf, class ValueOf> ValuedSimplex(PointOf point, ValueOf number) {
        std::array<int, D + 1> order;
        for (int i = 0; i <= D; ++i) order[i] = i;
        std::sort(order.begin(), order.end(),
                  [&](int i, int j) { return lexicographically_less<D>(point(i), point(j)); });
        for (int i = 0; i <= D; ++i) {
            corner[i] = point(order[i]);
            value[i] = number(order[i]);
        }
    }

    bool has_values() const {
        return std::all_of(value.begin(), value.end(), [](double v) { return std::isfinite(v); });
    }
    Piece<D> as_it_is() const { return {corner, value}; }
    /// Relative to its first corner.
    Piece<D> piece() const {
        Piece<D> piece;
        for (int i = 0; i <= D; ++i) {
            piece.corner[i] = seen_from_first(corner[i]);
            piece.value[i] = value[i];
        }
        return piece;
    }
    Point<D> seen_from_first(const Point<D> &p) const {
        Point<D> seen;
        for (int axis = 0; axis < D; ++axis) seen[axis] = p[axis] - corner[0][axis];
        return seen;
    }
    Box<D> seen_from_first(const Box<D> &box) const {
        return {seen_from_first(box.lower), seen_from_first(box.upper)};
    }
};

/// The polygon of an extent; null in space.
template <int D> const Polygon *polygon_in(const abacus_extent &extent) {
    return D == 2 ? polygon_of(extent) : nullptr;
}

/// Calls visit(piece) for the parts of a simplex that count, cut at the border of a polygon. Its
/// corner 0 is the origin of the piece.
template <int D, class Visit>
void clip_polygon(const ValuedSimplex<D> &cell, const Piece<D> &piece, const abacus_extent &extent,
                  Visit &&visit) {
    if constexpr (D == 2)
        if (const Polygon *polygon = polygon_of(extent)) {
            Box<2> box;
            for (const Point<2> &corner : cell.corner) box.extend(corner);
            return polygon->each_part(box, [&](const Polygon::Trapezoid &part) {
                clip_trapezoid(piece, part, cell.corner[0], visit);
            });
        }
    visit(piece);
}

template <int D>
ValuedSimplex<D> cell_of(const abacus_simplex &simplex, const CornerValues &values) {
    return {[&](int i) {
                Point<D> p;
                std::copy_n(simplex.corner[i], D, p.begin());
                return p;
            },
            [&](int i) { return values.value(i, 0); }};
}

template <int D> Box<D> box_of(const abacus_window &window) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Box<D> box;
    for (int axis = 0; axis < D; ++axis) {
        const bool has_box = window.kind == ABACUS_BOX_WINDOW;
        box.lower[axis] = has_box ? window.lower[axis] : -infinity;
        box.upper[axis] = has_box ? window.upper[axis] : infinity;
    }
    return box;
}

template <int D> abacus_window window_of(const Box<D> &box) {
    abacus_window window{};
    if (std::isfinite(box.lower[0]) && std::isfinite(box.upper[0])) {
        window.kind = ABACUS_BOX_WINDOW;
        std::copy_n(box.lower.begin(), D, window.lower);
        std::copy_n(box.upper.begin(), D, window.upper);
    }
    return window;
}

/// Calls visit(piece) for the pieces of a piece in a box.
template <int D, int bound = 0, class Visit>
void clip_box(const Piece<D> &piece, const Box<D> &box, Visit &&visit) {
    if constexpr (bound == 2 * D) {
        visit(piece);
    } else {
        constexpr int axis = bound / 2;
        constexpr bool is_lower = bound % 2 == 0;
        clip_axis<D>(piece, axis, is_lower ? box.lower[axis] : box.upper[axis], is_lower,
                     [&](const Piece<D> &part) { clip_box<D, bound + 1>(part, box, visit); });
    }
}

/// Calls visit(simplex, values) for each simplex of a window with the values at its corners, and
/// reports progress.
template <int D, class Visit>
void each_simplex(const Host &host, const abacus_facts &facts, const abacus_surface &surface,
                  const abacus_window &window, Visit visit) {
    Pacer pacer(host);
    pacer.begin(ABACUS_PHASE_SCANNING,
                window.kind == ABACUS_NO_WINDOW ? facts.census.simplices : 0);
    CellScan<D> cells(host, facts, window, surface.extent);
    CornerValues values(&surface.attribute, 1);
    abacus_simplex simplex;
    /// Simplices between two reports of progress: some milliseconds, between two meshes.
    constexpr std::uint64_t simplices_at_once = 1024;
    std::uint64_t seen = 0;
    while (cells.next(simplex, &values)) {
        visit(simplex, values);
        if (++seen % simplices_at_once == 0) pacer.reached(seen);
    }
    pacer.end(seen, {});
}

} // namespace abacus
