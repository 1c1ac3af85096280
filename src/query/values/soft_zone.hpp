// The zone of a place in a mesh with soft lines: that in the triangulation whose hard edges alone
// are fixed, since a soft line does not end what a place sees.
//
// The mesh has this triangulation but where soft edges keep it from being so. There it is made
// anew, in memory: a region of triangles around the place is copied, without the soft edges, and
// edges are flipped (delaunay/pieces.hpp). The region is large enough if what it lacks cannot
// matter:
//
//   The place p would be joined to the vertices of its zone. Let (p, u, w) be a triangle that p
//   would form with an edge of the zone's rim. It is one of the triangulation if its circle has no
//   vertex that it sees. It has none of the region. What it would see outside lies beyond the edge
//   from u to w, in the circle: the rest of the circle is seen through other edges of the rim. To
//   get there, the circle must reach across an edge on the border of the region.
//
//   So the region grows across such edges, and all is made again, until no circle reaches across
//   one. The test of that may err on one side, in doubles: if it is in doubt, the region grows. All
//   decisions about the triangulation are exact.
//
// Where no soft edge is in the region, all this is what the mesh is already.
#pragma once

#include "delaunay/pieces.hpp"
#include "query/values/zone.hpp"
#include "traverse/marks.hpp"

namespace abacus {

class SoftZone {
public:
    explicit SoftZone(const Host &host)
        : host_(host), marks_(host), region_(host), places_(host), border_(host), rim_(host),
          numbers_(host) {}

    /// Whether soft edges may matter to the zone of p, which lies in the closure of a finite
    /// triangle and is not a vertex. If not, the zone is that of the mesh.
    bool matters(Cache<2> &cache, Handle h, const Point<2> &p);
    /// Finds the zone of p. False if p is on the hull or on a hard edge.
    bool find(Cache<2> &cache, Handle h, const Point<2> &p, Arena<ZoneSimplex<2>> &zone);

private:
    /// An edge that the place sees at the rim: its ends, seen from the place counterclockwise.
    struct Rim {
        Point<2> u, w;
    };
    struct Place {
        Handle triangle;
        std::uint32_t number;
    };

    /// What may be beyond an edge of a triangle: a triangle, or no_handle.
    Handle seen_beyond(Cache<2> &cache, Handle h, int facet) const;
    bool is_at_end(Cache<2> &cache, Handle h, const Point<2> &p) const;
    void take(Cache<2> &cache, Handle h);
    void forget_region();
    /// The region to begin with: triangles whose circle has p.
    void begin(Cache<2> &cache, Handle h, const Point<2> &p);
    std::uint32_t number_of(Handle h) const;
    /// The rim of the region, as if it was the zone.
    void find_rim(Cache<2> &cache);
    /// Makes the triangulation of the region.
    void triangulate(Cache<2> &cache, Pieces &pieces);
    /// Finds the zone in it, by numbers of pieces, and its rim.
    void find_zone(Cache<2> &cache, const Pieces &pieces, const Point<2> &p);
    std::size_t piece_around(Cache<2> &cache, const Pieces &pieces, const Point<2> &p) const;
    /// Adds what circles of the rim may reach; false if there is nothing.
    bool grow(Cache<2> &cache, const Point<2> &p);
    bool is_reached(const Point<2> &p, const Point<2> &x, const Point<2> &y) const;

    const Host &host_;
    Marks marks_;                  // the region, while it is looked for
    Arena<Handle> region_;         // triangles of the mesh
    bool has_soft_ = false;        // one of them has a soft edge
    Arena<Place> places_;          // of the region, by handles
    Arena<Link> border_;           // edges of the region with something beyond, from inside
    Arena<Rim> rim_;               // of the zone
    Arena<std::uint32_t> numbers_; // of the pieces of the zone
};

} // namespace abacus
