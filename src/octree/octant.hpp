// Octants: squares and cubes that arise when a domain is halved along every axis, again and again.
// In the plane they are quadrants; one template has both.
//
// An octant is named by the Morton code of its least cell, on a grid of the finest level, and by
// its level: 0 is all of the domain. Its cells are one stretch of the curve, from its code to
// end(). So parents, children and neighbours are arithmetic, and whether one octant lies in another
// is a comparison. The order is that of p4est (Burstedde, Wilcox, Ghattas, 2011): axis 0 varies
// fastest.
#pragma once

#include "keys/locational_code.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <optional>

namespace abacus {

/// The finest level.
template <int D> inline constexpr int finest_level = code_bits<D>;
/// Cells of an axis, and of all of the domain.
template <int D> inline constexpr std::uint64_t axis_cells = std::uint64_t{1} << code_bits<D>;
template <int D>
inline constexpr std::uint64_t domain_cells = std::uint64_t{1} << (D * code_bits<D>);

/// Cells of an octant.
template <int D> constexpr std::uint64_t cells_at(int level) {
    return std::uint64_t{1} << (D * (finest_level<D> - level));
}
/// The coarsest level that has an octant which begins there.
template <int D> constexpr int coarsest_level(std::uint64_t code) {
    return code == 0 ? 0 : std::max(0, finest_level<D> - std::countr_zero(code) / D);
}

/// A way to a neighbour: -1, 0 or 1 on each axis.
template <int D> using Direction = std::array<int, D>;

template <int D> struct Octant {
    static constexpr int children = 1 << D;

    std::uint64_t code = 0;
    int level = 0;

    bool operator==(const Octant &) const = default;

    std::uint64_t cells() const { return cells_at<D>(level); }
    std::uint64_t end() const { return code + cells(); }
    bool contains(std::uint64_t cell) const { return cell - code < cells(); }
    bool is_aligned() const { return (code & (cells() - 1)) == 0; }

    Octant ancestor(int at) const { return {code & ~(cells_at<D>(at) - 1), at}; }
    Octant parent() const { return ancestor(level - 1); }
    Octant child(int i) const {
        return {code + static_cast<std::uint64_t>(i) * cells_at<D>(level + 1), level + 1};
    }
    /// Which child of its parent it is: bit i tells the half of axis i.
    int number() const {
        return static_cast<int>(code >> (D * (finest_level<D> - level))) & (children - 1);
    }

    Cell<D> cell() const { return morton_cell<D>(code); }
    /// Cells along an edge.
    std::uint64_t edge() const { return axis_cells<D> >> level; }

    /// The octant of the same size that way, unless it is outside the domain.
    std::optional<Octant> neighbour(const Direction<D> &way) const {
        Cell<D> at = cell();
        for (int i = 0; i < D; ++i) {
            if (way[i] < 0 ? at[i] == 0 : way[i] > 0 && at[i] + edge() == axis_cells<D>)
                return std::nullopt;
            at[i] += static_cast<std::uint32_t>(static_cast<std::int64_t>(edge()) * way[i]);
        }
        return Octant{morton<D>(at), level};
    }
};

/// The smallest octant that has both cells.
template <int D> constexpr Octant<D> nearest_common(std::uint64_t a, std::uint64_t b) {
    const int bits = std::bit_width(a ^ b);
    return Octant<D>{a, finest_level<D>}.ancestor(finest_level<D> - (bits + D - 1) / D);
}

/// The first cell of a region on the curve, from `from` on; domain_cells if there is none. The
/// region tells which octants it meets and which it contains; of one that it meets it meets a
/// child.
template <int D, class Region>
std::uint64_t next_cell(const Region &region, std::uint64_t from, const Octant<D> &within = {}) {
    if (within.end() <= from || !region.meets(within)) return domain_cells<D>;
    if (within.level == finest_level<D> || region.contains(within))
        return std::max(from, within.code);
    for (int i = 0; i < Octant<D>::children; ++i)
        if (const std::uint64_t cell = next_cell(region, from, within.child(i));
            cell != domain_cells<D>)
            return cell;
    return domain_cells<D>;
}

/// Cells from `least` to `greatest`, both included, on each axis.
template <int D> struct CellBox {
    Cell<D> least, greatest;

    bool meets(const Octant<D> &octant) const {
        const Cell<D> at = octant.cell();
        for (int i = 0; i < D; ++i)
            if (at[i] > greatest[i] || at[i] + octant.edge() <= least[i]) return false;
        return true;
    }
    bool contains(const Octant<D> &octant) const {
        const Cell<D> at = octant.cell();
        for (int i = 0; i < D; ++i)
            if (at[i] < least[i] || at[i] + octant.edge() - 1 > greatest[i]) return false;
        return true;
    }
    std::uint64_t next(std::uint64_t from) const { return next_cell<D>(*this, from); }
};

} // namespace abacus
