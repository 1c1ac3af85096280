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
    const std::uint32_t half = 1u << leaf_.shift >> 1;
    constexpr double unit = BalancedOctree::unit;
    point.id = ++count_;
    point.x = unit * (leaf_.x + (child & 1) * half);
    point.y = unit * (leaf_.y + (child >> 1 & 1) * half);
    point.z = unit * (leaf_.z + (child >> 2) * half) - Basin::depth;
    point.material = Basin::material(point.x, point.y, point.z);
    return true;
}

/// Whether the octant of the leaf's size at x, y, z is split; beyond an upper face of the
/// basin, its mirror image.
bool QuakePoints::is_split(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    if (leaf_.shift > BalancedOctree::coarsest) return true;
    const std::uint32_t size = 1u << leaf_.shift;
    return octree_.is_split({std::min(x, BalancedOctree::width - size),
                             std::min(y, BalancedOctree::width - size),
                             std::min(z, BalancedOctree::height - size), leaf_.shift});
}

/// Goes to the next octant in Z-order that does not lie in this one; false after the last.
bool QuakePoints::advance() {
    for (; leaf_.shift < root; ++leaf_.shift) {
        const std::uint32_t size = 1u << leaf_.shift;
        // as adding 1 to the Morton number, carrying from x to y to z to the next level
        for (std::uint32_t *v : {&leaf_.x, &leaf_.y, &leaf_.z}) {
            *v ^= size;
            if ((*v & size) != 0) return true;
        }
    }
    return false;
}

/// Goes to the next leaf that has a part of the closed basin.
bool QuakePoints::find_leaf() {
    if (started_ && !advance()) return false;
    started_ = true;
    while (leaf_.x > BalancedOctree::width || leaf_.y > BalancedOctree::width ||
           leaf_.z > BalancedOctree::height)
        if (!advance()) return false;
    while (is_split(leaf_.x, leaf_.y, leaf_.z)) --leaf_.shift;
    return true;
}

/// Finds the points that lie in the leaf.
void QuakePoints::collect() {
    const std::uint32_t x = leaf_.x, y = leaf_.y, z = leaf_.z, size = 1u << leaf_.shift;
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
