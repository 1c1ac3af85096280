// The section of a mesh in space by a plane, tetrahedron by tetrahedron.
//
// The heights of vertices above the plane are exact in their signs, and a vertex in the plane
// counts as above it (geometry/tetrahedron_cut.hpp). So the polygons tile the plane without gap or
// overlap. Corners that lie on the same vertex are merged; if only an edge or a point remains, it
// is not a polygon. A facet in the plane is the section of the tetrahedron below it. At the bottom
// of the mesh there is none below, so it is the section of the facet's ghost.
//
// Corners are computed from the two vertices of their edge, the lexicographically lesser one first.
// So polygons that share a corner have the same coordinates to the last bit.
#pragma once

#include "geometry/cutting_plane.hpp"
#include "keys/locational_code.hpp"
#include "query/pages/extent.hpp"
#include "query/pages/page_values.hpp"
#include "query/scan/range_scan.hpp"

#include <abacus/surface.h>

namespace abacus {

/// The plane, and a little more on both sides: it contains a point near the middle of the mesh that
/// is as near to the plane as doubles allow.
class PlaneRegion final : public Region<3> {
public:
    /// `around`: where the points of the mesh are, as far as is known.
    PlaneRegion(const CuttingPlane &plane, const Box<3> &around);

    Point<3> inside(const Domain<3> &) const override { return inside_; }
    bool may_meet(const Point<3> *const *points, int n) const override;
    bool may_meet(const Box<3> &box) const override;

private:
    const CuttingPlane plane_;
    Point<3> inside_;
    double slack_;
};

class PlaneSection {
public:
    /// Throws an Error (argument) if there is no such plane.
    PlaneSection(const Host &host, const abacus_facts &facts, const abacus_section_query &query);

    /// False after the last polygon.
    bool next(abacus_polygon &polygon);
    /// The simplex of that polygon in its page; valid until the next call.
    const PageView<3> &page() const { return pages_.page(); }
    int simplex() const { return at_ - 1; }

private:
    void enter();
    bool take(int simplex, abacus_polygon &polygon) const;
    bool cut(int simplex, abacus_polygon &polygon) const;
    bool is_bottom(int ghost) const;
    bool is_of_fault(int ghost) const;
    /// Adds a corner: a vertex, or the place where the edge between two meets the plane.
    void add(int vertex, abacus_polygon &polygon) const;
    void add(int below, int above, abacus_polygon &polygon) const;

    const CuttingPlane plane_;
    PageValues<3> values_;
    const abacus_extent extent_;
    const bool is_split_; // vertices at one place are distinguished by their ids
    const Domain<3> domain_;
    const PlaneRegion region_;
    RangeScan<3> pages_;
    std::array<double, page_vertices<3>> heights_;
    bool in_page_ = false;
    int at_ = 0;
};

} // namespace abacus
