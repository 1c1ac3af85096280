#include "delaunay/star.hpp"

#include <algorithm>

namespace abacus {

template <int D> void Star<D>::collect(Handle h, int corner) {
    simplices_.clear();
    rim_.clear();
    link_.clear();
    ghosts_ = 0;
    vertex_ = cache_.simplex(h).vertex[corner];
    if constexpr (D == 2)
        turn_around(h, corner);
    else
        search_around(h);
    if (link_.size() <= D) throw_no_triangulation();
}

template <int D> void Star<D>::add(Handle h, int corner) {
    const Link outer = cache_.cross(h, corner);
    const Simplex<D> &s = cache_.simplex(h);
    if (cache_.simplex(link_simplex(outer)).vertex[link_facet(outer)] == vertex_)
        throw_no_triangulation();
    simplices_.push_back(h);
    rim_.push_back({outer, corner, s.vertex});
    ghosts_ += s.is_ghost();
    if (simplices_.size() % 4096 == 0) cache_.poll();
}

// In 2D counterclockwise: from each triangle across the edge where the next one begins. Links lead
// both ways, so the turn ends where it began.
template <int D> void Star<D>::turn_around(Handle first, int corner) {
    Handle h = first;
    std::size_t infinity = 0;
    do {
        add(h, corner);
        const int begin = corner == D ? 0 : corner + 1;
        const VertexIndex neighbour = cache_.simplex(h).vertex[begin];
        if (neighbour == infinite_vertex) infinity = link_.size();
        link_.push_back(neighbour);
        const Link next = cache_.cross(h, begin);
        h = link_simplex(next);
        // In the next triangle the new neighbour lies opposite the edge, and the vertex follows it.
        corner = link_facet(next) == D ? 0 : link_facet(next) + 1;
    } while (h != first);
    if (infinity > 0) {
        std::rotate(link_.begin(), link_.begin() + infinity, link_.end());
        std::rotate(rim_.begin(), rim_.begin() + infinity, rim_.end());
    }
}

// In 3D across every facet at the vertex.
template <int D> void Star<D>::search_around(Handle first) {
    flood_.around(cache_, first, vertex_, [&](Handle h) {
        add(h, cache_.simplex(h).index_of(vertex_));
        return true;
    });
    // Not earlier, since loading numbers vertices in its own way.
    numbering_.clear();
    for (const Rim<D> &rim : rim_)
        for (int i = 0; i <= D; ++i)
            if (i != rim.facet) cache_.number(numbering_, rim.vertex[i]);
    link_.resize(numbering_.size());
    for (std::size_t n = 0; n < link_.size(); ++n) link_[n] = numbering_[n];
}

template <int D> bool Star<D>::is_flat(std::array<VertexIndex, D + 1> &independent) const {
    Corners<D> corners;
    int n = 0;
    for (const VertexIndex v : link_) {
        if (v == infinite_vertex || !is_independent(corners, n, cache_.point(v))) continue;
        corners[n] = &cache_.point(v);
        independent[n++] = v;
        if (n == D + 1) return false;
    }
    return true;
}

template class Star<2>;
template class Star<3>;

} // namespace abacus
