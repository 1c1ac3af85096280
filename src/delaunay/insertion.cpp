#include "delaunay/insertion.hpp"

#include "delaunay/conflict.hpp"

#include <utility>

namespace abacus {

template <int D>
Insertion<D>::Insertion(Delaunay<D> &mesh)
    : mesh_(mesh), cache_(mesh.cache()), ridges_(cache_.host()), rim_vertices_(cache_.host()),
      cavity_(cache_.host()), rim_(cache_.host()), stack_(cache_.host()) {}

template <int D> Handle Insertion<D>::find_conflict(const Point<D> &p, std::uint64_t code) {
    Handle from = no_handle;
    ++cache_.counters.incircle_tests;
    for (const Handle h : mesh_.recent()) {
        if (!cache_.is_live(h)) continue;
        switch (side_of<D>(cache_, cache_.simplex(h), p)) {
        case Side::vertex: return no_handle;
        case Side::inside: ++cache_.counters.incircle_hits; return h;
        case Side::outside: from = h;
        }
    }
    const Handle h = mesh_.locate(p, code, from);
    return mesh_.corner_at(h, p) < 0 ? h : no_handle;
}

template <int D>
bool Insertion<D>::insert(const Point<D> &p, std::int64_t id, const double *attributes) {
    const std::uint64_t code = cache_.domain().code(p);
    const Handle first = find_conflict(p, code);
    if (first == no_handle) return false;
    find_cavity(p, first);
    fill_cavity(cache_.create_vertex(p, code, id, attributes));
    ++cache_.counters.insertions;
    mesh_.finish(code);
    return true;
}

template <int D> void Insertion<D>::find_cavity(const Point<D> &p, Handle first) {
    cavity_.clear();
    rim_.clear();
    stack_.clear();
    cavity_.push_back(first);
    if constexpr (D == 3) mesh_.marks.set(first, Marks::inside);
    Link *top = stack_.extend(D + 1);
    for (int i = D; i >= 0; --i) *top++ = make_link(first, i);
    // An entry is the inner side of a facet: the outer handle is asked for anew,
    // since loading for an earlier entry may have linked it.
    while (!stack_.empty()) {
        const Link inner = stack_.back();
        stack_.pop_back();
        const Link outer = cache_.cross(link_simplex(inner), link_facet(inner));
        const Handle h = link_simplex(outer);
        bool inside;
        if constexpr (D == 2) {
            inside = side_of<D>(cache_, cache_.simplex(h), p) == Side::inside;
        } else {
            Marks::Mark mark = mesh_.marks.get(h);
            if (mark == Marks::inside) continue; // came back to the cavity from within
            if (mark == Marks::none) {
                mark = side_of<D>(cache_, cache_.simplex(h), p) == Side::inside ? Marks::inside
                                                                                : Marks::outside;
                mesh_.marks.set(h, mark);
            }
            inside = mark == Marks::inside;
        }
        if (inside) {
            cavity_.push_back(h);
            if (cavity_.size() % 4096 == 0) {
                cache_.poll();
                if (cavity_.size() > cache_.cached_blocks() * std::size_t(block_slots<D>))
                    throw_corrupted("The simplices around a point are not a triangulation.");
            }
            top = stack_.extend(D);
            for (int i = D, facet = link_facet(outer); i > 0; --i) {
                facet = facet == 0 ? D : facet - 1;
                *top++ = make_link(h, facet);
            }
        } else {
            Rim<D> &rim = *rim_.extend(1);
            rim.outer = outer;
            rim.facet = link_facet(inner);
            rim.vertex = cache_.simplex(link_simplex(inner)).vertex;
        }
    }
}

template <int D> void Insertion<D>::fill_cavity(VertexIndex v) {
    std::int64_t ghosts = 0;
    for (const Handle h : cavity_) {
        // Only where the triangulation is no Delaunay one can the search come back.
        if (cache_.simplex(h).is_free())
            throw_corrupted("The simplices around a point are not a triangulation.");
        ghosts -= cache_.simplex(h).is_ghost();
        cache_.destroy(h);
    }
    for (const Rim<D> &rim : rim_) ghosts += rim.vertex[D] == infinite_vertex && rim.facet != D;
    mesh_.count(static_cast<std::int64_t>(rim_.size() - cavity_.size()) - ghosts, ghosts);
    mesh_.forget();
    if constexpr (D == 2) {
        wire_cycle(v);
    } else {
        for (const Handle h : cavity_) mesh_.marks.set(h, Marks::none);
        for (const Rim<D> &rim : rim_) mesh_.marks.set(link_simplex(rim.outer), Marks::none);
        wire_ridges(v);
    }
}

template <int D> Handle Insertion<D>::join(std::size_t n, VertexIndex v) {
    // The simplex inside, with v for the vertex opposite the facet: v lies on the same
    // side, so the orientation stays, and a ghost's point at infinity stays last.
    Rim<D> &rim = rim_[n];
    rim.vertex[rim.facet] = v;
    const Handle h = cache_.create(rim.vertex);
    mesh_.remember(n, h);
    cache_.connect(make_link(h, rim.facet), rim.outer);
    cache_.mark_dirty(link_simplex(rim.outer));
    return h;
}

template <int D> void Insertion<D>::wire_cycle(VertexIndex v) {
    // Around the rim, each new triangle meets the next across the edge opposite the
    // vertex with which its own edge begins.
    Link first = 0, last = 0;
    for (std::size_t i = 0; i < rim_.size(); ++i) {
        const Handle h = join(i, v);
        const Rim<D> &rim = rim_[i];
        const int begin = rim.facet == D ? 0 : rim.facet + 1;
        const int end = begin == D ? 0 : begin + 1;
        const Link to_previous = make_link(h, end);
        if (i == 0) first = to_previous;
        else cache_.connect(last, to_previous);
        last = make_link(h, begin);
    }
    cache_.connect(last, first);
}

template <int D> void Insertion<D>::wire_ridges(VertexIndex v) {
    ridges_.reset(rim_.size() * D);
    rim_vertices_.clear();
    for (std::size_t n = 0; n < rim_.size(); ++n) {
        const Handle h = join(n, v);
        const Rim<D> &rim = rim_[n];
        // The facets besides the rim's: each has v and one edge of that.
        std::array<std::uint32_t, D> number;
        std::array<Link, D> link;
        for (int i = 0, k = 0; i <= D; ++i) {
            if (i == rim.facet) continue;
            number[k] = cache_.number(rim_vertices_, rim.vertex[i]);
            link[k++] = make_link(h, i);
        }
        for (int i = 0; i < D; ++i) {
            const Link other = ridges_.match(number[(i + 1) % D], number[(i + 2) % D], link[i]);
            if (other != Ridges::unmatched) cache_.connect(other, link[i]);
        }
    }
}

template <int D> void Insertion<D>::start(const std::array<VertexIndex, D + 1> &vertices) {
    std::array<VertexIndex, D + 1> corners = vertices;
    Corners<D> points;
    for (int i = 0; i <= D; ++i) points[i] = &cache_.point(corners[i]);
    if (orientation<D>(points) < 0) std::swap(corners[0], corners[1]);

    cache_.create_first_block();
    std::array<Handle, D + 2> created;
    created[D + 1] = cache_.create(corners);
    mesh_.count(1, D + 1);
    for (int i = 0; i <= D; ++i) created[i] = cache_.create(ghost_on(corners, i, infinite_vertex));
    for (std::size_t a = 0; a < created.size(); ++a)
        for (std::size_t b = a + 1; b < created.size(); ++b)
            for (int i = 0; i <= D; ++i)
                for (int j = 0; j <= D; ++j) {
                    const FacetVertices<D, VertexIndex> f(cache_.simplex(created[a]).vertex, i);
                    const FacetVertices<D, VertexIndex> g(cache_.simplex(created[b]).vertex, j);
                    if (f.vertex == g.vertex)
                        cache_.connect(make_link(created[a], i), make_link(created[b], j));
                }
    cache_.settle(0);
}

template class Insertion<2>;
template class Insertion<3>;

} // namespace abacus
