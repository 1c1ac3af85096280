// The star of a vertex: the simplices around it. All of them are loaded, and so are
// those beyond its rim. So both sides of each facet are cached, whatever happens to the star, and
// no page outside the cache has the vertex.
#pragma once

#include "delaunay/delaunay.hpp"
#include "traverse/flood.hpp"

namespace abacus {

template <int D> class Star {
public:
    explicit Star(Delaunay<D> &mesh)
        : cache_(mesh.cache()), flood_(cache_.host()), simplices_(cache_.host()),
          rim_(cache_.host()), link_(cache_.host()), numbering_(cache_.host()) {}

    /// Collects the star of the vertex that is this corner of the simplex.
    void collect(Handle h, int corner);
    /// After collect() has thrown: the next star starts afresh.
    void give_up() { flood_.give_up(); }

    VertexIndex vertex() const { return vertex_; }
    const Arena<Handle> &simplices() const { return simplices_; }
    std::size_t ghosts() const { return ghosts_; }
    /// The facets opposite the vertex, one for each simplex of the star.
    const Arena<Rim<D>> &rim() const { return rim_; }
    /// The neighbours of the vertex, each once; the one at infinity is among them if the
    /// vertex is on the hull. In 2D in counterclockwise order, with that one first; the
    /// n-th facet of the rim begins with the n-th neighbour.
    const Arena<VertexIndex> &link() const { return link_; }

    /// Whether the neighbours span no simplex. If not, `independent` are D + 1 that do.
    bool is_flat(std::array<VertexIndex, D + 1> &independent) const;

private:
    void turn_around(Handle h, int corner);
    void search_around(Handle h);
    /// Adds a simplex; returns it as it is after loading.
    void add(Handle h, int corner);

    Cache<D> &cache_;
    Flood<D> flood_; // 3D only
    VertexIndex vertex_ = infinite_vertex;
    std::size_t ghosts_ = 0;
    Arena<Handle> simplices_;
    Arena<Rim<D>> rim_;
    Arena<VertexIndex> link_;
    typename VertexHeap<D>::Numbering numbering_; // of the link; 3D only
};

} // namespace abacus
