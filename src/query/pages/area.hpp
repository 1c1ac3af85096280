// The polygon of an extent, behind its handle of the C interface.
#pragma once

#include "geometry/polygon.hpp"

#include <abacus/area.h>

struct abacus_area {
    abacus_area(const abacus_host *table, const double *points, const std::size_t *sizes,
                std::size_t rings)
        : host(*table),
          polygon(host, reinterpret_cast<const abacus::Point<2> *>(points), sizes, rings) {}

    const abacus::Host host;
    const abacus::Polygon polygon;
};

namespace abacus {

/// Null: there is none.
inline const Polygon *polygon_of(const abacus_extent &extent) {
    return extent.area == nullptr ? nullptr : &extent.area->polygon;
}

/// The same extent without its polygon: for places and lines that are known to be in it.
inline abacus_extent without_polygon(abacus_extent extent) {
    extent.area = nullptr;
    return extent;
}

/// Whether a place may count; of a mesh in space, all may.
template <int D> bool may_count(const abacus_extent &extent, const Point<D> &p) {
    if constexpr (D == 2)
        if (const Polygon *polygon = polygon_of(extent)) return polygon->contains(p);
    return true;
}

} // namespace abacus
