// A window that leaves out what is beyond the polygon or the region of an extent: pages there are
// not read.
#pragma once

#include "query/pages/extent.hpp"

#include <abacus/windows.h>

#include <algorithm>

namespace abacus {

/// The box around what counts, if there is no window.
template <int D> abacus_window narrowed(const abacus_window &window, const abacus_extent &extent) {
    const std::optional<Box<2>> box = D == 2 ? box_of(extent) : std::nullopt;
    if (!box || window.kind != ABACUS_NO_WINDOW || box->upper[0] < box->lower[0]) return window;
    abacus_window narrow{};
    narrow.kind = ABACUS_BOX_WINDOW;
    std::copy_n(box->lower.begin(), 2, narrow.lower);
    std::copy_n(box->upper.begin(), 2, narrow.upper);
    return narrow;
}

} // namespace abacus
