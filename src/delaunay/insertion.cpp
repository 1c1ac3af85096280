#include "delaunay/insertion.hpp"

#include "delaunay/cached_conflict.hpp"

#include <utility>

namespace abacus {

template <int D>
Insertion<D>::Insertion(Delaunay<D> &mesh) : mesh_(mesh), cache_(mesh.cache()), cavity_(mesh) {}

template <int D> Handle Insertion<D>::find_conflict(const Point<D> &p, std::uint64_t code) {
    if (mesh_.is_constrained) return find_containing(p, code);
    Handle from = no_handle;
    ++cache_.counters.incircle_tests;
    for (const Handle h : mesh_.recent()) {
        if (!cache_.is_live(h)) continue;
        switch (side_of<D>(cache_, cache_.simplex(h), p)) {
        case Side::vertex:
            return no_handle;
        case Side::inside:
            ++cache_.counters.incircle_hits;
            return h;
        case Side::outside:
            from = h;
        }
    }
    const Handle h = mesh_.locate(p, code, from);
    return mesh_.corner_at(h, p) < 0 ? h : no_handle;
}

template <int D> Handle Insertion<D>::find_containing(const Point<D> &p, std::uint64_t code) {
    const Handle h = mesh_.locate(p, code, mesh_.any_recent());
    return mesh_.corner_at(h, p) < 0 ? h : no_handle;
}

template <int D>
bool Insertion<D>::insert(const Point<D> &p, std::uint64_t code, std::int64_t id,
                          const double *attributes) {
    const bool is_new = find_cavity(p, code);
    if (is_new) fill_cavity(p, code, id, attributes);
    mesh_.finish(code); // what was loaded on the way to a vertex also counts
    return is_new;
}

template <int D>
Inserted Insertion<D>::insert_within(const Point<D> &p, std::uint64_t code, std::int64_t id,
                                     const double *attributes) {
    bool is_new;
    try {
        is_new = find_cavity(p, code);
    } catch (const Foreign &) {
        cavity_.give_up();
        mesh_.finish(code);
        return Inserted::put_off;
    }
    if (is_new) fill_cavity(p, code, id, attributes);
    mesh_.finish(code);
    return is_new ? Inserted::as_vertex : Inserted::is_vertex;
}

template <int D> inline bool Insertion<D>::find_cavity(const Point<D> &p, std::uint64_t code) {
    const Handle first = find_conflict(p, code);
    if (first == no_handle) return false;
    cavity_.find(p, first);
    return true;
}

template <int D>
inline void Insertion<D>::fill_cavity(const Point<D> &p, std::uint64_t code, std::int64_t id,
                                      const double *attributes) {
    cavity_.fill(cache_.create_vertex(p, code, id, attributes));
    ++cache_.counters.insertions;
}

template <int D> void Insertion<D>::start(const std::array<VertexIndex, D + 1> &vertices) {
    std::array<VertexIndex, D + 1> corners = vertices;
    Corners<D> points;
    for (int i = 0; i <= D; ++i) points[i] = &cache_.point(corners[i]);
    if (orientation<D>(points) < 0) std::swap(corners[0], corners[1]);

    cache_.create_first_block();
    std::array<Handle, D + 2> created;
    created[D + 1] = cache_.create(corners);
    if (mesh_.log != nullptr) mesh_.log->come(cache_, created[D + 1]);
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
