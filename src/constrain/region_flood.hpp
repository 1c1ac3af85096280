// Floods triangles: puts all that can be reached into a region, or takes them out of it.
//
// Some triangles at a time, those of one page first. Then the cache is trimmed, so what is still to
// be looked around is kept as edges by their places, the last one first. What there is no room for
// goes to a spool.
#pragma once

#include "constrain/touching_edges.hpp"
#include "delaunay/delaunay.hpp"
#include "geometry/box.hpp"
#include "sort/record_spool.hpp"

#include <abacus/regions.h>

#include <optional>

namespace abacus {

/// Why a region cannot be, with a place and, if there is one, an edge at it.
inline abacus_region_fault region_fault(abacus_region_fault_kind kind, RegionNumber region,
                                        RegionNumber other, const Point<2> &place = {},
                                        const Point<2> &a = {}, const Point<2> &b = {}) {
    return {kind, region, other, {place[0], place[1]}, {{a[0], a[1]}, {b[0], b[1]}}, 0, 0};
}

class RegionFlood {
public:
    /// How far it goes:
    enum class Rule {
        outline, // to triangles that are in another region, or marked as outside
        seed,    // to fixed edges
        face,    // to fixed edges, and takes triangles out of the region
        clear    // to triangles that are not in the region; takes them out of it
    };

    explicit RegionFlood(Delaunay<2> &mesh);

    /// `touching` gets the edges met between the region and another one, with the rule `outline`.
    void begin(Rule rule, RegionNumber region, TouchingEdges *touching = nullptr);
    /// Takes a triangle, and will look around it.
    void take(Handle h);
    /// The same for one of many, between which the mesh may finish.
    void take_later(Handle h) {
        set(h);
        put_off(h);
    }
    /// Takes all that can be reached; false, and `fault` says why, if it must not be. All that was
    /// cached may be gone.
    bool run(abacus_region_fault &fault);

    /// Of seeds: the box of the fixed edges met, and so of all that has been taken.
    const Box<2> &box() const { return box_; }

    /// What triangles beyond an outline are marked with while it is flooded.
    static constexpr RegionNumber outside = most_regions;

    /// The triangle on the left of the edge from a to b, as the link of that edge; throws unless
    /// there is such an edge.
    static Link left_of(Delaunay<2> &mesh, const Point<2> &a, const Point<2> &b);

private:
    // Of a triangle to be looked around: an edge with it on the left.
    static constexpr std::size_t edge_words = 4, triangles_at_once = 8192,
                                 most_pending = std::size_t{1} << 15;

    bool clears() const { return rule_ == Rule::face || rule_ == Rule::clear; }
    bool ends_at_fixed() const { return rule_ == Rule::face || rule_ == Rule::seed; }
    void set(Handle h);
    bool look_around(Handle h, abacus_region_fault &fault);
    bool next(Handle &h);
    void put_off();
    void put_off(Handle h);
    void read_back();
    /// Takes back a triangle that was put off; false if there is none.
    bool resume();

    Delaunay<2> &mesh_;
    Cache<2> &cache_;
    Rule rule_ = Rule::seed;
    RegionNumber region_ = no_region;
    TouchingEdges *touching_ = nullptr;
    Box<2> box_;
    Arena<Handle> near_, far_; // to be looked around: in the page of the last one, and elsewhere
    BlockIndex page_ = no_block;
    using Edge = std::array<std::uint64_t, edge_words>;
    Arena<Edge> pending_;
    std::optional<RecordSpool> spools_[2]; // of those for which there is no room, by turns
    int writing_ = 0;                      // the one that gets more; the other is being read
};

} // namespace abacus
