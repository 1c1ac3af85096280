// Finds the rings that remain when holes are filled: those that lie in no hole.
//
// From the least vertex of an outline a ray goes in the direction (-1, -e), with an infinitesimal
// e, through what is not kept. It ends at infinity, or at an edge of the border. If this edge
// belongs to a hole, the outline is an island in it, and is filled as well. If it belongs to an
// outline, both lie in the same holes, or in none. The edge has a vertex that comes before the
// ray's. So the other outline comes before this one in the order of rings, and one pass over all of
// them decides. Where outlines meet in the vertex, the ray ends there at once.
//
// The second coordinate of a vertex alone decides on which side of the ray it is.
#pragma once

#include "query/shapes/rings.hpp"

namespace abacus {

class RingNesting {
public:
    /// `longest`: the number of simplices, ghosts included; no ray goes through more.
    RingNesting(Reader<2> &reader, const Kept &kept, Rings &rings, std::uint64_t longest,
                std::size_t memory);

    /// Whether a ring is an outline that lies in no hole.
    bool is_outermost(std::uint64_t ring) const {
        return (is_outermost_[ring / 64] >> ring % 64 & 1) != 0;
    }

private:
    void list_edges(Rings &rings, RecordSort &edges, RecordSort &rays);
    void add_edge(RecordSort &edges, const Rings::Visit &from, const Point<2> &to) const;
    /// Goes from a ring's first edge to the edge at which the ray ends; false if there is none.
    bool follow_ray(Border::Edge &edge);
    /// Turns around the edge's first vertex, clockwise, through triangles that are not kept: to the
    /// triangle that the ray goes through, and takes its edge opposite the vertex; or to an edge of
    /// a kept triangle. False at infinity.
    bool turn_to_ray(Border::Edge &edge, bool &is_at_ray);
    /// Whether the ray from a corner of a triangle goes through it.
    bool has_ray(Handle h, int corner) const;
    void decide(RecordSort &edges, RecordSort &rays, std::size_t memory);

    const Host &host_;
    Cache<2> &cache_;
    Border border_;
    const std::uint64_t longest_;
    Arena<std::uint64_t> is_outermost_; // a bit each
};

} // namespace abacus
