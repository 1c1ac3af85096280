// Cuts a triangle by levels and by a window into pieces of contours.
//
// The part of a triangle in the window is a convex polygon; this is cut. Its corners are corners of
// the triangle, places where an edge of the triangle meets a side of the window, and corners of the
// window. A corner whose value is a level counts as above it. So around the polygon the level is
// crossed upwards as often as downwards. From each upward crossing a piece leads to the next
// downward one, with higher ground to its right. This holds for any values; rounding cannot break
// it.
//
// The end of a piece is a node. Pieces that meet there have equal nodes: the same kind, and the
// same edge. Everything on an edge of the triangulation is computed from the edge alone, with its
// ends in lexicographic order. So the triangles on both sides agree to the bit. Where a contour
// crosses a side of the window, the crossing is computed from the uncut contour. So the windows on
// both sides agree.
//
// A band is the region between two levels. The pieces around it along levels and along sides of the
// window are made here; those along edges without a triangle on the other side are made once these
// edges are known (contour_rims.hpp). Bands lie to the left of their pieces.
#pragma once

#include "geometry/box.hpp"
#include "geometry/predicates.hpp"
#include "query/levels/contour_levels.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace abacus {

/// The kind of a node, or the first of several kinds.
enum class ContourKind : std::uint8_t {
    end,          // of a line, at a side of the window: pieces do not meet there
    crossing,     // of an edge with a level
    lower,        // the same for a band and the level below it
    upper,        // ... and the level above it
    rim,          // a vertex at the rim of the mesh, named by the rim's edge that begins there
    edge_at_side, // + side
    corner = edge_at_side + 4,    // + 0 to 3, of the window
    crossing_at_side = corner + 4 // + 4 * side + 2 if upwards + 1 if of the upper level
};

constexpr ContourKind operator+(ContourKind first, int n) {
    return static_cast<ContourKind>(static_cast<int>(first) + n);
}

/// A vertex. Several may be at one place, distinguished by their ids: the edges on the two sides of
/// a fault are different edges.
struct ContourPoint : Point<2> {
    std::int64_t id = 0;
};
using ContourCorners = std::array<const ContourPoint *, 3>;

/// Points are distinguished by their addresses in memory: a vertex has one point within a page.
struct ContourNode {
    ContourKind kind = ContourKind::end;
    const ContourPoint *a = nullptr, *b = nullptr; // ends of an edge

    bool operator==(const ContourNode &) const = default;
};

struct ContourEnd {
    Point<2> place;
    ContourNode node;
};

/// A straight piece, of a level or a band.
struct ContourPiece {
    std::int64_t level;
    ContourEnd tail, head;
};

/// The sides of a window: the lower and upper bound of x, then those of y.
class ContourWindow {
public:
    explicit ContourWindow(const abacus_window &window);

    bool is_bounded() const { return box_.has_value(); }
    bool contains(const Point<2> &p) const { return !box_ || box_->contains(p); }
    static int axis(int side) { return side / 2; }
    double bound(int side) const {
        return side % 2 == 0 ? box_->lower[axis(side)] : box_->upper[axis(side)];
    }
    bool is_inside(const Point<2> &p, int side) const {
        return side % 2 == 0 ? p[axis(side)] >= bound(side) : p[axis(side)] <= bound(side);
    }

private:
    std::optional<Box<2>> box_;
};

/// An edge of the triangulation.
struct ContourEdge {
    const ContourPoint *a, *b; // the lexicographically lesser first
    double value_a, value_b;

    ContourEdge() = default;
    ContourEdge(const ContourPoint &p, double value_p, const ContourPoint &q, double value_q);

    Point<2> crossing(double level) const;
    /// The same on the part between two places of the edge, which it does not leave by rounding.
    Point<2> crossing(double level, const Point<2> &from, const Point<2> &to) const;
};

/// A corner of a polygon, and the line from there to the next one.
struct ContourCorner {
    Point<2> place;
    double value;
    std::int64_t rank; // of the value
    ContourNode node;
    int line; // 0 to 2: an edge of the triangle; 3 + a side of the window
};

