// The Delaunay triangulation of a vertex's neighbours by themselves, in a cache of its
// own that nothing ever leaves: what lies inside the rim of the vertex's star fills the
// hole. Its vertices have for ids their indices in the mesh.
#pragma once

#include "delaunay/insertion.hpp"
#include "delaunay/open_facets.hpp"

namespace abacus {

template <int D> class LinkMesh {
public:
    using Vertices = std::array<VertexIndex, D + 1>;

    /// `independent`: vertices of the link that span a simplex.
    LinkMesh(const Cache<D> &cache, const Arena<VertexIndex> &link, const Vertices &independent);

    /// The simplices inside the rim, by vertices of the mesh.
    const Arena<Vertices> &inside(const OpenFacets<D> &rim);

private:
    static Domain<D> domain(const Cache<D> &cache, const Arena<VertexIndex> &link);
    VertexIndex create(const Cache<D> &cache, VertexIndex v);
    Vertices vertices(Handle h) const;

    const Host &host_;
    Cache<D> own_;
    Delaunay<D> mesh_;
    Insertion<D> insertion_;
    Arena<Vertices> inside_;
};

} // namespace abacus
