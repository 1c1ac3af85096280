// The fixed edges that have taken the place of others on the same line, and inherit their markers:
// the parts of an edge that a point has split, the edge that was joined again where a point has
// gone, or what is left where a line has become shorter.
//
// An edge inherits a marker if edges with this marker have covered all of it. So the way along each
// of these is followed through the mesh, over edges that are not fixed and across triangles, too.
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

    struct Legacy {
        Edge old;
        double marker;
    };

    /// Notes the fixed edges on the way; false if it begins outside the mesh.
    bool walk(const Point<2> &from, const Point<2> &to, const Legacy &legacy);
    /// The first vertex on the way, which begins in the closure of a triangle: the beginning
    /// itself, or the end of an edge that it lies inside, which is noted if it is fixed.
    std::optional<Point<2>> pass_through(Handle h, const Point<2> &from, const Point<2> &to,
                                         const Legacy &legacy);
    /// The next vertex on the way across triangles, if it has one before it ends.
    std::optional<Point<2>> vertex_ahead(Handle h, const Point<2> &from, const Point<2> &to);
    /// That the edge between two vertices inherits.
    void note(const Point<2> &v, const Point<2> &w, const Legacy &legacy);

    Delaunay<2> &mesh_;
    RecordSort sort_;
};

} // namespace abacus
