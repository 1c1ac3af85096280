// A window that leaves out what no polygon of an extent meets: pages beyond it are not read.
#pragma once

#include "query/pages/area.hpp"

#include <abacus/windows.h>

#include <algorithm>

namespace abacus {

/// The polygon's box, if there is no window.
template <int D> abacus_window narrowed(const abacus_window &window, const abacus_extent &extent) {
    const Polygon *polygon = polygon_of(extent);
    if (D != 2 || polygon == nullptr) return window;
    const Box<2> &box = polygon->box();
    if (window.kind != ABACUS_NO_WINDOW || box.upper[0] < box.lower[0]) return window;
    abacus_window narrow{};
    narrow.kind = ABACUS_BOX_WINDOW;
    std::copy_n(box.lower.begin(), 2, narrow.lower);
    std::copy_n(box.upper.begin(), 2, narrow.upper);
    return narrow;
}

} // namespace abacus
