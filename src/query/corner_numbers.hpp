// Numbers of what lies on the edges of a mesh, one corner of a surface on each: dense, from 0, in
// the order of the edges, which are compared by the coordinates of their ends. So a number depends
// on the points alone, not on the pages.
//
// An edge is in several tetrahedra, and these in several pages, each of which comes with a corner
// of its own. No table of edges is kept, which would grow with the surface: the corners are sorted
// by their edges, counted, and sorted back into the order in which they came.
#pragma once

#include "geometry/point.hpp"
#include "sort/record_sort.hpp"

namespace abacus {

class CornerNumbers {
public:
    CornerNumbers(const Host &host, std::size_t memory)
        : pacer_(host), edges_(host, edge_words + 1, edge_words, memory / 2),
          numbers_(host, 2, 1, memory / 2) {}

    /// One more corner, on the edge from a to b.
    void add(const Point<3> &a, const Point<3> &b);
    /// Ends adding.
    void finish();
    /// The number of the corner that was added first, then second, and so on.
    std::int64_t next() { return static_cast<std::int64_t>(numbers_.next()[1]); }
    void close() { numbers_.close(); }

private:
    static constexpr std::size_t edge_words = 6;

    Pacer pacer_;
    RecordSort edges_;   // the coordinates of the ends, and the place among those added
    RecordSort numbers_; // that place, and the number
};

} // namespace abacus
