// Locational codes: positions on a Hilbert curve over the mesh's domain (dissertation
// §4.8, there on a Z-order curve).
//
// A coordinate is first quantized to `code_bits` bits. The code of a simplex is the
// greatest of its vertices' codes: no arithmetic, and the same for every writer and
// reader, whatever the order of the vertices. When points are inserted along the curve,
// every new simplex has a code no less than the point's. So what lies behind the point is
// finished.
//
// Codes serve for clustering only. No geometric decision depends on them, and points
// outside the domain are clamped to its border. Where many simplices share one code
// (the star of one vertex, a tight cluster, coordinates of very different magnitude),
// the key goes on in a second word, `part`: see part().
#pragma once

#include "geometry/point.hpp"
#include "keys/hilbert.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace abacus {

/// Bits an axis of a code.
template <int D> inline constexpr int code_bits = D == 2 ? 31 : 21;
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

/// The reverse: takes bit i from bit D*i.
template <int D> constexpr std::uint32_t gather_bits(std::uint64_t x) {
    if constexpr (D == 2) {
        x &= 0x5555555555555555ull;
        x = (x | x >> 1) & 0x3333333333333333ull;
        x = (x | x >> 2) & 0x0f0f0f0f0f0f0f0full;
        x = (x | x >> 4) & 0x00ff00ff00ff00ffull;
        x = (x | x >> 8) & 0x0000ffff0000ffffull;
        x = (x | x >> 16) & 0xffffffffull;
    } else {
        x &= 0x1249249249249249ull;
        x = (x | x >> 2) & 0x10c30c30c30c30c3ull;
        x = (x | x >> 4) & 0x100f00f00f00f00full;
        x = (x | x >> 8) & 0x001f0000ff0000ffull;
        x = (x | x >> 16) & 0x001f00000000ffffull;
        x = (x | x >> 32) & 0x1fffff;
    }
    return static_cast<std::uint32_t>(x);
}

/// Morton code of a cell: axis 0 in the least significant bit of each group.
template <int D> constexpr std::uint64_t morton(const Cell<D> &cell) {
    std::uint64_t code = 0;
    for (int i = 0; i < D; ++i) code |= spread_bits<D>(cell[i]) << i;
    return code;
}

/// The cell with this Morton code.
template <int D> constexpr Cell<D> morton_cell(std::uint64_t code) {
    Cell<D> cell;
    for (int i = 0; i < D; ++i) cell[i] = gather_bits<D>(code >> i);
    return cell;
}

/// Locational code of a cell: its place on the Hilbert curve.
template <int D> constexpr std::uint64_t curve_code(const Cell<D> &cell) {
    return Hilbert<D>::template place<code_bits<D>>(cell);
}

/// The box over which the codes of a mesh are computed.
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

    std::uint64_t code(const Point<D> &p) const { return curve_code<D>(cell(p)); }

    /// Second word of the key of a simplex with these n finite corners and their codes.
    static std::uint64_t part(const std::array<const Point<D> *, D + 1> &corners,
                              const std::array<std::uint64_t, D + 1> &codes, int n);

private:
    static double clamp(double t, double most) { return std::min(most, std::max(0.0, t)); }

    static constexpr double cells = static_cast<double>(1ull << code_bits<D>);
    static constexpr double max_cell = cells - 1;

    Point<D> lower_, upper_, origin_;
    double scale_, factor_;
};

} // namespace abacus
