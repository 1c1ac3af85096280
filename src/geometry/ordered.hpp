// Doubles as words in the same order, for sorting and for columns.
#pragma once

#include "geometry/point.hpp"

#include <bit>
#include <cstdint>

namespace abacus {

/// Rank of a double among all: the order of words is that of the doubles.
constexpr std::uint64_t ordered(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    return bits >> 63 ? ~bits : bits | 1ull << 63;
}
constexpr double from_ordered(std::uint64_t rank) {
    return std::bit_cast<double>(rank >> 63 ? rank & ~(1ull << 63) : ~rank);
}

/// The same for the coordinates of a point.
template <std::size_t D> void put_ordered(std::uint64_t *words, const std::array<double, D> &p) {
    for (const double x : p) *words++ = ordered(x);
}
template <int D> Point<D> point_from_ordered(const std::uint64_t *words) {
    Point<D> p;
    for (double &x : p) x = from_ordered(*words++);
    return p;
}

} // namespace abacus
