#include "query/check/topology_check.hpp"

#include "delaunay/cached_conflict.hpp"

namespace abacus {

template <int D>
TopologyCheck<D>::TopologyCheck(const Host &host, const abacus_facts &facts,
                                std::size_t cache_bytes, FaultList &faults)
    : is_convex_(abacus_is_convex(facts.standing) != 0),
      is_own_(abacus_is_own(facts.standing) != 0), faults_(faults),
      reader_(host, facts,
              {.budget = cache_bytes, .verify_links = true, .verify_checksums = false}),
      cache_(reader_.cache()), own_(cache_), stars_(cache_) {}

template <int D> Key TopologyCheck<D>::check_page(const Key &key) {
    const Key next = cache_.visit(key, [&](Handle h) {
        if (!cache_.is_home(h))
            faults_.add("key", "A simplex lies in a page that does not own its key.");
        check_simplex(h);
    });
    if (is_convex_)
        own_.collect(key, [&](VertexIndex v, const Arena<Handle> &star) {
            if (!stars_.add(v, star))
                faults_.add("overlap", "Simplices wind around a vertex or an edge twice.");
        });
    cache_.trim();
    cache_.poll();
    return next;
}

template <int D> void TopologyCheck<D>::check_simplex(Handle h) {
    for (int i = 0; i <= D; ++i) {
        const Link link = cache_.cross(h, i); // throws unless it leads to a true neighbour
        const Simplex<D> &neighbour = cache_.simplex(link_simplex(link));
        const VertexIndex opposite = neighbour.vertex[link_facet(link)];
        if (cache_.is_fixed(make_link(h, i))) continue;
        if (cache_.region(h) != cache_.region(link_simplex(link)))
            faults_.add("regions", "A region ends at an edge that is not fixed.");
        if (opposite == infinite_vertex || !is_own_) continue;
        check_empty_sphere(cache_.simplex(h), cache_.point(opposite));
    }
}

template <int D>
void TopologyCheck<D>::check_empty_sphere(const Simplex<D> &s, const Point<D> &opposite) {
    switch (side_of<D>(cache_, s, opposite)) {
    case Side::outside:
        break;
    case Side::vertex:
        faults_.add("vertex", "Two vertices have the same coordinates.");
        break;
    case Side::inside:
        if (s.is_ghost())
            faults_.add("hull", "The convex hull is not convex.");
        else
            faults_.add("delaunay", "A vertex lies inside a circumsphere.");
    }
}

template class TopologyCheck<2>;
template class TopologyCheck<3>;

} // namespace abacus
