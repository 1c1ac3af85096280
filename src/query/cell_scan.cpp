#include "query/cell_scan.hpp"

#include "keys/domain_of.hpp"
#include "query/page_simplex.hpp"

namespace abacus {

template <int D>
CellScan<D>::CellScan(const Host &host, const abacus_header &header, const abacus_window &window,
                      double max_edge)
    : domain_(domain_of<D>(header)), max_edge_(max_edge), window_(window),
      pages_(host, header, window_.region()) {}

template <int D> bool CellScan<D>::is_wanted(int simplex) const {
    const PageView<D> &page = pages_.page();
    if (page.is_ghost(simplex)) return false;
    const Corners<D> corners = corners_of(page, simplex);
    if (!window_.meets(corners)) return false;
    for (int i = 0; max_edge_ > 0 && i <= D; ++i)
        for (int j = 0; j < i; ++j)
            if (!is_within<D>(max_edge_, *corners[i], *corners[j])) return false;
    return true;
}

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
            if (!is_wanted(s)) continue;
            describe(page, s, domain_, simplex, values);
            return true;
        }
        in_page_ = false;
    }
}

template class CellScan<2>;
template class CellScan<3>;

} // namespace abacus
