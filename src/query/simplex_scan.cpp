#include "query/simplex_scan.hpp"

#include "cache/domain_of.hpp"
#include "query/describe.hpp"

namespace abacus {

template <int D>
SimplexScan<D>::SimplexScan(const Host &host, const abacus_header &header, bool ghosts)
    : domain_(domain_of<D>(header)), pages_(host, header.attributes), ghosts_(ghosts) {}

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
            const bool ghost = page.is_ghost(s);
            if (ghost && !ghosts_) continue;
            std::array<Point<D>, D + 1> points;
            std::uint64_t code = 0;
            for (int i = 0; i < D + !ghost; ++i) {
                points[i] = page.point(page.corner(s, i));
                code = std::max(code, domain_.code(points[i]));
            }
            SimplexWriter<D> writer(simplex, code, ghost);
            for (int i = 0; i < D + !ghost; ++i)
                writer.corner(i, page.id(page.corner(s, i)), points[i]);
            writer.finish();
            return true;
        }
        in_page_ = false;
    }
}

template class SimplexScan<2>;
template class SimplexScan<3>;

} // namespace abacus
