#include "constrain/edge_heirs.hpp"

#include "geometry/ordered.hpp"
#include "traverse/straight.hpp"

#include <bit>

namespace abacus {

EdgeHeirs::EdgeHeirs(Delaunay<2> &mesh, std::size_t memory)
    : mesh_(mesh), sort_(mesh.cache().host(), words, key_words, memory) {}

void EdgeHeirs::add(const Point<2> &a, const Point<2> &b, double marker) {
    const Edge old = a < b ? Edge{a, b} : Edge{b, a};
    mesh_.cache().poll();
    std::optional<Edge> edge = edge_through(old.from, old.to);
    if (!edge) edge = edge_from(old.from, old.to);
    while (edge) {
        if (*edge != old) note(*edge, old, marker);
        if (!(edge->to < old.to)) break;
        edge = edge_from(edge->to, old.to);
    }
    mesh_.finish(mesh_.anywhere);
}

std::optional<EdgeHeirs::Edge> EdgeHeirs::edge_through(const Point<2> &a, const Point<2> &b) {
    Cache<2> &cache = mesh_.cache();
    if (mesh_.simplices() == 0) return {};
    const Handle h = mesh_.locate(a, cache.domain().code(a), mesh_.any_recent());
    for (int i = 0; i < 3; ++i) {
        const auto &vertex = cache.simplex(h).vertex;
        const VertexIndex v = vertex[(i + 1) % 3], w = vertex[(i + 2) % 3];
        if (v == infinite_vertex || w == infinite_vertex || !cache.is_fixed(make_link(h, i)))
            continue;
        const auto [from, to] = std::minmax(cache.point(v), cache.point(w));
        const Edge edge{from, to};
        if (edge.from < a && a < edge.to && orientation(edge.from, edge.to, a) == 0 &&
            orientation(edge.from, edge.to, b) == 0)
            return edge;
    }
    return {};
}

std::optional<EdgeHeirs::Edge> EdgeHeirs::edge_from(const Point<2> &at, const Point<2> &b) {
    Cache<2> &cache = mesh_.cache();
    const Link corner = vertex_at(mesh_, at);
    if (corner == unset) return {};
    const Way way = straight_on(cache, corner, b);
    if (!way.is_edge || !cache.is_fixed(make_link(way.triangle, (way.corner + 2) % 3))) return {};
    return Edge{at, cache.point(cache.simplex(way.triangle).vertex[(way.corner + 1) % 3])};
}

void EdgeHeirs::note(const Edge &heir, const Edge &old, double marker) {
    std::uint64_t *const record = sort_.add();
    put_ordered(record, heir.from);
    put_ordered(record + 2, heir.to);
    put_ordered(record + edge_words, old.from);
    put_ordered(record + edge_words + 2, old.to);
    record[2 * edge_words] = std::bit_cast<std::uint64_t>(marker);
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
