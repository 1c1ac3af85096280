// Lines that come as numbered corners, in any order, become segments.
#pragma once

#include "segments/line_segment.hpp"
#include "sort/record_sort.hpp"

#include <functional>

namespace abacus {

class LineCorners {
public:
    LineCorners(const Host &host, std::size_t memory) : corners_(host, words, 2, memory) {}

    /// Of finite coordinates.
    void add(std::int64_t line, std::int64_t position, const Point<2> &place, std::int64_t part) {
        std::uint64_t *const record = corners_.add();
        record[0] = ordered_integer(line);
        record[1] = ordered_integer(position);
        for (int i = 0; i < 2; ++i) record[2 + i] = std::bit_cast<std::uint64_t>(place[i]);
        record[4] = static_cast<std::uint64_t>(part);
    }
    /// No more corners come: calls visit(segment) for each two of one part of a line with no other
    /// one between them. Throws an Error (argument) if a line has two corners with one position.
    void each_segment(const std::function<void(const LineSegment &)> &visit);
    void close() { corners_.close(); }

private:
    static constexpr std::size_t words = 5;

    RecordSort corners_;
};

} // namespace abacus
