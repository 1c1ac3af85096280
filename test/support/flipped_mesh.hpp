// A mesh that fills its convex hull but is not Delaunay, as one with fixed edges is.
#pragma once

#include "geometry/predicates.hpp"
#include "query/locate/reader.hpp"
#include "support/oracle.hpp"
#include "support/point_sets.hpp"

namespace abacus::test {

/// Flips edges of a stored mesh, drawn with the seed, where two triangles make a convex
/// quadrilateral. Returns how many.
inline int flip_edges(Mesh &mesh, int draws, unsigned seed) {
    const Host host = mesh.host.host();
    Reader<2> reader(host, mesh.header.facts, std::size_t{64} << 20);
    Cache<2> &cache = reader.cache();
    const abacus_form &form = mesh.header.facts.form;
    Random random(seed);
    int flips = 0;
    for (int draw = 0; draw < draws; ++draw) {
        Point<2> p;
        for (int i = 0; i < 2; ++i)
            p[i] = form.lower[i] + unit(random) * (form.upper[i] - form.lower[i]);
        const Handle h = reader.simplex_around(p);
        if (cache.simplex(h).is_ghost()) continue;
        const int at_p = static_cast<int>(random() % 3);
        const Link beyond = cache.cross(h, at_p);
        const Handle other = link_simplex(beyond);
        const int at_q = link_facet(beyond);
        const Simplex<2> s = cache.simplex(h), t = cache.simplex(other);
        if (t.is_ghost()) continue;
        const VertexIndex apex = s.vertex[at_p], a = s.vertex[(at_p + 1) % 3],
                          b = s.vertex[(at_p + 2) % 3], q = t.vertex[at_q];
        const auto &point = [&](VertexIndex v) -> const Point<2> & { return cache.point(v); };
        if (orientation(point(apex), point(a), point(q)) <= 0 ||
            orientation(point(apex), point(q), point(b)) <= 0)
            continue;
        const Link beside_a = cache.cross(h, (at_p + 2) % 3), // across the edge from p to a
            beside_b = cache.cross(h, (at_p + 1) % 3),
                   behind_a = cache.cross(other, t.index_of(b)), // ... from q to a
            behind_b = cache.cross(other, t.index_of(a));
        for (const Link outer : {beside_a, beside_b, behind_a, behind_b})
            cache.mark_dirty(link_simplex(outer));
        const Handle at_a = cache.create({apex, a, q}), at_b = cache.create({apex, q, b});
        cache.destroy(h);
        cache.destroy(other);
        cache.connect(make_link(at_a, 0), behind_a);
        cache.connect(make_link(at_a, 1), make_link(at_b, 2));
        cache.connect(make_link(at_a, 2), beside_a);
        cache.connect(make_link(at_b, 0), behind_b);
        cache.connect(make_link(at_b, 1), beside_b);
        cache.settle(0);
        ++flips;
    }
    cache.flush();
    return flips;
}

/// From now on a mesh is read as one with a line, whatever its edges are.
inline void call_constrained(Mesh &mesh) {
    mesh.header.facts.standing = ABACUS_CONSTRAINED;
    mesh.header.facts.census.lines = 1;
}

} // namespace abacus::test
