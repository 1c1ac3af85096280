#include "quake/quake_points.hpp"

#include <algorithm>
#include <bit>

namespace abacus {

bool QuakePoints::next(QuakePoint &point) {
    while (places_ == 0) {
        if (!find_leaf()) return false;
        collect();
    }
    const auto child = static_cast<std::uint32_t>(std::countr_zero(places_));
    places_ &= places_ - 1;
    const std::uint32_t half = 1u << shift() >> 1;
    constexpr double unit = BalancedOctree::unit;
    point.id = ++count_;
    point.x = unit * (lower_[0] + (child & 1) * half);
    point.y = unit * (lower_[1] + (child >> 1 & 1) * half);
    point.z = unit * (lower_[2] + (child >> 2) * half) - Basin::depth;
    point.material = Basin::material(point.x, point.y, point.z);
    return true;
}

/// Whether the octant of the leaf's size at x, y, z is split; beyond an upper face of the
/// basin, its mirror image.
bool QuakePoints::is_split(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    if (shift() > BalancedOctree::coarsest) return true;
    const std::uint32_t size = 1u << shift();
    return octree_.is_split({std::min(x, BalancedOctree::width - size),
                             std::min(y, BalancedOctree::width - size),
                             std::min(z, BalancedOctree::height - size), shift()});
}

/// Goes to the largest octant that begins where this one ends; false after the last.
bool QuakePoints::advance() {
    const std::uint64_t code = leaf_.end();
    if (code == domain_cells<3>) return false;
    leaf_ = {code, coarsest_level<3>(code)};
    lower_ = leaf_.cell();
    return true;
}

/// Goes to the next leaf that has a part of the closed basin.
bool QuakePoints::find_leaf() {
    if (started_ && !advance()) return false;
    started_ = true;
    while (lower_[0] > BalancedOctree::width || lower_[1] > BalancedOctree::width ||
           lower_[2] > BalancedOctree::height)
        if (!advance()) return false;
    while (is_split(lower_[0], lower_[1], lower_[2])) leaf_ = leaf_.child(0);
    return true;
}

/// Finds the points that lie in the leaf.
void QuakePoints::collect() {
    const std::uint32_t x = lower_[0], y = lower_[1], z = lower_[2], size = 1u << shift();
    const auto neighbour = [&](bool dx, bool dy, bool dz) -> unsigned {
        return x >= dx * size && y >= dy * size && z >= dz * size &&
               is_split(x - dx * size, y - dy * size, z - dz * size);
    };
    const unsigned on_x = neighbour(1, 0, 0), on_y = neighbour(0, 1, 0), on_z = neighbour(0, 0, 1);
    places_ = 1;
    places_ |= (on_y | on_z | neighbour(0, 1, 1)) << 1;
    places_ |= (on_x | on_z | neighbour(1, 0, 1)) << 2;
    places_ |= on_z << 3;
    places_ |= (on_x | on_y | neighbour(1, 1, 0)) << 4;
    places_ |= on_y << 5;
    places_ |= on_x << 6;
    // no points beyond the upper faces
    if (x == BalancedOctree::width) places_ &= ~0b0101010u;
    if (y == BalancedOctree::width) places_ &= ~0b1001100u;
    if (z == BalancedOctree::height) places_ &= ~0b1110000u;
}

} // namespace abacus
