// Frees edges that no line lies over any more, and makes the mesh around them Delaunay again: from
// each edge that is free, edges that fail the in-circle test are flipped, and those around them are
// tested, until none fails (Lawson 1977). Under the symbolic perturbation each flip makes the
// lifted surface lower, so this ends, and there is only one result.
#pragma once

#include "delaunay/lines_over.hpp"

namespace abacus {

class Freeing {
public:
    Freeing(Delaunay<2> &mesh, LineSource &lines);

    /// Frees the edges on the segment from a to b over which the host has no line.
    void free(const Point<2> &a, const Point<2> &b);

private:
    /// An edge that may fail. Its simplex may have gone since, and its slot may be used again.
    struct Edge {
        Link side;
        VertexIndex a, b;
    };

    /// Frees the edge at `from` on the way to b, if there is a fixed one that may be free; returns
    /// its other end.
    Point<2> free_edge(const Point<2> &from, const Point<2> &b);
    void add(Link side);
    bool must_flip(const Edge &edge);
    void flip(Link side);
    void restore();

    Delaunay<2> &mesh_;
    Cache<2> &cache_;
    LinesOver over_;
    Arena<Edge> to_test_;
};

} // namespace abacus
