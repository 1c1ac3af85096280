#include "query/cell_scan.hpp"

#include "keys/domain_of.hpp"
#include "query/page_simplex.hpp"

namespace abacus {

template <int D>
CellScan<D>::CellScan(const Host &host, const abacus_header &header, const abacus_window &window,
                      double max_edge)
    : domain_(domain_of<D>(header)), filter_(window, max_edge), vertex_values_(host, header),
      pages_(host, header, filter_.region()) {}

template <int D> bool CellScan<D>::next(abacus_simplex &simplex, CornerValues *values) {
    for (;;) {
        if (!in_page_) {
            if (!pages_.advance()) return false;
            in_page_ = true;
            at_ = 0;
        }
        const PageView<D> &page = pages_.page();
        while (at_ < page.simplices()) {
            const int s = at_++;
            if (page.is_ghost(s) || !filter_.wants(page, s)) continue;
            describe(page, s, domain_, simplex, values, vertex_values_);
            return true;
        }
        in_page_ = false;
    }
}

template class CellScan<2>;
template class CellScan<3>;

} // namespace abacus
