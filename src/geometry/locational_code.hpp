// Locational codes: positions on a Morton (Z-order) curve over the mesh's
// domain (dissertation §4.8).
//
// A coordinate is first quantized to `bits` bits. The key of a simplex is the
// code of the integer mean of its vertices' quantized coordinates. Integer
// sums do not depend on the order of the summands, so every writer and reader
// computes the same key, whatever the order of the vertices and the rounding
// mode, and none has to sort them first.
//
// Codes serve for clustering only: no geometric decision depends on them, and
// points outside the domain clamp to its border. Where many simplices share one
// code (a tight cluster, coordinates of very different magnitude), the key goes
// on in a second word, `part`: further bits of the coordinates inside the
// cell, then a hash of the vertices that tells apart what no position can.
#pragma once

#include "geometry/point.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace abacus {

/// Bits an axis of a code.
template <int D> inline constexpr int code_bits = D == 2 ? 31 : 21;
/// Bits an axis that a part adds.
template <int D> inline constexpr int part_bits = D == 2 ? 20 : 14;

template <int D> using Cell = std::array<std::uint32_t, D>;

/// Moves bit i of the low bits to bit D*i.
template <int D> constexpr std::uint64_t spread_bits(std::uint64_t x) {
    if constexpr (D == 2) {
        x &= 0xffffffffu;
        x = (x | x << 16) & 0x0000ffff0000ffffull;
        x = (x | x << 8) & 0x00ff00ff00ff00ffull;
        x = (x | x << 4) & 0x0f0f0f0f0f0f0f0full;
        x = (x | x << 2) & 0x3333333333333333ull;
        x = (x | x << 1) & 0x5555555555555555ull;
    } else {
        x &= 0x1fffff;
        x = (x | x << 32) & 0x001f00000000ffffull;
        x = (x | x << 16) & 0x001f0000ff0000ffull;
        x = (x | x << 8) & 0x100f00f00f00f00full;
        x = (x | x << 4) & 0x10c30c30c30c30c3ull;
        x = (x | x << 2) & 0x1249249249249249ull;
    }
    return x;
}

/// Locational code of a cell: axis 0 in the least significant bit of each group.
template <int D> constexpr std::uint64_t morton(const Cell<D> &cell) {
    std::uint64_t code = 0;
    for (int i = 0; i < D; ++i) code |= spread_bits<D>(cell[i]) << i;
    return code;
}

/// The cell with this code; the end of the curve, 2^63 in 3D and 2^62 in 2D, has the
/// cell just beyond axis 0.
template <int D> constexpr Cell<D> cell_of(std::uint64_t code) {
    Cell<D> cell{};
    for (int bit = 0; bit < 64; ++bit)
        cell[bit % D] |= static_cast<std::uint32_t>(code >> bit & 1) << (bit / D);
    return cell;
}

/// Whether a comes before b on the curve, without computing their codes: the axis with
/// the highest differing bit decides (Chan, "A minimalist's implementation of an
/// approximate nearest neighbor algorithm", 2006).
template <int D> constexpr bool morton_less(const Cell<D> &a, const Cell<D> &b) {
    int axis = D - 1;
    std::uint32_t top = a[axis] ^ b[axis];
    for (int i = D - 2; i >= 0; --i) {
        const std::uint32_t differing = a[i] ^ b[i];
        if (top < (differing & ~top)) {
            axis = i;
            top = differing;
        }
    }
    return a[axis] < b[axis];
}

/// Mean, rounded down, of the cells of a simplex's corners; of a ghost, whose last
/// corner is not read, that of its hull facet's. Its code is the simplex's key.
template <int D>
inline Cell<D> mean_cell(const std::array<const Cell<D> *, D + 1> &cells, bool ghost) {
    Cell<D> mean;
    for (int axis = 0; axis < D; ++axis) {
        std::uint64_t sum = 0;
        for (int i = 0; i < D; ++i) sum += (*cells[i])[axis];
        mean[axis] = static_cast<std::uint32_t>(ghost ? sum / D
                                                      : (sum + (*cells[D])[axis]) / (D + 1));
    }
    return mean;
}

/// Box over which the codes of a mesh are taken.
template <int D> class Domain {
public:
    Domain() : Domain(Point<D>{}, Point<D>{}) {}
    Domain(const Point<D> &lower, const Point<D> &upper) : lower_(lower), upper_(upper) {
        // One scale for all axes (§4.2 embeds the domain in a square), as a power of
        // two times a factor so that neither the largest nor the smallest extents
        // overflow or vanish on the way.
        double extent = 0;
        for (int i = 0; i < D; ++i) extent = std::max(extent, upper[i] - lower[i]);
        int exponent = std::numeric_limits<double>::max_exponent + 1;
        if (extent < std::numeric_limits<double>::infinity()) std::frexp(extent, &exponent);
        scale_ = std::ldexp(1.0, std::clamp(-exponent, -1022, 1000));
        double scaled_extent = 0;
        for (int i = 0; i < D; ++i) {
            origin_[i] = lower[i] * scale_;
            scaled_extent = std::max(scaled_extent, upper[i] * scale_ - origin_[i]);
        }
        factor_ = scaled_extent > 0 ? cells / scaled_extent : 0;
    }

    const Point<D> &lower() const { return lower_; }
    const Point<D> &upper() const { return upper_; }

    /// Quantized coordinates, clamped to the domain.
    Cell<D> cell(const Point<D> &p) const {
        Cell<D> result;
        for (int i = 0; i < D; ++i) {
            const double t = (p[i] * scale_ - origin_[i]) * factor_;
            // A signed conversion is one instruction; clamp() also ends NaN.
            result[i] = static_cast<std::uint32_t>(static_cast<std::int32_t>(clamp(t, max_cell)));
        }
        return result;
    }

    std::uint64_t code(const Point<D> &p) const { return morton<D>(cell(p)); }

    /// Bits of the coordinates below the cell, for `part`. Around zero, where the
    /// magnitudes of doubles are densest, the bits of the number itself (sign,
    /// exponent, mantissa) tell more than any fixed grid.
    Cell<D> subcell(const Point<D> &p) const {
        constexpr double sub = static_cast<double>(1u << part_bits<D>);
        Cell<D> result;
        for (int i = 0; i < D; ++i) {
            const double t = (p[i] * scale_ - origin_[i]) * factor_;
            const double zero = -origin_[i] * factor_;
            if (std::floor(t) == std::floor(zero)) {
                const auto bits = std::bit_cast<std::uint64_t>(p[i] + 0.0);
                const auto ordered = bits >> 63 ? ~bits : bits | 1ull << 63;
                result[i] = static_cast<std::uint32_t>(ordered >> (64 - part_bits<D>));
            } else {
                const double rest = (t - std::floor(t)) * sub;
                result[i] = static_cast<std::uint32_t>(clamp(rest, sub - 1));
            }
        }
        return result;
    }

private:
    static double clamp(double t, double most) { return std::min(most, std::max(0.0, t)); }

    static constexpr double cells = static_cast<double>(1ull << code_bits<D>);
    static constexpr double max_cell = cells - 1;

    Point<D> lower_, upper_, origin_;
    double scale_, factor_;
};

} // namespace abacus
