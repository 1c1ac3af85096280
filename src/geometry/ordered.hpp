// Doubles as words in the same order, for sorting and for columns.
#pragma once

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

} // namespace abacus
