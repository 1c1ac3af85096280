// Puts segments into a mesh in the plane, as fixed edges.
//
// The ends of a segment are vertices. From one end to the other it leads along edges, which become
// fixed, or across triangles. Between two vertices that lie on the segment, the triangles that it
// crosses are replaced: the polygon on either side of it is triangulated anew (patch.hpp), and its
// new edge is fixed. No other triangle changes, since a fixed edge only takes from what a circle
// can see (Chew 1989; Anglada 1997). Where an edge dangles into a polygon, its two sides meet
// again.
//
// So a long segment is put in piece by piece. If a piece crosses many triangles, some of them at a
// time are replaced by others of which the segment crosses as few as possible: those of a funnel
// along it (pieces.hpp). Then it crosses these, and goes on. So few pages are in memory together.
// Edges that the funnels have left beside the segment may fail the test. They are kept, and
// restored when it has been put in (restoring.hpp). A thread that keeps within an interval leaves
// such segments to the session.
#pragma once

#include "constrain/restoring.hpp"
#include "delaunay/patch.hpp"
#include "sort/record_spool.hpp"
#include "traverse/straight.hpp"

#include <optional>

namespace abacus {

class Fixing {
public:
    /// `most_crossed`: the triangles that are replaced at a time, unless the segment crosses most
    /// of a funnel's.
    explicit Fixing(Delaunay<2> &mesh, std::size_t most_crossed = 256);

    /// Fixes the segment from a to b, which is hard or soft. An edge that is hard stays so. Throws
    /// an Error (argument) if one is not a vertex, and one (crossing) if the segment crosses a
    /// fixed edge, before it changes anything there.
    void fix(const Point<2> &a, const Point<2> &b, Fixed how);
    /// The same in a cache that keeps within an interval: false if the segment leaves it, or
    /// crosses a fixed edge. A part of it may be fixed then.
    bool fix_within(const Point<2> &a, const Point<2> &b, Fixed how);

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

    void go(const Point<2> &a, const Point<2> &b, Fixed how);
    /// Fixes the part from a vertex on the segment to the next one, which it returns.
    Point<2> advance(const Point<2> &from, const Point<2> &b);
    Point<2> fix_edge(const Way &way, const Point<2> &from, const Point<2> &b);
    Point<2> force_edge(const Way &way, const Point<2> &b);
    /// Finds the triangles that are crossed; returns the vertex where they end, or the one where
    /// they begin if there are too many.
    VertexIndex cross(const Way &way, const Point<2> &b);
    /// Replaces the triangles found by a funnel and what is beside it.
    void make_funnel();
    /// Fills both sides of the edge between the ends of the banks.
    void fill_sides();
    /// Restores the edges beside funnels.
    void restore();
    void require_within(const Bank &bank) const;
    void require_free(Link edge, const Point<2> &from, const Point<2> &b) const;
    void cut_out();
    /// Makes the sides of both banks known to the patch.
    void begin_patch();
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
    Link closing_ = unset; // the edge behind them, if there are too many
    Bank left_, right_;
    Arena<Patch::Side> left_sides_, right_sides_;
    Arena<Dangling> dangling_;
    const std::size_t most_crossed_;
    // Of the present segment:
    Fixed how_ = Fixed::no;
    bool stays_within_ = false;
    std::size_t limit_ = 0;             // triangles that are replaced at a time
    std::optional<RecordSpool> beside_; // the ends of edges to be restored
};

} // namespace abacus
