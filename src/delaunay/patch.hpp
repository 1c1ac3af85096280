// A part of a triangulation in the plane that is made anew within its boundary: where a segment has
// been put through triangles, or a vertex has been taken out of a constrained mesh.
//
// First any triangulation of the part is made, from polygons:
//
//   chain   a polygon all of whose corners can be seen from one of its edges. Ears are cut off in
//   one
//           pass along the others (Toussaint and Avis 1982). The polygon may be weakly simple:
//           where an edge dangles into it, it has the edge twice, once for each side.
//   star    a polygon all of whose corners can be seen from a place inside: ears that leave the
//   place
//           inside or on the boundary are cut off
//   fan     a polygon with the point at infinity: a ghost on each edge of its rest
//
// Then edges that fail the in-circle test, and are not fixed, are flipped until none is left
// (Lawson 1977). Ghosts take part: a flip between two of them closes a notch of the hull. Under the
// symbolic perturbation there is only one result, the constrained Delaunay triangulation of the
// part. The pieces have links among themselves only; they become simplices of the mesh at the end.
#pragma once

#include "delaunay/delaunay.hpp"

#include <span>

namespace abacus {

class Patch {
public:
    /// What is across an edge: an edge of a piece, or one that outside() has made known.
    enum class Side : std::uint32_t {};
    static constexpr Side unknown{0xffffffffu};

    explicit Patch(Delaunay<2> &mesh);

    void begin();
    /// An edge of a simplex that stays. Both its sides must be cached.
    Side outside(Link edge);
    /// Both sides of an edge with the part on either side, for two edges of a chain.
    std::array<Side, 2> inside(bool is_fixed);

    /// Corners counterclockwise, beyond[i] from corner i to the next; the edge from the last to the
    /// first is the one that sees all. Returns its inner side, or what is beyond the only edge if
    /// there are but two corners.
    Side fill_chain(std::span<const VertexIndex> corners, std::span<const Side> beyond);
    /// Of at least three corners, counterclockwise around `inside`.
    void fill_star(std::span<const VertexIndex> corners, std::span<const Side> beyond,
                   const Point<2> &inside);
    /// The first corner is the point at infinity.
    void fill_fan(std::span<const VertexIndex> corners, std::span<const Side> beyond);
    /// One piece, with what is beyond the edge opposite each corner.
    Side add(const std::array<VertexIndex, 3> &corners, const std::array<Side, 3> &beyond);
    /// Makes two sides one edge.
    void join(Side a, Side b, bool is_fixed);

    /// Flips edges, then creates the simplices. Returns how many.
    std::size_t finish();

private:
    struct Piece {
        std::array<VertexIndex, 3> vertex;
        std::array<Side, 3> beyond;
        unsigned fixed;
    };
    struct Pair { // of what outside() has numbered
        std::array<Side, 2> side;
        bool is_fixed;
    };
    struct Corner {
        VertexIndex vertex;
        Side beyond; // from it to the next
        std::uint32_t previous, next;
    };
    static constexpr std::uint32_t outside_bit = 0x80000000u;

    static Side side(std::size_t piece, int facet) {
        return Side{static_cast<std::uint32_t>(piece << 2) | static_cast<std::uint32_t>(facet)};
    }
    static bool is_outside(Side s) { return (static_cast<std::uint32_t>(s) & outside_bit) != 0; }
    static std::uint32_t number(Side s) { return static_cast<std::uint32_t>(s) & ~outside_bit; }
    static std::uint32_t piece_of(Side s) { return number(s) >> 2; }
    static int facet_of(Side s) { return static_cast<int>(number(s) & 3); }

    bool is_ear(const Corner &corner, const Point<2> &inside, bool may_touch) const;
    void cut_ear(std::uint32_t corner);
    int turn(VertexIndex a, VertexIndex b, VertexIndex c) const {
        return orientation(cache_.point(a), cache_.point(b), cache_.point(c));
    }
    /// Makes the pairs of inside() edges of pieces.
    void join_pairs();
    bool must_flip(Side s) const;
    void flip(Side s);
    void improve();
    void create_all();

    Delaunay<2> &mesh_;
    Cache<2> &cache_;
    Arena<Piece> pieces_;
    Arena<Link> outer_; // `unset` of pairs
    Arena<Pair> pairs_;
    Arena<Corner> corners_;
    Arena<Side> to_test_;
    Arena<Handle> created_;
};

} // namespace abacus
