#include "delaunay/cached_conflict.hpp"
#include "delaunay/cavity.hpp"

#include <algorithm>

namespace abacus {

Cavity<2>::Cavity(Delaunay<2> &mesh)
    : CavityInside(mesh), stack_(cache_.host()), rim_(cache_.host()), created_(cache_.host()),
      regions_(cache_.host()) {}

void Cavity<2>::find(const Point<2> &p, Handle first) {
    if (mesh_.is_constrained)
        search<true>(p, first);
    else
        search<false>(p, first);
}

template <bool is_constrained> void Cavity<2>::search(const Point<2> &p, Handle first) {
    split_.fill(free_mark);
    inside_.clear();
    rim_.clear();
    add(first);
    // The edges opposite the corners 0, 1, 2 from the top down. The bottom of the stack has the
    // vertex at which the last edge ends.
    stack_.clear();
    Edge *const bottom = stack_.extend(4), *top = bottom;
    for (int i = 3; i >= 0; --i, ++top) {
        top->vertex = cache_.simplex(first).vertex[(i + 1) % 3];
        top->begin = seen(cache_.point(top->vertex), p);
        top->cross = i == 3 ? 0 : cross(top->begin, top[-1].begin);
    }
    for (int i = 0; i < 3; ++i)
        look_beyond<is_constrained>(bottom[3 - i], make_link(first, i), bottom[2 - i].begin, p);
    --top;
    while (top != stack_.data()) {
        const Link outer = top->outer;
        if (!top->is_inside) {
            rim_.push_back({top->vertex, outer});
            --top;
            continue;
        }
        const Handle h = link_simplex(outer);
        const int facet = link_facet(outer);
        const int next = facet == 2 ? 0 : facet + 1, last = 3 - facet - next;
        add(h);
        if (top + 2 > stack_.data() + stack_.capacity()) [[unlikely]]
            top = deepen(top);
        top[1].begin = top->begin;
        top[1].cross = top->cross_ac;
        top[1].vertex = top->vertex;
        top[0].begin = top->apex;
        top[0].cross = top->cross_cb;
        top[0].vertex = cache_.simplex(h).vertex[facet];
        // The two calls do not wait for each other, and their results are ready when they are
        // needed.
        look_beyond<is_constrained>(top[1], make_link(h, next), top[0].begin, p);
        look_beyond<is_constrained>(top[0], make_link(h, last), top[-1].begin, p);
        ++top;
    }
}

template <bool is_constrained>
inline void Cavity<2>::look_beyond(Edge &edge, Link inner, const SeenPoint<2> &end,
                                   const Point<2> &p) {
    edge.outer = cache_.cross(link_simplex(inner), link_facet(inner));
    const Handle h = link_simplex(edge.outer);
    edge.apex = seen(cache_.point(cache_.simplex(h).vertex[link_facet(edge.outer)]), p);
    const InCircle test = in_circle(edge.begin, end, edge.cross, edge.apex);
    edge.cross_ac = test.cross_ac;
    edge.cross_cb = test.cross_cb;
    edge.is_inside = test.is_sure ? test.is_inside : is_exactly_inside(h, p);
    if constexpr (is_constrained)
        if (edge.is_inside && cache_.is_fixed(edge.outer)) edge.is_inside = splits(edge.outer, p);
}

bool Cavity<2>::splits(Link edge, const Point<2> &p) {
    const auto &vertex = cache_.simplex(link_simplex(edge)).vertex;
    const std::array<VertexIndex, 2> ends{vertex[(link_facet(edge) + 1) % 3],
                                          vertex[(link_facet(edge) + 2) % 3]};
    if (orientation(cache_.point(ends[0]), cache_.point(ends[1]), p) != 0) return false;
    split_ = ends;
    split_kind_ = cache_.fixed(edge);
    return true;
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
    if (mesh_.is_constrained) [[unlikely]]
        note_regions();
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
    if (mesh_.is_constrained) [[unlikely]]
        fix_edges();
    if (new_ghosts > 0) [[unlikely]]
        for (std::size_t i = 0; i < n; ++i) bring_infinity_last(created_[i]);
    mesh_.count(static_cast<std::int64_t>(n - inside_.size()) - (new_ghosts - ghosts),
                new_ghosts - ghosts);
    log_created(created_, n);
}

void Cavity<2>::note_regions() {
    regions_.clear();
    for (const RimEdge &edge : rim_) {
        const Link inner = cache_.simplex(link_simplex(edge.outer)).link[link_facet(edge.outer)];
        regions_.push_back(cache_.region(link_simplex(inner)));
    }
}

void Cavity<2>::fix_edges() {
    Handle previous = created_[created_.size() - 2];
    for (std::size_t i = 0; i + 1 < created_.size(); ++i) {
        const Handle h = created_[i];
        if (regions_[i] != no_region) cache_.set_region(h, regions_[i]);
        if (const Fixed how = cache_.fixed(rim_[i].outer); how != Fixed::no)
            cache_.set_fixed(make_link(h, 2), how);
        if (rim_[i].begin == split_[0] || rim_[i].begin == split_[1]) {
            cache_.set_fixed(make_link(h, 1), split_kind_);
            cache_.set_fixed(make_link(previous, 0), split_kind_);
        }
        previous = h;
    }
}

void Cavity<2>::bring_infinity_last(Handle h) {
    Simplex<2> s = cache_.simplex(h);
    const FixedFacets<2> fixed = cache_.fixed(h);
    for (int i = 0; i < 2; ++i) {
        if (s.vertex[i] != infinite_vertex) continue;
        std::rotate(s.vertex.begin(), s.vertex.begin() + i + 1, s.vertex.end());
        std::rotate(s.link.begin(), s.link.begin() + i + 1, s.link.end());
        cache_.set(h, s);
        FixedFacets<2> rotated;
        for (int k = 0; k < 3; ++k) rotated.set(k, fixed[(k + i + 1) % 3]);
        cache_.set_fixed(h, rotated);
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
