// Which rings are left where holes are filled: those that lie in no hole.
//
// From the least vertex of an outline a ray goes in the direction (-1, -e), with an infinitesimal
// e, through what is not kept. It ends at infinity, or at an edge of the border. That may belong to
// a hole: then the outline is an island in it, and is filled as well. Or it belongs to an outline:
// then both lie in the same holes, or in none. The edge has a vertex that comes before the ray's.
// So the other outline comes before this one in the order of rings, and one run along all of them
// decides. Where outlines meet in the vertex, the ray ends there at once.
//
// Which side of the ray a vertex is on its second coordinate alone tells.
#pragma once

#include "query/shapes/rings.hpp"

namespace abacus {

class RingNesting {
public:
    /// `longest`: simplices of the mesh, ghosts included. No ray goes through more.
    RingNesting(Reader<2> &reader, const Kept &kept, Rings &rings, std::uint64_t longest,
                std::size_t memory);

    /// Whether a ring is an outline that lies in no hole.
    bool is_outermost(std::uint64_t ring) const {
        return (is_outermost_[ring / 64] >> ring % 64 & 1) != 0;
    }

private:
    void list_edges(Rings &rings, RecordSort &edges, RecordSort &rays);
    void add_edge(RecordSort &edges, const Rings::Visit &from, const Point<2> &to) const;
    /// Goes from a ring's first edge to what the ray ends at; false if there is nothing.
    bool follow_ray(Border::Edge &edge);
    /// Turns around the edge's first vertex, clockwise, through what is not kept: to the triangle
    /// that the ray goes through, whose edge opposite the vertex it takes, or to an edge of what is
    /// kept. False at infinity.
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
