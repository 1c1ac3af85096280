#include "traverse/faces.hpp"

#include "geometry/predicates.hpp"
#include "traverse/straight.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace abacus {

namespace {

/// A place straight on towards lesser x.
Point<2> lesser(const Point<2> &p) {
    const double x = p[0] - 1;
    return {x < p[0] ? x : std::nextafter(p[0], -std::numeric_limits<double>::infinity()), p[1]};
}

} // namespace

Faces::Faces(Cache<2> &cache, Access access)
    : cache_(cache), access_(std::move(access)), known_(cache.host()), names_(cache.host()),
      passed_(cache.host()) {}

void Faces::clear() {
    known_.clear();
    names_.clear();
}

void Faces::sort() {
    std::sort(known_.begin(), known_.end(),
              [](const Known &a, const Known &b) { return a.edge < b.edge; });
    const auto is_same = [](const Known &a, const Known &b) { return a.edge == b.edge; };
    known_.resize(std::unique(known_.begin(), known_.end(), is_same) - known_.begin());
}

Faces::Known *Faces::known(const Edge &edge) {
    Known *const at = std::lower_bound(known_.begin(), known_.end(), edge,
                                       [](const Known &a, const Edge &b) { return a.edge < b; });
    return at != known_.end() && at->edge == edge ? at : nullptr;
}

Faces::Edge Faces::edge_of(Link edge) const {
    const auto &vertex = cache_.simplex(link_simplex(edge)).vertex;
    return {cache_.point(vertex[(link_facet(edge) + 1) % 3]),
            cache_.point(vertex[(link_facet(edge) + 2) % 3])};
}

Link Faces::find(const Edge &edge) {
    const Way way = straight_on(cache_, access_.corner_at(edge.from), edge.to);
    const Link found = make_link(way.triangle, (way.corner + 2) % 3);
    if (!way.is_edge || !(edge_of(found).to == edge.to))
        throw_corrupted("A fixed edge is missing.");
    return found;
}

void Faces::rest(Link &edge) {
    const Edge at = edge_of(edge);
    cache_.poll();
    access_.trim();
    edge = find(at);
}

std::optional<Link> Faces::turn(Link edge) {
    const Handle first = link_simplex(edge);
    while (!cache_.is_fixed(edge)) {
        const Link beyond = cache_.cross(link_simplex(edge), link_facet(edge));
        if (cache_.simplex(link_simplex(beyond)).is_ghost()) return {};
        if (link_simplex(beyond) == first) return unset;
        edge = make_link(link_simplex(beyond), (link_facet(beyond) + 1) % 3);
        if (step()) cache_.poll();
    }
    return edge;
}

std::optional<Faces::Walked> Faces::walk(const Edge &begin) {
    Walked walked{begin};
    Edge edge = begin;
    Link at = find(begin);
    do {
        if (Known *const passed = known(edge)) {
            if (passed->name != unknown) walked.name = passed->name;
            passed_.push_back(static_cast<std::size_t>(passed - known_.begin()));
        }
        const auto next = turn(make_link(link_simplex(at), (link_facet(at) + 1) % 3));
        if (!next) return {};
        at = *next;
        if (step()) rest(at);
        const Point<2> before = edge.from;
        edge = edge_of(at);
        if (edge.from < walked.least.from) walked.is_inner = false;
        walked.least = std::min(walked.least, edge);
        if (edge.from == walked.least.from &&
            (edge.to == before || orientation(edge.from, edge.to, before) < 0))
            walked.is_inner = true;
    } while (!(edge == begin));
    return walked;
}

Faces::Met Faces::cross(Link edge, const Point<2> &from, const Point<2> &to) {
    while (!cache_.is_fixed(edge)) {
        if (step()) rest(edge);
        const Link beyond = cache_.cross(link_simplex(edge), link_facet(edge));
        const Handle h = link_simplex(beyond);
        const int apex = link_facet(beyond);
        if (cache_.simplex(h).is_ghost()) return {};
        const int side = orientation(from, to, cache_.point(cache_.simplex(h).vertex[apex]));
        if (side == 0) return {beyond, false};
        edge = make_link(h, (apex + (side > 0 ? 1 : 2)) % 3);
    }
    return {edge, true};
}

std::optional<Link> Faces::straight_to_lesser(Point<2> at) {
    for (;;) {
        const Point<2> to = lesser(at);
        const Way way = straight_on(cache_, access_.corner_at(at), to);
        if (way.triangle == no_handle) return {};
        Met met{make_link(way.triangle, (way.corner + 1) % 3), false};
        if (!way.is_edge) met = cross(make_link(way.triangle, way.corner), at, to);
        if (met.link == unset) return {};
        if (met.is_edge) return met.link;
        const auto border = border_at(met.link);
        if (!border || *border != unset) return border;
        at = cache_.point(cache_.simplex(link_simplex(met.link)).vertex[link_facet(met.link)]);
        access_.trim();
    }
}

std::optional<Faces::Edge> Faces::end(std::uint32_t name) {
    for (const std::size_t i : passed_) known_[i].name = name;
    return names_[name];
}

std::optional<Faces::Edge> Faces::name(const Edge &edge) {
    passed_.clear();
    for (Edge begin = edge;;) {
        const Known *const at = known(begin);
        if (at != nullptr && at->name != unknown) return end(at->name);
        const auto walked = walk(begin);
        if (!walked) return {};
        if (walked->name != unknown) return end(walked->name);
        if (!walked->is_inner) {
            names_.push_back(walked->least);
            return end(static_cast<std::uint32_t>(names_.size() - 1));
        }
        const auto next = straight_to_lesser(walked->least.from);
        if (!next) return {};
        begin = edge_of(*next);
        access_.trim();
    }
}

std::optional<Faces::Edge> Faces::name(Handle triangle) {
    auto border = border_at(make_link(triangle, 0));
    if (border && *border == unset)
        border = straight_to_lesser(cache_.point(cache_.simplex(triangle).vertex[0]));
    if (!border) return {};
    return name(edge_of(*border));
}

} // namespace abacus
