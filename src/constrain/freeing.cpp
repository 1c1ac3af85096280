#include "constrain/freeing.hpp"

namespace abacus {

Freeing::Freeing(Delaunay<2> &mesh, LineSource &lines)
    : mesh_(mesh), cache_(mesh.cache()), over_(mesh, lines), to_test_(cache_.host()) {}

void Freeing::free(const Point<2> &a, const Point<2> &b) {
    for (Point<2> at = a; at != b;) {
        cache_.poll();
        at = free_edge(at, b);
        mesh_.finish(mesh_.anywhere);
    }
}

Point<2> Freeing::free_edge(const Point<2> &from, const Point<2> &b) {
    const Link corner = vertex_at(mesh_, from);
    if (corner == unset) throw_corrupted("A line names a place without a vertex.");
    const Way way = straight_on(cache_, corner, b);
    if (way.triangle == no_handle) return b;
    if (!way.is_edge) { // the edges of another line, which have been freed before
        const VertexIndex next = go_across(
            cache_, way, b, [](Link) {}, [](Handle, int, int) {});
        return next == infinite_vertex ? b : cache_.point(next);
    }
    const Point<2> end = cache_.point(cache_.simplex(way.triangle).vertex[(way.corner + 1) % 3]);
    if (!cache_.is_fixed(make_link(way.triangle, (way.corner + 2) % 3)) || over_.find(from, end))
        return end;
    const Link inner = make_link(way.triangle, (way.corner + 2) % 3),
               outer = cache_.cross(way.triangle, (way.corner + 2) % 3);
    for (const Link side : {inner, outer}) {
        cache_.set_fixed(side, false);
        cache_.mark_dirty(link_simplex(side));
    }
    add(inner);
    restore();
    return end;
}

void Freeing::add(Link side) {
    const auto &vertex = cache_.simplex(link_simplex(side)).vertex;
    const int i = link_facet(side);
    to_test_.push_back({side, vertex[(i + 1) % 3], vertex[(i + 2) % 3]});
}

bool Freeing::must_flip(const Edge &edge) {
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

void Freeing::flip(Link side) {
    const Handle t = link_simplex(side);
    const int c = link_facet(side), a = (c + 1) % 3, b = (c + 2) % 3;
    const Link beyond = cache_.cross(t, c);
    const Handle u = link_simplex(beyond);
    const int d = link_facet(beyond), beside_a = (d + 1) % 3, beside_b = (d + 2) % 3;
    // The edges around both: from c to a, a to d, d to b, b to c.
    const std::array<Link, 4> rim{cache_.cross(t, b), cache_.cross(u, beside_a),
                                  cache_.cross(u, beside_b), cache_.cross(t, a)};
    std::array<bool, 4> fixed;
    for (int i = 0; i < 4; ++i) fixed[i] = cache_.is_fixed(rim[i]);
    const std::array<VertexIndex, 3> vertex = cache_.simplex(t).vertex;
    const VertexIndex apex = cache_.simplex(u).vertex[d];
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

void Freeing::restore() {
    for (std::size_t tested = 0; !to_test_.empty(); ++tested) {
        const Edge edge = to_test_.back();
        to_test_.pop_back();
        if (must_flip(edge)) flip(edge.side);
        if (tested % 4096 == 4095) cache_.poll();
    }
}

} // namespace abacus
