// The box around a mesh, by a walk around its hull.
#pragma once

#include "query/locate/hull_ghost.hpp"
#include "query/pages/page_flood.hpp"

#include <limits>

namespace abacus {

/// A box that contains the whole mesh. It is infinite if the mesh is not convex, so that all
/// pages would have to be read, or if its hull lies on a great many pages.
template <int D>
Box<D> hull_box(const Host &host, const abacus_facts &facts, std::size_t cache_bytes) {
    constexpr int most_pages = 512;
    Box<D> everywhere;
    everywhere.lower.fill(-std::numeric_limits<double>::infinity());
    everywhere.upper.fill(std::numeric_limits<double>::infinity());
    Reader<D> reader(host, facts, cache_bytes);
    if (!reader.is_convex()) return everywhere;
    Box<D> box;
    if (reader.is_empty()) return box;
    PageFlood<D> flood(host, facts);
    flood.reach(reader.cache().lower(hull_ghost<D>(reader)));
    for (int pages = 0; flood.advance(); ++pages) {
        if (pages == most_pages) return everywhere;
        const PageView<D> &page = flood.page();
        for (int s = 0; s < page.simplices(); ++s)
            for (int i = 0; page.is_ghost(s) && i < D; ++i)
                box.extend(page.point(page.corner(s, i)));
        flood.spread([&](int s, int facet) { return facet < D && page.is_ghost(s); });
    }
    return box;
}

} // namespace abacus
