#include "constrain/restoring.hpp"

namespace abacus {

void Restoring::add(Link side) {
    const auto &vertex = cache_.simplex(link_simplex(side)).vertex;
    const int i = link_facet(side);
    to_test_.push_back({side, vertex[(i + 1) % 3], vertex[(i + 2) % 3]});
}

bool Restoring::must_flip(const Edge &edge) {
    const Handle h = link_simplex(edge.side);
    const int i = link_facet(edge.side);
    if (cache_.simplex(h).is_free() || cache_.simplex(h).vertex[(i + 1) % 3] != edge.a ||
        cache_.simplex(h).vertex[(i + 2) % 3] != edge.b || cache_.simplex(h).is_ghost() ||
        cache_.is_fixed(edge.side))
        return false;
    const Link beyond = cache_.cross(h, i);
    const Simplex<2> &other = cache_.simplex(link_simplex(beyond));
    if (other.is_ghost()) return false;
    return in_sphere(cache_.corners(cache_.simplex(h)),
                     cache_.point(other.vertex[link_facet(beyond)])) > 0;
}

void Restoring::flip(Link side) {
    const Handle t = link_simplex(side);
    const int c = link_facet(side), a = (c + 1) % 3, b = (c + 2) % 3;
    const Link beyond = cache_.cross(t, c);
    const Handle u = link_simplex(beyond);
    const int d = link_facet(beyond), beside_a = (d + 1) % 3, beside_b = (d + 2) % 3;
    // The edges around both: from c to a, a to d, d to b, b to c.
    const std::array<Link, 4> rim{cache_.cross(t, b), cache_.cross(u, beside_a),
                                  cache_.cross(u, beside_b), cache_.cross(t, a)};
    std::array<Fixed, 4> fixed;
    for (int i = 0; i < 4; ++i) fixed[i] = cache_.fixed(rim[i]);
    const std::array<VertexIndex, 3> vertex = cache_.simplex(t).vertex;
    const VertexIndex apex = cache_.simplex(u).vertex[d];
    const RegionNumber region = cache_.region(t);
    for (const Handle h : {t, u}) {
        if (mesh_.log != nullptr) mesh_.log->go(cache_, h);
        cache_.destroy(h);
    }
    mesh_.forget();
    const Handle left = cache_.create({vertex[c], vertex[a], apex}),
                 right = cache_.create({apex, vertex[b], vertex[c]});
    const std::array<Link, 4> inner{make_link(left, 2), make_link(left, 0), make_link(right, 2),
                                    make_link(right, 0)};
    cache_.connect(make_link(left, 1), make_link(right, 1));
    if (region != no_region)
        for (const Handle h : {left, right}) cache_.set_region(h, region);
    for (int i = 0; i < 4; ++i) {
        cache_.connect(inner[i], rim[i]);
        cache_.set_fixed(inner[i], fixed[i]);
        cache_.mark_dirty(link_simplex(rim[i]));
    }
    for (const Handle h : {left, right})
        if (mesh_.log != nullptr) mesh_.log->come(cache_, h);
    mesh_.remember(0, left);
    mesh_.remember(1, right);
    for (const Link edge : inner) add(edge);
}

void Restoring::run() {
    for (std::size_t tested = 0; !to_test_.empty(); ++tested) {
        const Edge edge = to_test_.back();
        to_test_.pop_back();
        if (must_flip(edge)) flip(edge.side);
        if (tested % 4096 == 4095) cache_.poll();
    }
}

void Restoring::restore(const Point<2> &a, const Point<2> &b) {
    const Way way = straight_on(cache_, vertex_at(mesh_, a), b);
    if (way.is_edge &&
        cache_.point(cache_.simplex(way.triangle).vertex[(way.corner + 1) % 3]) == b) {
        add(make_link(way.triangle, (way.corner + 2) % 3));
        run();
    }
    mesh_.finish(mesh_.anywhere);
}

} // namespace abacus
