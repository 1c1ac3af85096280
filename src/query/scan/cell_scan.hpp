// The simplices of a window, or of a stretch of the curve, with the values at their corners, page
// by page. A window can skip simplices whose label is outside a range.
#pragma once

#include "keys/locational_code.hpp"
#include "query/pages/corner_values.hpp"
#include "query/pages/stretch_scan.hpp"
#include "query/pages/vertex_values.hpp"
#include "query/scan/cell_filter.hpp"
#include "query/scan/label_range.hpp"

#include <abacus/windows.h>
#include <optional>

namespace abacus {

template <int D> class CellScan {
public:
    /// Simplices outside of the extent are left out, and those whose
    /// label is not within a range, unless that is null.
    CellScan(const Host &host, const abacus_facts &facts, const abacus_window &window,
             const abacus_extent &extent, const abacus_range *label = nullptr);

    /// Those with codes from `least` to `greatest`, page by page in key order.
    CellScan(const Host &host, const abacus_facts &facts, std::uint64_t least,
             std::uint64_t greatest);

    /// False after the last simplex. `values` gets all attributes, unless it is null.
    bool next(abacus_simplex &simplex, CornerValues *values);
    std::uint64_t pages_read() const {
        return stretch_ ? stretch_->pages_read() : pages_->pages_read();
    }

private:
    bool advance() { return stretch_ ? stretch_->advance() : pages_->advance(); }
    const PageView<D> &page() const { return stretch_ ? stretch_->page() : pages_->page(); }
    bool wants(int simplex);

    const Domain<D> domain_;
    const CellFilter<D> filter_;
    const VertexValues<D> vertex_values_;
    std::uint64_t least_ = 0, greatest_ = 0; // the codes of a stretch
    std::optional<LabelRange<D>> label_;
    // One of these two is used.
    std::optional<RangeScan<D>> pages_;
    std::optional<StretchScan<D>> stretch_;
    bool in_page_ = false;
    int at_ = 0;
};

extern template class CellScan<2>;
extern template class CellScan<3>;

} // namespace abacus
