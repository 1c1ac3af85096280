// Triangles in memory that make up a part of a triangulation in the plane.
//
// First any triangulation of the part is made: from triangles, or from polygons:
//
//   chain   a polygon all of whose corners can be seen from one of its edges. Ears are cut off in
//           one pass along the others (Toussaint and Avis 1982). The polygon may be weakly simple:
//           where an edge dangles into it, it has the edge twice, once for each side.
//   star    a polygon all of whose corners can be seen from a place inside: ears that leave the
//           place inside or on the boundary are cut off
//   fan     a polygon with the point at infinity: a ghost on each edge of its rest
//   funnel  a polygon through which a straight line leads from a corner across the edge opposite.
//           First each of its two banks is cut as a chain is. What is left between them has corners
//           that bend inwards, but for three, and its triangles are cut off from the far edge on:
//           the line crosses these alone.
//
// Then edges that fail the in-circle test, and are not fixed, are flipped until none is left
// (Lawson 1977). Ghosts take part: a flip between two of them closes a notch of the hull. Under the
// symbolic perturbation there is only one result, the constrained Delaunay triangulation of the
// part. The pieces have links among themselves only.
#pragma once

#include "mesh/cache.hpp"

#include <span>

namespace abacus {

class Pieces {
public:
    /// What is across an edge: an edge of a piece, or one that outside() has made known.
    enum class Side : std::uint32_t {};
    static constexpr Side unknown{0xffffffffu};

    struct Piece {
        std::array<VertexIndex, 3> vertex;
        std::array<Side, 3> beyond;
        FixedFacets<2> fixed;
    };

    explicit Pieces(Cache<2> &cache)
        : cache_(cache), pieces_(cache.host()), outside_(cache.host()), corners_(cache.host()),
          bank_(cache.host()), to_test_(cache.host()) {}

    void clear() {
        pieces_.clear();
        outside_.clear();
        region_ = no_region;
    }
    std::size_t size() const { return pieces_.size(); }
    const Piece &operator[](std::size_t n) const { return pieces_[n]; }

    static Side side(std::size_t piece, int facet) {
        return Side{static_cast<std::uint32_t>(piece << 2) | static_cast<std::uint32_t>(facet)};
    }
    static bool is_outside(Side s) { return (static_cast<std::uint32_t>(s) & outside_bit) != 0; }
    /// Counts what is outside, in the order in which it was made known.
    static std::uint32_t number(Side s) { return static_cast<std::uint32_t>(s) & ~outside_bit; }
    static std::uint32_t piece_of(Side s) { return number(s) >> 2; }
    static int facet_of(Side s) { return static_cast<int>(number(s) & 3); }

    /// The region of the pieces that are made from now on, but for ghosts.
    void set_region(RegionNumber region) { region_ = region; }
    /// An edge of a triangle that stays.
    Side outside(Fixed how) {
        outside_.push_back(how);
        return Side{static_cast<std::uint32_t>(outside_.size() - 1) | outside_bit};
    }
    /// Corners counterclockwise, beyond[i] from corner i to the next; the edge from the last to the
    /// first is the one that sees all. Returns its inner side, or what is beyond the only edge if
    /// there are but two corners.
    Side fill_chain(std::span<const VertexIndex> corners, std::span<const Side> beyond);
    /// Of at least three corners, counterclockwise around `inside`.
    void fill_star(std::span<const VertexIndex> corners, std::span<const Side> beyond,
                   const Point<2> &inside);
    /// The first corner is the point at infinity.
    void fill_fan(std::span<const VertexIndex> corners, std::span<const Side> beyond);
    /// From the corner where both banks begin: the right one counterclockwise, the left one
    /// clockwise, `beyond` along each as for a chain, seen in its direction, and `end` beyond the
    /// edge that joins their ends. Returns how many pieces the line does not cross, which come
    /// first.
    std::size_t fill_funnel(std::span<const VertexIndex> right, std::span<const Side> beyond_right,
                            std::span<const VertexIndex> left, std::span<const Side> beyond_left,
                            Side end);
    /// One piece, with what is beyond the edge opposite each corner.
    Side add(const std::array<VertexIndex, 3> &corners, const std::array<Side, 3> &beyond);
    /// Makes two sides one edge. It is fixed as it is said, or as an edge outside is.
    void join(Side a, Side b, Fixed how);
    /// Flips edges until none fails the test.
    void improve();
    /// Whether a place is in the circle around a piece, under the perturbation.
    bool is_in_circle(std::size_t piece, const Point<2> &p) const;

protected:
    /// Brings the point at infinity to the end of a piece's corners.
    void bring_infinity_last(std::size_t piece);

    Cache<2> &cache_;

private:
    struct Corner {
        VertexIndex vertex;
        Side beyond; // from it to the next
        std::uint32_t previous, next;
    };
    static constexpr std::uint32_t outside_bit = 0x80000000u;

    /// Cuts the ears of a polygon, but not at its ends, in one pass. What is left is in corners_.
    void cut_ears(std::span<const VertexIndex> corners, std::span<const Side> beyond);
    bool is_ear(const Corner &corner, const Point<2> &inside, bool may_touch) const;
    void cut_ear(std::uint32_t corner);
    int turn(VertexIndex a, VertexIndex b, VertexIndex c) const {
        return orientation(cache_.point(a), cache_.point(b), cache_.point(c));
    }
    bool must_flip(Side s) const;
    void flip(Side s);

    Arena<Piece> pieces_;
    RegionNumber region_ = no_region;
    Arena<Fixed> outside_;
    Arena<Corner> corners_;
    Arena<Corner> bank_; // the right one of a funnel
    Arena<Side> to_test_;
};

} // namespace abacus
