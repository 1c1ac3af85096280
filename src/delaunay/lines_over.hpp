// Which lines lie over a fixed edge: those with a segment that has an end at the edge, or passes
// both of its ends. Such a segment is straight, and all of it is fixed. So one of its ends is found
// by going on from an end of the edge, straight along fixed edges.
#pragma once

#include "delaunay/delaunay.hpp"
#include "delaunay/line_source.hpp"
#include "traverse/straight.hpp"

#include <optional>

namespace abacus {

class LinesOver {
public:
    LinesOver(Delaunay<2> &mesh, LineSource &lines) : mesh_(mesh), lines_(lines) {}

    /// The least of the lines with a segment over the edge between two vertices; nothing if there
    /// is none.
    std::optional<std::int64_t> find(const Point<2> &a, const Point<2> &b);
    /// The kind of that edge, by the lines over it.
    Fixed kind(const Point<2> &a, const Point<2> &b);

private:
    /// Calls visit(segment) for segments over the edge, until it returns false.
    template <class Visit> void each(const Point<2> &a, const Point<2> &b, Visit visit);
    /// The same for segments that end at p and go through `through` and, if it is wanted, beyond.
    /// Returns what visit() has returned last.
    template <class Visit>
    bool from(const Point<2> &p, const Point<2> &through, bool beyond, Visit visit);
    /// The end of the fixed edge from `at` that leads straight away from `behind`.
    std::optional<Point<2>> next(const Point<2> &behind, const Point<2> &at);

    Delaunay<2> &mesh_;
    LineSource &lines_;
};

} // namespace abacus
