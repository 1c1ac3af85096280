#include "query/check/page_check.hpp"

#include "geometry/flatness.hpp"
#include "query/pages/page_simplex.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace abacus {

template <int D>
bool PageCheck<D>::read(const unsigned char *bytes, std::size_t size, int attributes) {
    bool is_read = false;
    faults_.run("page", [&] {
        page_.read(bytes, size, attributes, PageView<D>::Checksum::ignore);
        if (!page_is_sealed(bytes, size))
            faults_.add_of_content("checksum", "A page has been changed since it was written.");
        is_read = true;
    });
    if (!is_read) return false;
    if (!(page_.lower() == faults_.at))
        faults_.add("interval", "A page is stored under another page's key.");
    return true;
}

template <int D> void PageCheck<D>::check() {
    counts_.vertices += static_cast<std::uint64_t>(page_.vertices());
    check_simplices();
    for (int patch = 0; patch < page_.patches(); ++patch) check_box(patch);
    bool has_parts = false;
    for (int i = 0; i < page_.links(); ++i) has_parts = has_parts || page_.link_part(i) != 0;
    if (page_.has_parts() && !has_parts)
        faults_.add("link", "A page has room for parts of keys, but contains none.");
}

template <int D> void PageCheck<D>::check_simplices() {
    for (int s = 0; s < page_.simplices(); ++s) {
        const bool ghost = page_.is_ghost(s);
        ++(ghost ? counts_.ghosts : counts_.simplices);
        counts_.fixed += static_cast<unsigned>(page_.fixed(s).count());
        counts_.soft += static_cast<unsigned>(page_.fixed(s).count_soft());
        const std::uint64_t code = code_of(page_, s, domain_);
        // Parts are compared by the topology pass, which has to compute them.
        const Key lowest{code, 0}, highest{code, key_word_end - 1};
        if (highest < page_.lower() || page_.upper() <= lowest)
            faults_.add("key", "A simplex lies in a page that does not own its key.");
        if (ghost) continue;
        const Corners<D> corners = corners_of(page_, s);
        if (orientation<D>(corners) <= 0)
            faults_.add("orientation", "A simplex is flat or negatively oriented.");
        counts_.flat += is_flat_in_doubles<D>(corners);
    }
}

template <int D> void PageCheck<D>::check_box(int patch) {
    const auto simplices = page_.simplices_of(patch);
    for (int axis = 0; axis < D; ++axis) {
        Column::Prefix least = std::numeric_limits<Column::Prefix>::max(), greatest = -1;
        for (int s = simplices.begin; s < simplices.end; ++s)
            for (int i = 0; i < D + !page_.is_ghost(s); ++i) {
                const auto vertex = static_cast<std::size_t>(page_.corner(s, i));
                const Column::Prefix prefix = page_.ranks(axis).prefix_at(vertex);
                least = std::min(least, prefix);
                greatest = std::max(greatest, prefix);
            }
        if (page_.patch(patch).least[axis] != least ||
            page_.patch(patch).greatest[axis] != greatest)
            faults_.add_of_content("page",
                                   "The box of a patch of simplices is not that of its vertices.");
    }
}

template class PageCheck<2>;
template class PageCheck<3>;

} // namespace abacus
