// The earthquake data sets (dissertation §5.1.2): the corners of the balanced
// octree's leaves, each once, in Z-order, one at a time and in constant memory.
//
// A point belongs to the leaf that contains it when leaves are half open, so that
// the walk over the leaves in Z-order meets every point once. In a leaf lie its own
// lower corner and those corners of smaller neighbours that hang on its three lower
// faces. Balance leaves six places for these: the midpoints of the edges that meet
// in the lower corner, and of the faces. Each is there exactly if one of the
// octants of the leaf's own size around that edge or face is split. The leaf's lower
// corner and these six are the lower corners of its first seven would-be children,
// so taking them in this order makes the whole sequence strictly ascend in Z-order.
//
// The points on the upper faces of the basin lie in no half-open octant of it. So
// the walk goes over a cube twice as wide, in which octants beyond a face are split
// as those on the other side. That cube is the domain of an octree of the usual kind
// (octree/octant.hpp), and its finest cells have the basin's unit. A stored octree of that
// domain, as fine and as balanced, has the same nodes in the same order.
#pragma once

#include "octree/octant.hpp"
#include "quake/balanced_octree.hpp"

#include <cstdint>

namespace abacus {

struct QuakePoint {
    std::int64_t id; ///< 1, 2, ...
    double x, y, z;  ///< metres, exact multiples of BalancedOctree::unit; z <= 0
    Material material;
};

/// Half a megabyte, in itself; no memory beside it.
class QuakePoints {
public:
    /// `frequency` in Hz. Leaves are no larger than the wavelength of the slowest shear wave
    /// in them over `points_per_wavelength`. Throws Error (argument): see BalancedOctree.
    explicit QuakePoints(double frequency, double points_per_wavelength = 8)
        : octree_(frequency, points_per_wavelength) {}

    /// The next point; false after the last one.
    bool next(QuakePoint &point);

private:
    bool is_split(std::uint32_t x, std::uint32_t y, std::uint32_t z);
    bool find_leaf();
    bool advance();
    void collect();

    static_assert(finest_level<3> == BalancedOctree::depth + 1, "one level for the doubled cube");
    int shift() const { return finest_level<3> - leaf_.level; }

    BalancedOctree octree_;
    Octant<3> leaf_;  ///< of the doubled cube
    Cell<3> lower_{}; ///< its lower corner
    bool started_ = false;
    unsigned places_ = 0; ///< would-be children of the leaf whose lower corner is still to come
    std::int64_t count_ = 0;
};

} // namespace abacus
