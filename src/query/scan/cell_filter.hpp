// Selects simplices of a page: those that meet a window and have no edge longer than a limit.
#pragma once

#include "query/pages/page_simplex.hpp"
#include "query/scan/window.hpp"

namespace abacus {

template <int D> class CellFilter {
public:
    /// Simplices with an edge longer than max_edge are not wanted, unless that is 0.
    CellFilter(const abacus_window &window, double max_edge)
        : window_(window), max_edge_(max_edge) {}

    /// The region of the window; null: the whole mesh.
    const Region<D> *region() const { return window_.region(); }

    /// For a simplex that is not a ghost.
    bool wants(const PageView<D> &page, int simplex) const {
        const Corners<D> corners = corners_of(page, simplex);
        if (!window_.meets(corners)) return false;
        for (int i = 0; max_edge_ > 0 && i <= D; ++i)
            for (int j = 0; j < i; ++j)
                if (!is_within<D>(max_edge_, *corners[i], *corners[j])) return false;
        return true;
    }

private:
    const Window<D> window_;
    const double max_edge_;
};

} // namespace abacus
