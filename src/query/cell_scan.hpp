// The simplices of a window with what their corners carry, page by page.
#pragma once

#include "keys/locational_code.hpp"
#include "query/cell_filter.hpp"
#include "query/corner_values.hpp"
#include "query/vertex_values.hpp"

#include <abacus/ask.h>

namespace abacus {

template <int D> class CellScan {
public:
    /// Simplices with an edge longer than max_edge are left out, unless that is 0.
    CellScan(const Host &host, const abacus_header &header, const abacus_window &window,
             double max_edge);

    /// False after the last simplex. `values` gets all attributes, unless it is null.
    bool next(abacus_simplex &simplex, CornerValues *values);

private:
    const Domain<D> domain_;
    const CellFilter<D> filter_;
    const VertexValues<D> vertex_values_;
    RangeScan<D> pages_;
    bool in_page_ = false;
    int at_ = 0;
};

extern template class CellScan<2>;
extern template class CellScan<3>;

} // namespace abacus
