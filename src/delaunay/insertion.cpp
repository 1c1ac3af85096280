#include "delaunay/insertion.hpp"

#include "delaunay/conflict.hpp"

#include <utility>

namespace abacus {

template <int D>
Insertion<D>::Insertion(const Host &host, Cache<D> &cache, std::int64_t simplices,
                        std::int64_t ghosts)
    : cache_(cache), walk_(cache), cavity_(host), rim_(host), stack_(host), created_(host),
      simplices_(simplices), ghosts_(ghosts) {
    recent_.fill(no_handle);
}

template <int D> Handle Insertion<D>::find_conflict(const Point<D> &p, std::uint64_t code) {
    Handle from = no_handle;
    ++cache_.counters.incircle_tests;
    for (const Handle h : recent_) {
        if (!cache_.is_live(h)) continue;
        switch (side_of<D>(cache_, cache_.simplex(h), p)) {
        case Side::vertex: return no_handle;
        case Side::inside: ++cache_.counters.incircle_hits; return h;
        case Side::outside: from = h;
        }
    }
    // Walk from the last insertion if p is in its neighbourhood, measured by the
    // size of the simplices there; else from the block that owns p's code.
    if (from != no_handle) {
        const Simplex<D> &s = cache_.simplex(from);
        const Point<D> &a = cache_.point(s.vertex[0]), &b = cache_.point(s.vertex[1]);
        double size = 0, distance = 0;
        for (int i = 0; i < D; ++i) {
            size += (b[i] - a[i]) * (b[i] - a[i]);
            distance += (p[i] - a[i]) * (p[i] - a[i]);
        }
        if (!(distance <= 64 * size) && !cache_.near(from, code)) from = no_handle;
    }
    if (from == no_handle) from = cache_.start(code, p);
    if (from == no_handle) throw_corrupted("The mesh has no simplices.");
    const Handle h = walk_.to(p, from);
    const Simplex<D> &s = cache_.simplex(h);
    for (int i = 0; i < s.finite_vertices(); ++i)
        if (cache_.point(s.vertex[i]) == p) return no_handle;
    return h;
}

template <int D>
bool Insertion<D>::insert(const Point<D> &p, std::int64_t id, const double *attributes) {
    const std::uint64_t code = cache_.domain().code(p);
    const Handle first = find_conflict(p, code);
    if (first == no_handle) return false;
    find_cavity(p, first);
    fill_cavity(cache_.create_vertex(p, id, attributes));
    cache_.settle(code);
    // The last ones are nearest to the hand of the placement.
    for (std::size_t i = 0; i < recent_.size(); ++i)
        recent_[i] = i < created_.size() ? cache_.follow(created_[created_.size() - 1 - i])
                                         : no_handle;
    ++cache_.counters.insertions;
    cache_.trim();
    return true;
}

template <int D> void Insertion<D>::find_cavity(const Point<D> &p, Handle first) {
    cavity_.clear();
    rim_.clear();
    stack_.clear();
    cavity_.push_back(first);
    for (int i = D; i >= 0; --i) stack_.push_back(make_link(first, i));
    // An entry is the inner side of a facet: the outer handle is asked for anew,
    // since loading for an earlier entry may have linked it.
    while (!stack_.empty()) {
        const Link inner = stack_.back();
        stack_.pop_back();
        const Link outer = cache_.cross(link_simplex(inner), link_facet(inner));
        const Handle h = link_simplex(outer);
        const Simplex<D> &s = cache_.simplex(h);
        if (side_of<D>(cache_, s, p) == Side::inside) {
            cavity_.push_back(h);
            if (cavity_.size() % 4096 == 0) cache_.poll();
            const int from = link_facet(outer);
            for (int i = D; i > 0; --i) stack_.push_back(make_link(h, (from + i) % (D + 1)));
        } else {
            const Simplex<D> &inside = cache_.simplex(link_simplex(inner));
            Rim rim;
            rim.outer = outer;
            for (int i = 0; i < D; ++i)
                rim.vertex[i] = inside.vertex[(link_facet(inner) + 1 + i) % (D + 1)];
            rim_.push_back(rim);
        }
        if (static_cast<std::int64_t>(cavity_.size()) > simplices_ + ghosts_)
            throw_corrupted("The simplices around a point are not a triangulation.");
    }
}

template <int D>
Handle Insertion<D>::create(std::array<VertexIndex, D + 1> &vertices,
                            std::array<int, D + 1> &facet_at) {
    // A ghost has the point at infinity last: an even permutation takes it there.
    for (int i = 0; i <= D; ++i) facet_at[i] = i;
    if (vertices[D] != infinite_vertex) {
        for (int i = 0; i < D; ++i) {
            if (vertices[i] != infinite_vertex) continue;
            std::array<VertexIndex, D + 1> turned;
            if constexpr (D == 2) { // rotation
                for (int j = 0; j <= D; ++j) {
                    facet_at[j] = (j + D - i) % (D + 1);
                    turned[facet_at[j]] = vertices[j];
                }
            } else { // two transpositions
                const int other = i == 0 ? 1 : 0, third = 3 - i - other;
                facet_at[i] = D;
                facet_at[D] = i;
                facet_at[other] = third;
                facet_at[third] = other;
                for (int j = 0; j <= D; ++j) turned[facet_at[j]] = vertices[j];
            }
            vertices = turned;
            break;
        }
    }
    ++(vertices[D] == infinite_vertex ? ghosts_ : simplices_);
    return cache_.create(vertices);
}

template <int D> void Insertion<D>::fill_cavity(VertexIndex v) {
    for (const Handle h : cavity_) {
        --(cache_.simplex(h).is_ghost() ? ghosts_ : simplices_);
        cache_.destroy(h);
    }
    created_.clear();
    static_assert(D == 2, "the rim is a cycle in 2D only");
    // Triangle (a, b, v) on each edge ab of the rim; the next edge begins at b.
    Link first = 0, last = 0; // facets across which the first and last triangles meet
    for (std::size_t i = 0; i < rim_.size(); ++i) {
        const Rim &rim = rim_[i];
        std::array<VertexIndex, D + 1> vertices{rim.vertex[0], rim.vertex[1], v};
        std::array<int, D + 1> facet_at;
        const Handle h = create(vertices, facet_at);
        created_.push_back(h);
        cache_.connect(make_link(h, facet_at[2]), rim.outer);
        cache_.mark_dirty(link_simplex(rim.outer));
        const Link to_previous = make_link(h, facet_at[1]);
        if (i == 0) first = to_previous;
        else cache_.connect(last, to_previous);
        last = make_link(h, facet_at[0]);
    }
    cache_.connect(last, first);
}

template <int D> void Insertion<D>::start(const std::array<VertexIndex, D + 1> &vertices) {
    std::array<VertexIndex, D + 1> corners = vertices;
    Corners<D> points;
    for (int i = 0; i <= D; ++i) points[i] = &cache_.point(corners[i]);
    if (orientation<D>(points) < 0) std::swap(corners[0], corners[1]);

    cache_.create_first_block();
    created_.clear();
    std::array<int, D + 1> facet_at;
    created_.push_back(create(corners, facet_at));
    for (int i = 0; i <= D; ++i) {
        // The point at infinity is on the other side of facet i than corner i: two
        // corners change places to keep the orientation positive.
        std::array<VertexIndex, D + 1> ghost = corners;
        ghost[i] = infinite_vertex;
        std::swap(ghost[(i + 1) % (D + 1)], ghost[(i + 2) % (D + 1)]);
        created_.push_back(create(ghost, facet_at));
    }
    for (std::size_t a = 0; a < created_.size(); ++a)
        for (std::size_t b = a + 1; b < created_.size(); ++b)
            for (int i = 0; i <= D; ++i)
                for (int j = 0; j <= D; ++j) {
                    const FacetVertices<D, VertexIndex> f(cache_.simplex(created_[a]).vertex, i);
                    const FacetVertices<D, VertexIndex> g(cache_.simplex(created_[b]).vertex, j);
                    if (f.vertex == g.vertex)
                        cache_.connect(make_link(created_[a], i), make_link(created_[b], j));
                }
    cache_.settle(0);
}

template class Insertion<2>;

} // namespace abacus
