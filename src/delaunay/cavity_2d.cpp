#include "delaunay/cavity.hpp"
#include "delaunay/conflict.hpp"

#include <algorithm>

namespace abacus {

Cavity<2>::Cavity(Delaunay<2> &mesh)
    : CavityInside(mesh), stack_(cache_.host()), rim_(cache_.host()), created_(cache_.host()) {}

void Cavity<2>::find(const Point<2> &p, Handle first) {
    inside_.clear();
    rim_.clear();
    add(first);
    // The edges opposite the corners 0, 1, 2 in turn, from the top; at the bottom, where the
    // last one ends.
    stack_.clear();
    Edge *top = stack_.extend(4);
    for (int i = 3; i >= 0; --i, ++top) {
        const VertexIndex v = cache_.simplex(first).vertex[(i + 1) % 3];
        const SeenPoint<2> begin = seen(cache_.point(v), p);
        *top = {begin, i == 3 ? 0 : cross(begin, top[-1].begin), v, make_link(first, i)};
    }
    --top;
    while (top != stack_.data()) {
        // The inner side is kept and the outer one asked for anew, since loading for an
        // earlier edge may have linked it.
        const Link outer = cache_.cross(link_simplex(top->inner), link_facet(top->inner));
        const Handle h = link_simplex(outer);
        const int facet = link_facet(outer);
        const VertexIndex apex = cache_.simplex(h).vertex[facet];
        const SeenPoint<2> point = seen(cache_.point(apex), p);
        const InCircle test = in_circle(top->begin, top[-1].begin, top->cross, point);
        const bool is_inside = test.is_sure ? test.is_inside : is_exactly_inside(h, p);
        if (is_inside) {
            add(h);
            const int next = facet == 2 ? 0 : facet + 1, last = 3 - facet - next;
            if (top + 2 > stack_.data() + stack_.capacity()) [[unlikely]] top = deepen(top);
            top[1] = {top->begin, test.cross_ac, top->vertex, make_link(h, next)};
            top[0] = {point, test.cross_cb, apex, make_link(h, last)};
            ++top;
        } else {
            rim_.push_back({top->vertex, outer});
            --top;
        }
    }
}

bool Cavity<2>::is_exactly_inside(Handle h, const Point<2> &p) const {
    return side_of<2>(cache_, cache_.simplex(h), p) == Side::inside;
}

Cavity<2>::Edge *Cavity<2>::deepen(const Edge *top) {
    const std::size_t depth = top - stack_.data();
    stack_.reserve(2 * stack_.capacity());
    return stack_.data() + depth;
}

void Cavity<2>::fill(VertexIndex v) {
    const std::int64_t ghosts = hollow_out();
    const std::size_t n = rim_.size();
    rim_.push_back(rim_[0]); // closes the cycle
    created_.resize(n + 1);
    allot(cache_.vertices()[v].code);
    cache_.acquire(v, static_cast<std::uint32_t>(n));
    std::int64_t new_ghosts = 0;
    Link previous = make_link(created_[n - 1], 0);
    for (std::size_t i = 0; i < n; ++i) {
        const VertexIndex begin = rim_[i].begin, end = rim_[i + 1].begin;
        const Link outer = rim_[i].outer;
        const Handle h = created_[i];
        cache_.set(h, {{begin, end, v}, {make_link(created_[i + 1], 1), previous, outer}});
        previous = make_link(h, 0);
        cache_.point_at(outer, make_link(h, 2));
        cache_.mark_dirty(link_simplex(outer));
        mesh_.remember(i, h);
        new_ghosts += begin == infinite_vertex || end == infinite_vertex;
    }
    if (new_ghosts > 0) [[unlikely]]
        for (std::size_t i = 0; i < n; ++i) bring_infinity_last(created_[i]);
    mesh_.count(static_cast<std::int64_t>(n - inside_.size()) - (new_ghosts - ghosts),
                new_ghosts - ghosts);
}

void Cavity<2>::bring_infinity_last(Handle h) {
    Simplex<2> s = cache_.simplex(h);
    for (int i = 0; i < 2; ++i) {
        if (s.vertex[i] != infinite_vertex) continue;
        std::rotate(s.vertex.begin(), s.vertex.begin() + i + 1, s.vertex.end());
        std::rotate(s.link.begin(), s.link.begin() + i + 1, s.link.end());
        cache_.set(h, s);
        for (int k = 0; k < 3; ++k) cache_.point_at(s.link[k], make_link(h, k));
        return;
    }
}

void Cavity<2>::allot(std::uint64_t code) {
    Handle *h = created_.data();
    std::uint64_t begin_code = cache_.vertices()[rim_[0].begin].code;
    for (std::size_t i = 0, n = rim_.size() - 1; i < n; ++i) {
        const VertexIndex end = rim_[i + 1].begin;
        const std::uint64_t end_code = cache_.vertices()[end].code;
        cache_.acquire(end, 2);
        *h++ = cache_.allot(std::max({code, begin_code, end_code}));
        begin_code = end_code;
    }
    *h = created_[0];
}

} // namespace abacus
