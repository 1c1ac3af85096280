// Regions of a mesh in the plane: their triangles found from outlines and seeds.
//
// Of outlines, the edges with the inside on their left are found (outline_sides.hpp). The triangles
// there are in the region, those on the right are marked as outside, and the rest is flooded. Where
// a triangle on the right is in another region there is no room for a mark, and the edge is kept
// (touching_edges.hpp).
#pragma once

#include "constrain/edges_on.hpp"
#include "constrain/outline_sides.hpp"
#include "constrain/region_flood.hpp"
#include "constrain/region_parts.hpp"

namespace abacus {

/// Calls visit(region) for the regions on either side of each edge on the segment.
template <class Visit>
void each_region_along(Delaunay<2> &mesh, const Point<2> &a, const Point<2> &b, Visit visit) {
    Cache<2> &cache = mesh.cache();
    each_edge_on(mesh, a, b, [&](Link edge) {
        for (const Handle h : {link_simplex(edge), right_of(cache, edge)})
            if (const RegionNumber region = cache.region(h); region != no_region) visit(region);
    });
}

class Regions {
public:
    Regions(Delaunay<2> &mesh, std::size_t memory);

    /// A box around triangles of a region.
    using Report = std::function<void(RegionNumber region, const Box<2> &box)>;
    /// Puts triangles into their regions, each of which lies in the boxes that are reported of it;
    /// false, and `fault` says why, if it is impossible.
    bool fill(RegionParts &parts, const Report &report, abacus_region_fault &fault);
    /// Takes all triangles out of the regions that have these parts.
    void clear(RegionParts &parts);
    /// A triangle of the face in which a seed of a region lies; no_handle, and `fault` says why, if
    /// there is none.
    Handle at_seed(RegionNumber region, const Point<2> &p, abacus_region_fault &fault);

private:
    bool fill_outlines(RegionParts &parts, const Report &report, abacus_region_fault &fault);
    /// Begins with the triangles along an edge that has the inside on its left.
    bool fill_beside(RegionNumber region, const Point<2> &from, const Point<2> &to,
                     abacus_region_fault &fault);
    bool flood_outline(RegionNumber region, abacus_region_fault &fault);
    void unmark_outside();
    bool fill_seed(RegionNumber region, const Point<2> &p, const Report &report,
                   abacus_region_fault &fault);
    /// A fixed edge that p, in the closure of a triangle, lies on; `unset` if there is none.
    Link fixed_edge_at(Handle h, const Point<2> &p);

    Delaunay<2> &mesh_;
    Cache<2> &cache_;
    RegionFlood flood_;
    const std::size_t memory_;
    std::optional<RecordSpool> edges_; // of a region, with the inside on their left
    TouchingEdges touching_;           // of a region
};

} // namespace abacus
