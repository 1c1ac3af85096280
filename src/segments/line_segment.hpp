// A segment of a line, as a record of words.
#pragma once

#include "geometry/point.hpp"

#include <bit>
#include <cstdint>

namespace abacus {

struct LineSegment {
    std::int64_t line, position; // of its first end
    Point<2> a, b;

    auto operator<=>(const LineSegment &) const = default;
};

/// A segment in words.
constexpr std::size_t segment_words = 6;

/// An integer as a word in the same order.
constexpr std::uint64_t ordered_integer(std::int64_t i) {
    return static_cast<std::uint64_t>(i) ^ 1ull << 63;
}
constexpr std::int64_t from_ordered_integer(std::uint64_t word) {
    return static_cast<std::int64_t>(word ^ 1ull << 63);
}

inline void write_segment(const LineSegment &segment, std::uint64_t *words) {
    words[0] = ordered_integer(segment.line);
    words[1] = ordered_integer(segment.position);
    for (int i = 0; i < 2; ++i) {
        words[2 + i] = std::bit_cast<std::uint64_t>(segment.a[i]);
        words[4 + i] = std::bit_cast<std::uint64_t>(segment.b[i]);
    }
}
inline LineSegment read_segment(const std::uint64_t *words) {
    const auto number = [&](int i) { return std::bit_cast<double>(words[i]); };
    return {from_ordered_integer(words[0]),
            from_ordered_integer(words[1]),
            {number(2), number(3)},
            {number(4), number(5)}};
}

} // namespace abacus
