#include "constrain/freeing.hpp"

#include <algorithm>

namespace abacus {

Freeing::Freeing(Delaunay<2> &mesh, LineSource &lines)
    : mesh_(mesh), cache_(mesh.cache()), over_(mesh, lines), restoring_(mesh) {}

RegionNumber Freeing::free(const Point<2> &a, const Point<2> &b) {
    ending_ = no_region;
    for (Point<2> at = a; at != b && ending_ == no_region;) {
        cache_.poll();
        at = free_edge(at, b);
        mesh_.finish(mesh_.anywhere);
    }
    return ending_;
}

Point<2> Freeing::free_edge(const Point<2> &from, const Point<2> &b) {
    const Link corner = vertex_at(mesh_, from);
    if (corner == unset) throw_corrupted("A line names a place without a vertex.");
    const Way way = straight_on(cache_, corner, b);
    if (way.triangle == no_handle) return b;
    if (!way.is_edge) { // the edges of another line, which have been freed before
        const VertexIndex next = go_across(
            cache_, way, b, [](Link) { return true; }, [](Handle, int, int) {});
        return next == infinite_vertex ? b : cache_.point(next);
    }
    const Point<2> end = cache_.point(cache_.simplex(way.triangle).vertex[(way.corner + 1) % 3]);
    const Link inner = make_link(way.triangle, (way.corner + 2) % 3);
    const Fixed how = cache_.fixed(inner);
    if (how == Fixed::no) return end;
    const Fixed left = over_.kind(from, end);
    if (left == how) return end;
    const Link outer = cache_.cross(link_simplex(inner), link_facet(inner));
    const RegionNumber here = cache_.region(link_simplex(inner)),
                       there = cache_.region(link_simplex(outer));
    if (left == Fixed::no && here != there) {
        ending_ = std::max(here, there);
        return end;
    }
    for (const Link side : {inner, outer}) {
        cache_.set_fixed(side, left);
        cache_.mark_dirty(link_simplex(side));
    }
    if (left != Fixed::no) return end;
    restoring_.add(inner);
    restoring_.run();
    return end;
}

} // namespace abacus
