// Makes the simplices that fill the hole of a removed vertex q: those in conflict with q in the
// Delaunay triangulation of its neighbours. They may be a small part of that triangulation: the
// neighbours of a vertex beside a line full of points, or on a moment curve, have many times as
// many simplices as the hole. So only those in conflict with q are ever made (Buchin, Devillers,
// Mulzer, Schrijvers and Shewchuk, "Vertex Deletion for 3D Delaunay Triangulations", 2013).
//
// The neighbours come one after the other. In the triangulation of those so far, the simplices
// in conflict with q form a ball around q. All these neighbours are on its border. A cone joins
// each facet of the border to q; if q is also triangulated, the cones are the simplices around
// q. Ball and cones together are a closed mesh. A neighbour p is inserted there as into any
// mesh: the simplices in conflict with it go, and p is joined to the rim. For
//
//   - if p kills a simplex of the ball, not the one beyond a facet, the new simplex there has a
//     circumsphere that contains the intersection of both of theirs, hence q;
//   - if p kills the cone on a facet, not the simplex on it, the facet is inside the next ball:
//     the simplex that was beyond it, which is not known here, goes as well;
//   - if p kills the simplex, not the cone, the facet remains one of the border.
//
// (An inversion that takes q to infinity shows this as the farthest-point triangulation and its
// convex hull.) Each neighbour stays a neighbour of q. So a walk through the cones alone, towards p
// as q sees it, leads to the conflict of p. All decisions are those of any insertion.
#pragma once

#include "delaunay/star.hpp"

namespace abacus {

template <int D> class LinkMesh {
public:
    using Vertices = std::array<VertexIndex, D + 1>;

    explicit LinkMesh(const Host &host)
        : host_(host), points_(host), names_(host), order_(host), cells_(host), free_(host),
          killed_(host), created_(host) {}

    /// Triangulates the link of a star. `independent`: vertices of it that span a simplex.
    /// Returns how many cells it has made, including those removed again.
    std::size_t triangulate(const Cache<D> &cache, const Star<D> &star,
                            const Vertices &independent);

    /// Cells, of which those inside fill the hole.
    std::size_t cells() const { return cells_.size(); }
    bool is_inside(Handle h) const {
        return !cells_[h].simplex.is_free() && apex_of(cells_[h].simplex) == none;
    }
    /// By vertices of the mesh.
    Vertices vertices(Handle h) const {
        Vertices result;
        for (int i = 0; i <= D; ++i) result[i] = names_[cells_[h].simplex.vertex[i]];
        return result;
    }
    Link beyond(Handle h, int facet) const { return cells_[h].simplex.link[facet]; }

private:
    static constexpr int none = -1;
    static constexpr VertexIndex apex{1}; // q; 0 is the point at infinity

    struct Cell {
        Simplex<D> simplex; // of a cone the mirror image
        bool is_killed;
    };
    struct Place {
        int round;
        std::uint64_t code;
        VertexIndex vertex;
    };

    /// Where q is in a simplex; not in those of the ball.
    static int apex_of(const Simplex<D> &s) {
        for (int i = 0; i <= D; ++i)
            if (s.vertex[i] == apex) return i;
        return none;
    }
    void list(const Cache<D> &cache, const Star<D> &star, const Vertices &independent);
    void start();
    void insert(VertexIndex p);
    Handle locate(const Point<D> &p) const;
    bool is_in_conflict(const Simplex<D> &s, const Point<D> &p) const;
    void kill(Handle h) {
        cells_[h].is_killed = true;
        killed_.push_back(h);
    }
    /// Joins the rim of the killed cells to v.
    void fill(VertexIndex v);
    void join(Handle h, VertexIndex v);
    void meet(Handle h, int rim, int facet);
    Handle create(const Simplex<D> &s);

    const Host &host_;
    Arena<Point<D>, VertexIndex> points_;   // point 0 and q first
    Arena<VertexIndex, VertexIndex> names_; // of each, in the mesh
    Arena<Place> order_;                    // in which they come
    Arena<Cell, Handle> cells_;
    Arena<Handle> free_, killed_, created_;
    Handle cone_ = no_handle; // any cone, where the next walk begins
    std::size_t most_ = 0;    // cells that there can be
    std::size_t made_ = 0;
};

extern template class LinkMesh<2>;
extern template class LinkMesh<3>;

} // namespace abacus
