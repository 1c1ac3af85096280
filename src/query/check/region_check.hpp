// Whether the triangles of a sound mesh are in the regions that outlines and seeds give them.
//
// Regions end at fixed edges alone (topology_check.hpp), so each is a set of faces
// (traverse/faces.hpp).
//
//   outlines  parity says on which side of each of their edges the inside is
//   (constrain/outline_sides.hpp).
//             If that side of all of them is in the region, the other is not, and the region has no
//             other border, then it is what parity makes of them: inside and outside change at
//             those edges alone, and beyond the hull is outside.
//   seeds     the face of each is in the region, and no other face: for every fixed edge with the
//   region
//             on its left the face there is that of a seed.
//
// Edges with a region of seeds beside them are sorted, and as many as memory has room for are
// looked at together, so that each walk is taken once for all of them.
#pragma once

#include "constrain/region_parts.hpp"
#include "query/locate/reader.hpp"
#include "traverse/faces.hpp"

namespace abacus {

class RegionCheck {
public:
    RegionCheck(Reader<2> &reader, std::size_t memory);

    /// The number of a region whose triangles are not those that these parts of all regions give
    /// it; no_region if there is none.
    RegionNumber find_wrong(RegionParts &parts);

private:
    RegionNumber check_outlines(RegionParts &parts);
    RegionNumber check_seeds(RegionParts &parts);
    /// Adds the edges of a segment; false if the mesh lacks one.
    template <class Add> bool add_edges(const Point<2> &a, const Point<2> &b, Add add);
    RegionNumber region_beside(const Point<2> &from, const Point<2> &to);
    /// Collects the fixed edges that have a region of seeds on their left.
    void collect_edges(RecordSort &edges);
    /// Adds the faces beside these edges with their regions; a region that reaches the hull, or
    /// no_region.
    RegionNumber add_faces(RecordSort &edges, RecordSort &faces);
    RegionNumber first_without_seed(RecordSort &faces);

    Reader<2> &reader_;
    Cache<2> &cache_;
    const std::size_t memory_;
    Faces faces_;
    Arena<RegionNumber> seeded_; // in order
};

} // namespace abacus
