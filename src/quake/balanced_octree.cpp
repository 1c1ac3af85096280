#include "quake/balanced_octree.hpp"

#include "host/host.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace abacus {
namespace {

/// "%g" of a number.
std::string text(double value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.6g", value);
    return buffer;
}

/// Names an octant: the coordinates' leading bits below a leading 1.
std::uint64_t name(const BasinOctant &o) {
    const int bits = BalancedOctree::depth - o.shift;
    return ((std::uint64_t{1} << bits | o.x >> o.shift) << bits | o.y >> o.shift) << bits |
           o.z >> o.shift;
}

/// The ground of an octant, and of all within `margin` units around it.
Basin::Box ground(const BasinOctant &o, std::uint32_t margin) {
    constexpr double unit = BalancedOctree::unit;
    const auto below = [&](std::uint32_t v) { return unit * (v > margin ? v - margin : 0); };
    const auto above = [&](std::uint32_t v, std::uint32_t limit) {
        return unit * std::min(v + (1u << o.shift) + margin, limit);
    };
    return {below(o.x), above(o.x, BalancedOctree::width), below(o.y),
            above(o.y, BalancedOctree::width), above(o.z, BalancedOctree::height) - Basin::depth};
}

} // namespace

BalancedOctree::BalancedOctree(double frequency, double points_per_wavelength) {
    const auto require_positive = [](double value, const char *name) {
        if (!(value > 0) || !std::isfinite(value))
            throw Error(ABACUS_ERROR_ARGUMENT,
                        std::string(name) + " must be a positive finite number", "",
                        "With 8 points per wavelength, 0.1 Hz gives 0.13 million points, 0.25 Hz a "
                        "million, 0.5 Hz six million.");
    };
    require_positive(frequency, "frequency");
    require_positive(points_per_wavelength, "points_per_wavelength");
    // Mantissas and exponents apart, so that no intermediate product overflows or underflows unless
    // the result does.
    int frequency_exponent, points_exponent;
    const double slowness = unit * std::frexp(frequency, &frequency_exponent) *
                            std::frexp(points_per_wavelength, &points_exponent);
    for (int shift = 0; shift <= depth; ++shift)
        resolved_[shift] = std::ldexp(slowness, shift + frequency_exponent + points_exponent);
    const double slowest = Basin::slowest();
    if (resolved_[0] > slowest)
        throw Error(ABACUS_ERROR_ARGUMENT, "frequency is too high for the depth of the octree",
                    "Shear waves of " + text(slowest) + " m/s would need octants of " +
                        text(slowest / frequency / points_per_wavelength) +
                        " m, but the smallest have " + text(unit) + " m.",
                    "The highest frequency with " + text(points_per_wavelength) +
                        " points per wavelength is about " +
                        text(slowest / (unit * points_per_wavelength)) + " Hz.");
}

bool BalancedOctree::is_too_coarse(const BasinOctant &octant) const {
    return Basin::slowest(ground(octant, 0)) < resolved_[octant.shift];
}

/// Whether an octant around this one may be too coarse at half its edge or less.
bool BalancedOctree::may_be_pressed(const BasinOctant &octant) const {
    return Basin::slowest(ground(octant, 1u << octant.shift)) < resolved_[octant.shift - 1];
}

bool BalancedOctree::is_split(const BasinOctant &octant) {
    if (octant.shift > coarsest) return true;
    if (octant.shift == 0) return false;
    const std::uint64_t named = name(octant);
    std::uint64_t &answer = memory_[named * 0x9e3779b97f4a7c15u >> (64 - memory_bits)];
    if (answer >> 1 == named) return answer & 1;
    const bool split = is_too_coarse(octant) || (may_be_pressed(octant) && is_pressed(octant));
    answer = named << 1 | split;
    return split;
}

/// Whether a neighbour of a child is split. The octants of half the edge that touch this one
/// are the shell of a cube of 4 x 4 x 4; its 8 corners touch at a point only.
bool BalancedOctree::is_pressed(const BasinOctant &octant) {
    const int shift = octant.shift - 1;
    for (std::uint32_t i = 0; i < 64; ++i) {
        const std::uint32_t dx = i & 3, dy = i >> 2 & 3, dz = i >> 4;
        const int outside = (dx % 3 == 0) + (dy % 3 == 0) + (dz % 3 == 0);
        if (outside == 0 || outside == 3) continue;
        // coordinates below 0 wrap around and are beyond the limit as well
        const BasinOctant near = {octant.x + (dx << shift) - (1u << shift),
                                  octant.y + (dy << shift) - (1u << shift),
                                  octant.z + (dz << shift) - (1u << shift), shift};
        if (near.x < width && near.y < width && near.z < height && is_split(near)) return true;
    }
    return false;
}

} // namespace abacus
