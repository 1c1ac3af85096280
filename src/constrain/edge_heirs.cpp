#include "constrain/edge_heirs.hpp"

#include "geometry/ordered.hpp"
#include "traverse/straight.hpp"

#include <algorithm>
#include <bit>

namespace abacus {

EdgeHeirs::EdgeHeirs(Delaunay<2> &mesh, std::size_t memory)
    : mesh_(mesh), sort_(mesh.cache().host(), words, key_words, memory) {}

void EdgeHeirs::add(const Point<2> &a, const Point<2> &b, double marker) {
    const Edge old = a < b ? Edge{a, b} : Edge{b, a};
    mesh_.cache().poll();
    if (mesh_.simplices() > 0 && !walk(old.from, old.to, {old, marker}))
        walk(old.to, old.from, {old, marker});
    mesh_.finish(mesh_.anywhere);
}

bool EdgeHeirs::walk(const Point<2> &from, const Point<2> &to, const Legacy &legacy) {
    Cache<2> &cache = mesh_.cache();
    const Handle first = mesh_.locate(from, cache.domain().code(from), mesh_.any_recent());
    std::optional<Point<2>> at = pass_through(first, from, to, legacy);
    if (!at && cache.simplex(first).is_ghost()) return false;
    while (at && is_same_way(to, from, *at)) {
        const Way way = straight_on(cache, vertex_at(mesh_, *at), to);
        if (way.triangle == no_handle) break; // it leaves the hull
        if (!way.is_edge) {
            at = vertex_ahead(way.triangle, *at, to);
            continue;
        }
        const Point<2> end = cache.point(cache.simplex(way.triangle).vertex[(way.corner + 1) % 3]);
        if (cache.is_fixed(make_link(way.triangle, (way.corner + 2) % 3))) note(*at, end, legacy);
        at = end;
    }
    return true;
}

std::optional<Point<2>> EdgeHeirs::pass_through(Handle h, const Point<2> &from, const Point<2> &to,
                                                const Legacy &legacy) {
    Cache<2> &cache = mesh_.cache();
    const auto &vertex = cache.simplex(h).vertex;
    for (int i = 0; i < 3; ++i) { // a ghost has an edge of the hull
        if (vertex[i] != infinite_vertex && cache.point(vertex[i]) == from) return from;
        const VertexIndex a = vertex[(i + 1) % 3], b = vertex[(i + 2) % 3];
        if (a == infinite_vertex || b == infinite_vertex) continue;
        const Point<2> &v = cache.point(a), &w = cache.point(b);
        if (!(std::min(v, w) < from && from < std::max(v, w))) continue;
        if (orientation(v, w, from) != 0 || orientation(v, w, to) != 0) continue;
        if (cache.is_fixed(make_link(h, i))) note(v, w, legacy);
        return is_same_way(from, to, v) ? v : w;
    }
    return vertex_ahead(h, from, to);
}

std::optional<Point<2>> EdgeHeirs::vertex_ahead(Handle h, const Point<2> &from,
                                                const Point<2> &to) {
    Cache<2> &cache = mesh_.cache();
    for (std::size_t crossed = 1; !cache.simplex(h).is_ghost(); ++crossed) {
        const auto &vertex = cache.simplex(h).vertex;
        std::array<int, 3> side;
        for (int i = 0; i < 3; ++i) {
            const Point<2> &v = cache.point(vertex[i]);
            side[i] = orientation(from, to, v);
            if (side[i] == 0 && is_same_way(from, to, v)) return v;
        }
        int out = 0; // the edge from a corner right of the way to one left of it
        while (out < 3 && !(side[(out + 1) % 3] < 0 && side[(out + 2) % 3] > 0)) ++out;
        if (out == 3 || orientation(cache.point(vertex[(out + 1) % 3]),
                                    cache.point(vertex[(out + 2) % 3]), to) >= 0)
            break; // the way ends before it
        h = link_simplex(cache.cross(h, out));
        if (crossed % 4096 == 0) cache.poll();
    }
    return {};
}

void EdgeHeirs::note(const Point<2> &v, const Point<2> &w, const Legacy &legacy) {
    const Edge heir = v < w ? Edge{v, w} : Edge{w, v}, &old = legacy.old;
    if (heir == old) return;
    std::uint64_t *const record = sort_.add();
    put_ordered(record, heir.from);
    put_ordered(record + 2, heir.to);
    put_ordered(record + edge_words, old.from);
    put_ordered(record + edge_words + 2, old.to);
    record[2 * edge_words] = std::bit_cast<std::uint64_t>(legacy.marker);
}

void EdgeHeirs::each(const std::function<void(const Point<2> &, const Point<2> &, double)> &visit) {
    sort_.finish();
    Edge heir{};
    Point<2> reached{}; // the heir is covered up to here
    double marker = 0;
    bool is_any = false, is_same = false;
    const auto end = [&] {
        if (is_any && is_same && !(reached < heir.to)) visit(heir.from, heir.to, marker);
    };
    while (const std::uint64_t *const record = sort_.next()) {
        const Edge of{point_from_ordered<2>(record), point_from_ordered<2>(record + 2)};
        const Edge old{point_from_ordered<2>(record + edge_words),
                       point_from_ordered<2>(record + edge_words + 2)};
        const double value = std::bit_cast<double>(record[2 * edge_words]);
        if (!is_any || of != heir) {
            end();
            heir = of;
            reached = of.from;
            marker = value;
            is_any = is_same = true;
        }
        is_same = is_same && value == marker && !(reached < old.from);
        reached = std::max(reached, old.to);
    }
    end();
    sort_.close();
}

} // namespace abacus
