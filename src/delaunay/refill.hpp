// Fills the hole that a vertex of a constrained mesh leaves. Its star is filled as a whole. If the
// vertex lies inside an edge of its lines, which is two fixed edges of the mesh in one straight
// line, each side is filled, and the edge between them is fixed.
#pragma once

#include "delaunay/lines_over.hpp"
#include "delaunay/patch.hpp"
#include "delaunay/star.hpp"

namespace abacus {

class Refill {
public:
    explicit Refill(Delaunay<2> &mesh)
        : mesh_(mesh), patch_(mesh), spokes_(mesh.cache().host()), corners_(mesh.cache().host()),
          regions_(mesh.cache().host()), beyond_(mesh.cache().host()) {}

    /// Looks at a star, and says how many edges of its vertex are fixed.
    std::size_t look_at(const Star<2> &star);
    /// Throws an Error (state) unless the vertex can be removed: if a line names it, or if several
    /// lines pass through it.
    void require_removable(const Star<2> &star, LineSource *lines);
    /// Fills the hole of that star, whose simplices are gone; returns how many it has created.
    std::size_t fill(const Star<2> &star);

private:
    bool is_straight(const Star<2> &star) const;
    [[noreturn]] void refuse_crossing(const Star<2> &star, LineSource &lines);
    /// Corners of the star's link from the i-th to the j-th.
    Patch::Side fill_side(const Star<2> &star, std::size_t i, std::size_t j);
    void take(const Star<2> &star, std::size_t i);

    Delaunay<2> &mesh_;
    Patch patch_;
    Arena<std::size_t> spokes_; // places in the link
    Fixed kind_ = Fixed::no;    // of the last
    Arena<VertexIndex> corners_;
    Arena<RegionNumber> regions_; // of the star's simplices, in the order of its rim
    Arena<Patch::Side> beyond_;
};

} // namespace abacus
