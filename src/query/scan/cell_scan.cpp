#include "query/scan/cell_scan.hpp"

#include "keys/domain_of.hpp"
#include "query/pages/page_simplex.hpp"
#include "query/scan/extent_pages.hpp"

namespace abacus {

template <int D>
CellScan<D>::CellScan(const Host &host, const abacus_facts &facts, const abacus_window &window,
                      const abacus_extent &extent, const abacus_range *label)
    : domain_(domain_of<D>(facts.form)), filter_(window, extent), vertex_values_(host, facts) {
    typename RangeScan<D>::Wants wants = pages_in<D>(extent);
    if (label != nullptr) {
        label_.emplace(host, facts, *label);
        wants = [this, in_extent = std::move(wants)](const PageView<D> &page) {
            return (!in_extent || in_extent(page)) && label_->may_be_in(page);
        };
    }
    pages_.emplace(host, facts, filter_.region(), wants);
}

template <int D>
CellScan<D>::CellScan(const Host &host, const abacus_facts &facts, std::uint64_t least,
                      std::uint64_t greatest)
    : domain_(domain_of<D>(facts.form)), filter_({}, {}), vertex_values_(host, facts),
      least_(least), greatest_(greatest) {
    stretch_.emplace(host, facts, least, greatest);
}

template <int D> bool CellScan<D>::wants(int simplex) {
    if (page().is_ghost(simplex)) return false;
    if (!stretch_)
        return filter_.wants(page(), simplex) && (!label_ || label_->wants(page(), simplex));
    const std::uint64_t code = code_of(page(), simplex, domain_);
    return least_ <= code && code <= greatest_;
}

template <int D> bool CellScan<D>::next(abacus_simplex &simplex, CornerValues *values) {
    for (;;) {
        if (!in_page_) {
            if (!advance()) return false;
            in_page_ = true;
            at_ = 0;
        }
        while (at_ < page().simplices()) {
            const int s = at_++;
            if (!wants(s)) continue;
            describe(page(), s, domain_, simplex, values, vertex_values_);
            return true;
        }
        in_page_ = false;
    }
}

template class CellScan<2>;
template class CellScan<3>;

} // namespace abacus
