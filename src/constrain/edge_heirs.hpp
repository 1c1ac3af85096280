// The fixed edges that have taken the place of others on the same line, and inherit their markers:
// the parts of an edge that a point has split, or the edge that was joined again where a point has
// gone.
//
// An edge inherits a marker if edges with this marker have covered all of it.
#pragma once

#include "delaunay/delaunay.hpp"
#include "sort/record_sort.hpp"

#include <functional>
#include <optional>

namespace abacus {

class EdgeHeirs {
public:
    /// Of a constrained mesh after the change, with so much memory for sorting.
    EdgeHeirs(Delaunay<2> &mesh, std::size_t memory);

    /// Notes who inherits the marker of the edge from a to b, whose triangle has gone.
    void add(const Point<2> &a, const Point<2> &b, double marker);
    /// Calls visit(a, b, marker) once for each heir, with the lesser end first; no more can be
    /// added.
    void each(const std::function<void(const Point<2> &, const Point<2> &, double)> &visit);

private:
    struct Edge {
        Point<2> from, to;
        auto operator<=>(const Edge &) const = default;
    };
    // of a record: the heir, the edge that it inherits from, and the marker
    static constexpr std::size_t edge_words = 4, key_words = 2 * edge_words + 1, words = key_words;

    /// The fixed edge inside which a lies on the way to b, in this direction.
    std::optional<Edge> edge_through(const Point<2> &a, const Point<2> &b);
    /// The fixed edge from a vertex on the way to b.
    std::optional<Edge> edge_from(const Point<2> &at, const Point<2> &b);
    void note(const Edge &heir, const Edge &old, double marker);

    Delaunay<2> &mesh_;
    RecordSort sort_;
};

} // namespace abacus
