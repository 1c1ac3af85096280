// The fixed edges of a tile, each once, hard ones and soft ones.
//
// Both triangles of an edge add it. If a tile has too many edges, their ends are moved to a coarser
// grid, on which some fall together and the shortest vanish; and to the next coarser one, until
// they are few. So memory is bounded, and the result does not depend on the order in which edges
// come.
#pragma once

#include "mesh/fixed_facets.hpp"
#include "tiles/tile_lines.hpp"

namespace abacus {

class FixedLines {
public:
    /// The most segments that a tile gets.
    static constexpr std::size_t most = 16000;

    explicit FixedLines(const Host &host) : host_(host), segments_(host) {}

    /// An edge, in units of the tile.
    void add(Fixed kind, const Point<2> &a, const Point<2> &b);
    void clear() {
        segments_.clear();
        shift_ = 0;
    }
    /// A feature for each kind, which is its only tag.
    void put_into(VectorLayer &layer);

private:
    struct Segment {
        Fixed kind;
        TilePoint from, to; // cells of the grid, in order
        bool operator==(const Segment &) const = default;
        bool operator<(const Segment &s) const {
            return std::tie(kind, from, to) < std::tie(s.kind, s.from, s.to);
        }
    };

    void remove_repeated();
    void coarsen();
    /// The middle of a cell, in units of the tile.
    TilePoint middle(TilePoint cell) const;

    const Host &host_;
    Arena<Segment> segments_;
    int shift_ = 0; // cells have sides of 2^shift_ units
};

} // namespace abacus
