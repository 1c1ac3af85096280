// Selects simplices of a page: those that meet a window, and count.
#pragma once

#include "query/pages/extent.hpp"
#include "query/pages/page_simplex.hpp"
#include "query/scan/narrowed.hpp"
#include "query/scan/window.hpp"

namespace abacus {

template <int D> class CellFilter {
public:
    CellFilter(const abacus_window &window, const abacus_extent &extent)
        : window_(narrowed<D>(window, extent)), extent_(extent) {}

    /// The region of the window; null: the whole mesh.
    const Region<D> *region() const { return window_.region(); }

    /// For a simplex that is not a ghost.
    bool wants(const PageView<D> &page, int simplex) const {
        const Corners<D> corners = corners_of(page, simplex);
        return window_.meets(corners) && is_in<D>(extent_, page.region(simplex), corners);
    }

private:
    const Window<D> window_;
    const abacus_extent extent_;
};

} // namespace abacus
