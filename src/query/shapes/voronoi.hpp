// The Voronoi cells of a mesh, or the parts of them within a window, one by one.
//
// A cell is dual to the star of its vertex: its corners are the circumcentres of the simplices
// there, and the edges at the vertex cross its facets. At the hull it is unbounded. If simplices
// share a circumsphere, which exact tests detect, its centre is computed exactly and rounded last,
// so that they all have the same.
//
// Cells that meet a window W may belong to vertices outside of it. Let p be a place in W and v the
// vertex nearest to it. If p were inserted, the simplices in conflict with it would be removed, and
// p would be joined to v: so some simplex at v has p within its circumsphere, or is a ghost with p
// beyond its facet. Let the zone be all simplices whose ball, or half-space, meets W. So v is a
// corner of the zone. The simplices in conflict with a place are connected, and the one around the
// place is among them; those around the places of W are connected across facets; so the zone is
// connected, and a flood finds its pages. If rounding adds a few more simplices to the zone, this
// does no harm.
//
// A vertex belongs to the first page that has a simplex of the zone around it.
#pragma once

#include "geometry/cell_shape.hpp"
#include "query/locate/reader.hpp"
#include "query/scan/window.hpp"

#include <optional>

namespace abacus {

template <int D> class Voronoi {
public:
    using Shape = CellShape<D>;

    /// All of the mesh if `window` has no box. Throws if the mesh is not Delaunay.
    Voronoi(const Host &host, const abacus_facts &facts, const abacus_window &window,
            std::size_t cache_bytes);

    /// Goes to the next cell; false after the last.
    bool advance();

    std::int64_t id() const { return id_; }
    const Point<D> &vertex() const { return vertex_; }
    bool is_bounded() const { return is_bounded_; }
    /// Its part in the window, if there is one. The faces of an unbounded cell are incomplete.
    const Shape &shape() const { return shape_; }
    bool is_clipped() const { return box_.has_value(); }
    /// Ids of the neighbours by their labels.
    std::int64_t neighbour_id(int label) const {
        return neighbours_[static_cast<std::size_t>(label)].id;
    }

private:
    struct Neighbour {
        Point<D> point;
        std::int64_t id;
        VertexIndex vertex;
        Handle simplex; ///< with it and the vertex as corners
    };
    struct Centre {
        Handle simplex;
        Point<D> at;
    };

    bool next_page();
    /// The page's simplices; one corner of them for each vertex of the zone.
    void list_corners();
    bool is_in_zone(Handle h) const;
    /// Whether no simplex of the zone around this corner is in an earlier page.
    bool is_own(Link corner);
    bool make_cell(Link corner);
    void collect_neighbours(VertexIndex v);
    void collect_centres();
    Point<D> centre(Handle h);
    void shape_by_mesh(VertexIndex v);
    void add_ring(Handle first, const std::array<VertexIndex, D - 1> &ridge);
    int label(VertexIndex v);

    const Host &host_;
    const abacus_facts facts_;
    std::optional<Box<D>> box_;
    Reader<D> reader_;
    Cache<D> &cache_;
    std::optional<PageFlood<D>> flood_; // if not all pages are read
    Key page_ = first_key;
    Arena<Link> open_; // of the page; the last is the next
    typename VertexHeap<D>::Numbering numbers_;
    Arena<Handle> star_;
    Arena<Neighbour> neighbours_; // in lexicographic order
    Arena<std::uint32_t> labels_; // by number
    Arena<Centre> centres_;       // by handle
    Shape shape_;
    std::int64_t id_ = 0;
    Point<D> vertex_{};
    bool is_bounded_ = false;
};

extern template class Voronoi<2>;
extern template class Voronoi<3>;

} // namespace abacus
