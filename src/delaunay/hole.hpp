// The hole that a removed vertex leaves, and three ways to fill it.
//
// The perturbation of the predicates depends on the coordinates alone. So the mesh without
// the vertex is the unique Delaunay triangulation of the other points. The simplices in
// the hole have corners in the vertex's link only, since every other simplex was there
// before. So they are the part of the Delaunay triangulation of the link that lies inside
// the rim, ghosts included.
//
//   cut    In 2D the link is a polygon. The one triangle on its closing edge whose circumcircle has
//          none of the polygon's other vertices inside is cut off; this leaves two polygons with
//          fewer vertices. It needs no search and no allocation.
//   wrap   In 3D (gift wrapping): each open facet gets the one tetrahedron whose circumsphere has
//          no vertex of the link inside. It meets open facets, or opens new ones.
//   sew    The first two take a step for each pair of a facet and a vertex: best for usual degrees,
//          hopeless for the centre of a sphere. So from some dozens of vertices on, these are
//          inserted one after the other into a mesh of their own (link_mesh.hpp), and its part
//          inside the rim is copied. If the link is flat, the hole gets only ghosts, one on each
//          finite facet of the rim.
#pragma once

#include "delaunay/link_mesh.hpp"
#include "delaunay/open_facets.hpp"
#include "delaunay/star.hpp"

namespace abacus {

template <int D> class Hole {
public:
    explicit Hole(Delaunay<D> &mesh)
        : mesh_(mesh), cache_(mesh.cache()), facets_(cache_.host()), chains_(cache_.host()),
          candidates_(cache_.host()), link_(cache_.host()), filled_(cache_.host()) {}

    /// Fills the hole that the star, already destroyed, has left. Returns the cost in simplices
    /// made or destroyed.
    std::uint64_t fill(const Star<D> &star);

private:
    using Vertices = std::array<VertexIndex, D + 1>;

    /// From this many neighbours on the hole is sewn.
    static constexpr std::size_t large = D == 2 ? 64 : 24;

    Handle create(const Vertices &vertices);
    /// A simplex that finds its neighbours among the open facets.
    void add(const Vertices &vertices);
    void open_rim(const Star<D> &star);
    void require_filled() const;

    // 2D: polygons of the link from `first` to `last`, closed by an edge whose other side
    // is known.
    struct Chain {
        std::uint32_t first, last;
        Link closing;
    };
    void cut(const Star<D> &star) requires(D == 2);
    void close(const Star<D> &star, const Chain &chain) requires(D == 2);
    std::uint32_t apex(const Arena<VertexIndex> &link, const Chain &chain) const requires(D == 2);

    // 3D
    struct Candidate {
        Point<D> point;
        VertexIndex vertex;
    };
    using Facet = typename OpenFacets<D>::Facet;
    void wrap(const Star<D> &star) requires(D == 3);
    /// The vertices of the new simplex on a finite facet, and on one with the point at infinity.
    Vertices best_on_finite(const Facet &facet) const requires(D == 3);
    Vertices best_on_infinite(const Facet &facet) const requires(D == 3);

    /// Returns how many cells this has taken.
    std::size_t sew(const Star<D> &star);
    void connect(Handle cell);

    Delaunay<D> &mesh_;
    Cache<D> &cache_;
    std::size_t created_ = 0, ghosts_ = 0;
    OpenFacets<D> facets_;
    Arena<Chain> chains_;
    Arena<Candidate> candidates_;
    LinkMesh<D> link_;
    Arena<Handle, Handle> filled_; // the simplices of its cells inside
};

} // namespace abacus