/// Where an edge meets a side: one of its ends must be inside, the other not.
ContourCorner meet(const ContourEdge &edge, int side, const ContourWindow &window,
                   const ContourLevels &levels);

/// The part of an edge in the window, in the direction of these corners; false if there is none.
bool clip(const ContourEdge &edge, const ContourWindow &window, const ContourLevels &levels,
          ContourCorner &from, ContourCorner &to);

/// Calls put(piece) for each piece of a straight line from one corner to another, along which bands
/// follow one another. end(level, has_upper) is where it crosses a level, as seen from the band on
/// one side of it.
template <class CrossingEnd, class Put>
void cut_into_bands(const ContourCorner &from, const ContourCorner &to, CrossingEnd end, Put put) {
    ContourEnd tail{from.place, from.node};
    std::int64_t band = from.rank;
    while (band != to.rank) {
        const bool rises = band < to.rank;
        const std::int64_t level = rises ? band + 1 : band;
        put(ContourPiece{band, tail, end(level, rises)});
        tail = end(level, !rises);
        band += rises ? 1 : -1;
    }
    put(ContourPiece{band, tail, {to.place, to.node}});
}

class ContourCut {
public:
    ContourCut(const ContourWindow &window, const ContourLevels &levels, bool bands)
        : window_(window), levels_(levels), bands_(bands) {}

    /// Takes a triangle in positive orientation; false if its interior does not meet the window.
    bool take(const ContourCorners &corners, const std::array<double, 3> &values,
              const std::array<std::int64_t, 3> &ranks);
    /// The least and the greatest rank in the window.
    ContourRanks ranks() const {
        std::int64_t least = polygon_[0].rank, greatest = least;
        for (int i = 1; i < size_; ++i) {
            least = std::min(least, polygon_[i].rank);
            greatest = std::max(greatest, polygon_[i].rank);
        }
        return {least, greatest};
    }
    /// Calls put(piece) for each of its pieces.
    template <class Put> void each(Put put) const {
        const auto [least, greatest] = ranks();
        for (std::int64_t level = least + 1; level <= greatest; ++level) cross(level, put);
        if (!bands_ || !is_cut_) return;
        for (int i = 0; i < size_; ++i)
            if (polygon_[i].line > 2)
                cut_into_bands(
                    polygon_[i], next(i),
                    [&](std::int64_t level, bool is_upper) {
                        return end(i, level, is_upper ? ContourKind::upper : ContourKind::lower);
                    },
                    put);
    }

private:
    static constexpr int most_corners = 12;

    const ContourCorner &next(int i) const { return polygon_[i + 1 < size_ ? i + 1 : 0]; }
    bool is_crossed(int i, std::int64_t level) const {
        return (polygon_[i].rank < level) != (next(i).rank < level);
    }
    template <class Put> void cross(std::int64_t level, Put &put) const {
        for (int up = 0; up < size_; ++up) {
            if (!is_crossed(up, level) || polygon_[up].rank >= level) continue;
            int down = up;
            do down = down + 1 < size_ ? down + 1 : 0;
            while (!is_crossed(down, level));
            if (!bands_) {
                put(ContourPiece{level, end(up, level, ContourKind::crossing),
                                 end(down, level, ContourKind::crossing)});
                continue;
            }
            put(ContourPiece{level, end(down, level, ContourKind::lower),
                             end(up, level, ContourKind::lower)});
            put(ContourPiece{level - 1, end(up, level, ContourKind::upper),
                             end(down, level, ContourKind::upper)});
        }
    }

    void clip();
    void clip(int side);
    ContourCorner window_corner(int side, int other) const;
    ContourEnd end(int i, std::int64_t level, ContourKind kind) const;
    Point<2> crossing_at_side(int i, std::int64_t level) const;

    const ContourWindow &window_;
    const ContourLevels &levels_;
    const bool bands_;
    ContourCorners corners_{};
    std::array<double, 3> values_{};
    std::array<std::int64_t, 3> ranks_{};
    std::array<ContourEdge, 3> edges_; // from a corner to the next
    bool is_cut_ = false;              // by the window
    std::array<ContourCorner, most_corners> polygon_;
    int size_ = 0;
};

} // namespace abacus
