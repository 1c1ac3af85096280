// An octree of the basin's cube, refined until an octant's edge resolves the
// seismic wavelength and balanced 2-to-1 across faces and edges, that exists only
// as a function: is_split(octant).
//
// The dissertation's mesher builds its octree, then splits leaves until neighbours
// differ by a level at most (§1.3). The result is unique: the smallest balanced
// tree that contains the first. So whether an octant is split in it can be said
// without the tree. It is, exactly if
//
//   the wavelength asks for it, or
//   an octant of half its edge, beside one of its children across a face or an
//   edge but outside of it, is split: that child must exist then.
//
// The second case is a recursion to ever smaller octants, which all lie within one edge
// length of the first: 1/2 + 1/4 + ... Where the ground there is fast enough for all of
// them, nothing is asked; this ends nearly all searches at once. What remains is steep
// ground (the rim of the basin), where answers are remembered in a table of fixed size.
// The table only saves time: a forgotten answer is computed again.
#pragma once

#include "quake/basin.hpp"

#include <array>
#include <cstdint>

namespace abacus {

/// A cube with edge 2^shift and a corner at multiples of it, in units of the basin's width
/// over 2^BalancedOctree::depth.
struct BasinOctant {
    std::uint32_t x, y, z; ///< lower corner; z from the bottom of the basin
    int shift;
};

class BalancedOctree {
public:
    static constexpr int depth = 20; ///< levels below the root; coordinates are 0 to 2^depth
    static constexpr std::uint32_t width = std::uint32_t{1} << depth;
    static constexpr std::uint32_t height = width / 8 * 3;
    /// Leaves are at least this small, since the basin's height is 3 times 2^coarsest.
    static constexpr int coarsest = depth - 3;
    static constexpr double unit = Basin::width / width; ///< metres; exact

    /// `frequency` in Hz; both positive. Throws Error (argument) if they are not, or ask for
    /// octants below the depth of the tree.
    BalancedOctree(double frequency, double points_per_wavelength);

    /// Whether an octant inside the basin is split in the balanced tree; false for octants
    /// inside a leaf.
    bool is_split(const BasinOctant &octant);

private:
    bool is_too_coarse(const BasinOctant &octant) const;
    bool may_be_pressed(const BasinOctant &octant) const;
    bool is_pressed(const BasinOctant &octant);

    static constexpr int memory_bits = 16;

    /// Slowest shear wave that an octant resolves, by shift; metres a second.
    std::array<double, depth + 1> resolved_;
    /// Answers, by hash: octant << 1 | split.
    std::array<std::uint64_t, std::size_t{1} << memory_bits> memory_{};
};

} // namespace abacus
