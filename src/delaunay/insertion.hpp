// Incremental insertion (Bowyer 1981, Watson 1981; dissertation §4.12.3).
//
// A point's cavity is the set of simplices whose circumspheres contain it; a ghost's
// is the half-space beyond its hull facet. The cavity is star-shaped around the
// point, and is replaced by the simplices that join the facets of its rim to the
// point. Every decision is an exact predicate under symbolic perturbation, so the
// mesh after each insertion is the unique perturbed Delaunay triangulation of the
// points so far, whatever their order.
//
// In 2D the cavity's triangles form a tree (the polygon has no vertex inside), so a
// depth-first search that keeps the order of the edges around each triangle visits
// each once and lists the rim as a cycle: the new triangles are wired without any
// search. In 3D the search marks what it has seen, and the new tetrahedra find one
// another by their ridges, the edges of the rim, in small tables (ridges.hpp).
#pragma once

#include "delaunay/delaunay.hpp"
#include "delaunay/ridges.hpp"

namespace abacus {

template <int D> class Insertion {
public:
    explicit Insertion(Delaunay<D> &mesh);

    /// The first simplex of an empty mesh, on affinely independent points, with its
    /// ghosts.
    void start(const std::array<VertexIndex, D + 1> &vertices);

    /// Inserts p. Returns false if the mesh has a vertex there already.
    bool insert(const Point<D> &p, std::int64_t id, const double *attributes);

private:
    /// A simplex of p's cavity, or no_handle if p is a vertex.
    Handle find_conflict(const Point<D> &p, std::uint64_t code);
    void find_cavity(const Point<D> &p, Handle first);
    void fill_cavity(VertexIndex v);
    /// The new simplex on the n-th facet of the rim, connected to the one outside.
    Handle join(std::size_t n, VertexIndex v);
    void wire_cycle(VertexIndex v);
    void wire_ridges(VertexIndex v);

    Delaunay<D> &mesh_;
    Cache<D> &cache_;
    Ridges ridges_;
    typename VertexHeap<D>::Numbering rim_vertices_;
    Arena<Handle> cavity_;
    Arena<Rim<D>> rim_;
    Arena<Link> stack_;
};

} // namespace abacus
