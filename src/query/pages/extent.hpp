// Which simplices count in a question: those without a long edge, in a region, and with a part in a
// polygon. Users leave out others, such as those across open water. Exact.
#pragma once

#include "geometry/ball.hpp"
#include "geometry/box.hpp"
#include "mesh/cache.hpp"
#include "query/pages/area.hpp"

#include <abacus/extent.h>
#include <abacus/simplex.h>

#include <cmath>
#include <optional>

namespace abacus {

inline bool limits_edges(const abacus_extent &extent) {
    return extent.max_edge > 0 && std::isfinite(extent.max_edge);
}
inline bool is_all(const abacus_extent &extent) {
    return !limits_edges(extent) && extent.region == no_region && extent.area == nullptr;
}

/// A box around what counts, if one is known.
inline std::optional<Box<2>> box_of(const abacus_extent &extent) {
    if (const Polygon *polygon = polygon_of(extent)) return polygon->box();
    if (extent.has_box == 0) return {};
    return Box<2>({extent.lower[0], extent.lower[1]}, {extent.upper[0], extent.upper[1]});
}

/// Whether none of the edges between n points, point(0) to point(n - 1), is longer than a bound.
template <int D, class PointOf> bool has_short_edges(int n, double bound, PointOf point) {
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < i; ++j)
            if (!is_within<D>(bound, point(i), point(j))) return false;
    return true;
}

/// Of a simplex, or of a ghost by its n finite corners, of which no polygon has a part.
template <int D, class PointOf>
bool is_in(const abacus_extent &extent, RegionNumber region, int n, PointOf point) {
    if (extent.region != no_region && region != extent.region) return false;
    if (limits_edges(extent) && !has_short_edges<D>(n, extent.max_edge, point)) return false;
    if constexpr (D == 2)
        if (const Polygon *polygon = polygon_of(extent)) {
            const Point<2> corner[3] = {point(0), point(1), n == 3 ? point(2) : point(1)};
            return n == 3 && polygon->overlaps({&corner[0], &corner[1], &corner[2]});
        }
    return true;
}
template <int D>
bool is_in(const abacus_extent &extent, RegionNumber region, const Corners<D> &corners) {
    return is_in<D>(extent, region, D + 1, [&](int i) -> const Point<D> & { return *corners[i]; });
}
template <int D>
bool is_in(const abacus_extent &extent, const PageView<D> &page, int simplex, int n = D + 1) {
    return is_in<D>(extent, page.region(simplex), n,
                    [&](int i) -> const Point<D> & { return page.point(page.corner(simplex, i)); });
}
template <int D> bool is_in(const abacus_extent &extent, const Cache<D> &cache, Handle h) {
    return is_in<D>(extent, cache.region(h), cache.corners(cache.simplex(h)));
}
template <int D> bool is_in(const abacus_extent &extent, const abacus_simplex &simplex) {
    return is_in<D>(extent, simplex.region, D + 1, [&](int i) {
        Point<D> p;
        std::copy_n(simplex.corner[i], D, p.begin());
        return p;
    });
}

} // namespace abacus
