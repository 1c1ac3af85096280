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

#include "cache/cache.hpp"
#include "delaunay/marks.hpp"
#include "delaunay/ridges.hpp"
#include "delaunay/walk.hpp"

namespace abacus {

template <int D> class Insertion {
public:
    /// `simplices` and `ghosts` are what the mesh has already.
    Insertion(const Host &host, Cache<D> &cache, std::int64_t simplices, std::int64_t ghosts);

    /// The first simplex of an empty mesh, on affinely independent points, with its
    /// ghosts.
    void start(const std::array<VertexIndex, D + 1> &vertices);

    /// Inserts p. Returns false if the mesh has a vertex there already.
    bool insert(const Point<D> &p, std::int64_t id, const double *attributes);

    /// Finite simplices and ghosts of the whole mesh.
    std::int64_t simplices() const { return simplices_; }
    std::int64_t ghosts() const { return ghosts_; }

private:
    /// A facet of the rim: the simplex outside, and the vertices of the one inside.
    struct Rim {
        Link outer;
        int facet; // of the simplex inside
        std::array<VertexIndex, D + 1> vertex;
    };

    /// A simplex of p's cavity, or no_handle if p is a vertex.
    Handle find_conflict(const Point<D> &p, std::uint64_t code);
    void find_cavity(const Point<D> &p, Handle first);
    void fill_cavity(VertexIndex v);
    /// The new simplex on the n-th facet of the rim, connected to the one outside.
    Handle join(std::size_t n, VertexIndex v);
    void wire_cycle(VertexIndex v);
    void wire_ridges(VertexIndex v);

    Cache<D> &cache_;
    Walk<D> walk_;

    // The application cache (§4.12.4): simplices created last; the next point is
    // likely to lie in the circumsphere of one of them.
    static constexpr int recent_size = D == 2 ? 8 : 24;
    std::array<Handle, recent_size> recent_;

    Marks marks_; // of simplices seen by the search; 3D only
    Ridges ridges_;
    typename VertexHeap<D>::Numbering rim_vertices_;
    Arena<Handle> cavity_;
    Arena<Rim> rim_;
    Arena<Link> stack_;
    std::int64_t simplices_;
    std::int64_t ghosts_;
};

} // namespace abacus
