// Puts segments into a mesh in the plane, as fixed edges.
//
// The ends of a segment are vertices. From one end to the other it leads along edges, which become
// fixed, or across triangles. Between two vertices that lie on the segment, the triangles that it
// crosses are replaced: the polygon on either side of it is triangulated anew (patch.hpp), and its
// new edge is fixed. No other triangle changes, since a fixed edge only takes from what a circle
// can see (Chew 1989; Anglada 1997). Where an edge dangles into a polygon, its two sides meet
// again.
//
// So a long segment is put in piece by piece, and only the pages of one piece are in memory
// together.
#pragma once

#include "delaunay/patch.hpp"
#include "traverse/straight.hpp"

namespace abacus {

class Fixing {
public:
    explicit Fixing(Delaunay<2> &mesh);

    /// Fixes the segment from a to b. Throws an Error (argument) if one is not a vertex, and one
    /// (crossing) if the segment crosses a fixed edge, before it changes anything there.
    void fix(const Point<2> &a, const Point<2> &b);
    /// The same in a cache that keeps within an interval: false if the segment leaves it, or
    /// crosses a fixed edge. A part of it may be fixed then.
    bool fix_within(const Point<2> &a, const Point<2> &b);

private:
    /// Of a side of the segment: its vertices from one end to the other, and the edges between
    /// them, from the triangles that are crossed.
    struct Bank {
        explicit Bank(const Memory &memory) : vertices(memory), edges(memory) {}
        void begin(VertexIndex v) {
            vertices.clear();
            edges.clear();
            vertices.push_back(v);
        }
        void add(Link edge, VertexIndex v) {
            edges.push_back(edge);
            vertices.push_back(v);
        }
        Arena<VertexIndex> vertices;
        Arena<Link> edges;
    };

    /// Fixes the part from a vertex on the segment to the next one, which it returns.
    Point<2> advance(const Point<2> &from, const Point<2> &b);
    Point<2> fix_edge(const Way &way, const Point<2> &from, const Point<2> &b);
    Point<2> force_edge(const Way &way, const Point<2> &b);
    /// Finds the triangles that are crossed; returns the vertex where they end.
    VertexIndex cross(const Way &way, const Point<2> &b);
    void require_within(const Bank &bank) const;
    void require_free(Link edge, const Point<2> &from, const Point<2> &b) const;
    void cut_out();
    /// Makes the sides of both banks known to the patch.
    void meet(const Bank &bank, Arena<Patch::Side> &sides);
    void pair_up();

    /// An edge of a bank with a crossed triangle on either side.
    struct Dangling {
        Link inner, outer;
        Patch::Side *side;
    };

    Delaunay<2> &mesh_;
    Cache<2> &cache_;
    Patch patch_;
    Arena<Handle> crossed_;
    Bank left_, right_;
    Arena<Patch::Side> left_sides_, right_sides_;
    Arena<Dangling> dangling_;
};

} // namespace abacus
