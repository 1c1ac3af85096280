#include "query/shapes/border.hpp"

namespace abacus {

Border::Edge Border::edge(Handle h, int facet) const {
    const Simplex<2> &s = cache_.simplex(h);
    return {cache_.point(s.vertex[(facet + 1) % 3]), cache_.point(s.vertex[(facet + 2) % 3]),
            cache_.lower(h), h, facet};
}

Border::Edge Border::turn(const Edge &edge, bool is_forward) {
    if (++steps_ % 1024 == 0) cache_.poll();
    Handle at = edge.triangle;
    const int pivot = (edge.facet + (is_forward ? 2 : 1)) % 3;
    const VertexIndex v = cache_.simplex(at).vertex[pivot];
    int facet = 3 - edge.facet - pivot; // the other facet at the vertex
    for (std::uint64_t turns = 1;; ++turns) {
        if (turns % 1024 == 0) cache_.poll();
        const Link beyond = cache_.cross(at, facet);
        if (!is_kept(link_simplex(beyond))) break;
        at = link_simplex(beyond);
        facet = 3 - link_facet(beyond) - cache_.simplex(at).index_of(v);
    }
    return this->edge(at, facet);
}

void Border::find(Edge &edge) {
    const auto is_it = [&](Handle h, int facet) {
        const Edge other = this->edge(h, facet);
        return other.is(edge);
    };
    if (cache_.is_live(edge.triangle) && !cache_.simplex(edge.triangle).is_ghost() &&
        is_it(edge.triangle, edge.facet))
        return;
    bool is_found = false;
    cache_.visit(edge.page, [&](Handle h) {
        if (is_found || cache_.simplex(h).is_ghost()) return;
        for (int facet = 0; facet < 3 && !is_found; ++facet) {
            if (!is_it(h, facet)) continue;
            is_found = true;
            edge.triangle = h;
            edge.facet = facet;
        }
    });
    if (!is_found) throw_corrupted("A page has lost a triangle.");
}

bool Border::is_first_of_ring(Edge edge) {
    Edge ahead = edge, behind = edge;
    for (;;) {
        ahead = next(ahead);
        if (ahead.is(behind)) return true;
        if (ahead.comes_before(edge)) return false;
        behind = before(behind);
        if (ahead.is(behind)) return true;
        if (behind.comes_before(edge)) return false;
        make_room<2>({&ahead, &behind});
    }
}

} // namespace abacus
