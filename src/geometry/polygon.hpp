// A polygon in the plane: rings, and inside is what an odd number of them goes around. Exact.
//
// Its rings may nest and touch in points, but not cross or run along one another, as the standard
// of simple features wants it; a hole is a ring inside of another one.
//
// Questions about a place count the edges to its right. To cut something that is linear, the inside
// is divided into trapezoids (the vertical decomposition): each is bounded by two edges, and to the
// left and right by the x of vertices. So all bounds are doubles that were given, and nothing is
// rounded before it is cut. A sweep over the vertices finds them (M. de Berg et al., Computational
// Geometry, chapter 6). It orders vertices lexicographically, as if the plane were sheared a
// little: so vertical edges need no rules of their own, and the trapezoids beside them have no
// width.
#pragma once

#include "geometry/box_tree.hpp"
#include "geometry/predicates.hpp"

#include <cmath>
#include <functional>

namespace abacus {

class Polygon {
public:
    /// The rings one after the other, with `sizes` points; the last of a ring may repeat its first.
    Polygon(const Host &host, const Point<2> *points, const std::size_t *sizes, std::size_t rings);

    /// The same with all its vertices moved, as on a map.
    template <class Move>
    Polygon(const Host &host, const Polygon &other, Move move) : Polygon(host) {
        for (const Edge &edge : other.edges_) add_edge(move(edge.left), move(edge.right));
        finish(host);
    }

    const Box<2> &box() const { return box_; }

    /// +1 inside, 0 on the border, -1 outside.
    int side(const Point<2> &p) const;
    bool contains(const Point<2> &p) const { return side(p) >= 0; }
    /// Whether a part with an area of a triangle of positive orientation is inside.
    bool overlaps(const Corners<2> &triangle) const;
    /// Whether a stretch of a segment, more than points, is inside or on the border.
    bool overlaps(const Point<2> &a, const Point<2> &b) const;

    /// A stretch of a segment that is inside or on the border, from one place to another.
    struct Stretch {
        double from, to; // shares of the segment
        Point<2> first, last;
    };
    /// Calls visit(stretch) for all of a segment, in order. Places are rounded once.
    void cut(const Point<2> &a, const Point<2> &b,
             const std::function<void(const Stretch &)> &visit) const;

    /// A part of the inside: left <= x <= right, above one edge and below another, both of which
    /// lead to the right.
    struct Trapezoid {
        double left, right;
        const Point<2> *lower[2], *upper[2];

        /// Counterclockwise from the left end of the lower edge; rounded.
        Point<2> corner(int i) const {
            const double x = i == 0 || i == 3 ? left : right;
            const Point<2> &a = *(i < 2 ? lower : upper)[0], &b = *(i < 2 ? lower : upper)[1];
            return {x, std::lerp(a[1], b[1], (x - a[0]) / (b[0] - a[0]))};
        }
    };
    /// Calls visit(trapezoid) for all that may meet a box. They have no area in common.
    template <class Visit> void each_part(const Box<2> &box, Visit visit) const {
        part_tree_.visit(box, [&](std::size_t i) {
            const Part &part = parts_[i];
            visit(Trapezoid{part.left,
                            part.right,
                            {&edges_[part.lower].left, &edges_[part.lower].right},
                            {&edges_[part.upper].left, &edges_[part.upper].right}});
            return true;
        });
    }

private:
    explicit Polygon(const Memory &memory)
        : memory_(memory), edges_(memory), edge_tree_(memory), parts_(memory), part_tree_(memory) {}
    void add_edge(const Point<2> &a, const Point<2> &b);
    void finish(const Host &host);

    /// Its ends in lexicographic order.
    struct Edge {
        Point<2> left, right;
    };
    struct Part {
        double left, right;
        std::uint32_t lower, upper;
    };
    class Sweep;
    struct Exact;

    Box<2> box_of(const Part &part) const;
    /// Calls take(a, b) for the edges that meet a box.
    template <class Take> void each_edge(const Box<2> &box, Take take) const {
        edge_tree_.visit(box, [&](std::size_t i) { return take(edges_[i].left, edges_[i].right); });
    }

    /// Whether an edge may meet a box.
    bool has_edge_near(const Box<2> &box) const {
        return !edge_tree_.visit(box, [](std::size_t) { return false; });
    }

    const Memory memory_;
    Arena<Edge> edges_;
    BoxTree<2> edge_tree_;
    Arena<Part> parts_;
    BoxTree<2> part_tree_;
    Box<2> box_;
};

} // namespace abacus
