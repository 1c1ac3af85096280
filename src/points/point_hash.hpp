// A hash of a point, by which samples are drawn that are functions of the set of points.
#pragma once

#include "geometry/point.hpp"

#include <bit>
#include <cstdint>

namespace abacus {

template <std::size_t D> std::uint64_t point_hash(const std::array<double, D> &p) {
    std::uint64_t h = 0x13198a2e03707344; // digits of pi
    for (const double x : p) {
        h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15;
        h ^= h >> 32;
    }
    h *= 0xd6e8feb86659fd93;
    return h ^ h >> 32;
}

} // namespace abacus
