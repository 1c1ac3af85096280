// Frees edges that no line lies over any more, and makes the mesh around them Delaunay again
// (restoring.hpp). An edge that only soft lines still lie over becomes soft.
#pragma once

#include "constrain/restoring.hpp"
#include "delaunay/lines_over.hpp"

namespace abacus {

class Freeing {
public:
    Freeing(Delaunay<2> &mesh, LineSource &lines);

    /// Frees the edges on the segment from a to b over which the host has no line; the others get
    /// the kind of their lines. If a region ends at one that would be free, returns its number;
    /// then the change must be given up.
    RegionNumber free(const Point<2> &a, const Point<2> &b);

private:
    /// Frees the edge at `from` on the way to b, if there is a fixed one that may be free; returns
    /// its other end.
    Point<2> free_edge(const Point<2> &from, const Point<2> &b);

    Delaunay<2> &mesh_;
    Cache<2> &cache_;
    LinesOver over_;
    Restoring restoring_;
    RegionNumber ending_ = no_region; // at the edge that would be free
};

} // namespace abacus
