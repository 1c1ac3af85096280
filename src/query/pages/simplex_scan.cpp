#include "query/pages/simplex_scan.hpp"

#include "keys/domain_of.hpp"
#include "query/pages/page_simplex.hpp"

namespace abacus {

template <int D>
SimplexScan<D>::SimplexScan(const Host &host, const abacus_facts &facts, bool ghosts)
    : domain_(domain_of<D>(facts.form)), pages_(host, facts), ghosts_(ghosts) {}

template <int D> bool SimplexScan<D>::next(abacus_simplex &simplex) {
    for (;;) {
        if (!in_page_) {
            if (!pages_.advance()) return false;
            in_page_ = true;
            at_ = 0;
        }
        const PageView<D> &page = pages_.page();
        while (at_ < page.simplices()) {
            const int s = at_++;
            if (page.is_ghost(s) && !ghosts_) continue;
            describe(page, s, domain_, simplex);
            return true;
        }
        in_page_ = false;
    }
}

template class SimplexScan<2>;
template class SimplexScan<3>;

} // namespace abacus
