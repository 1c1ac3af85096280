// The greatest difference of two functions that are linear in the simplices of two meshes: exact.
//
// Where two simplices have a part in common, the difference is linear, so it is greatest at a
// corner of that part. The corners are rational points: those of the first simplex, and where edges
// meet facets when it is cut at each facet of the second one, at the sides of a box, and at the
// edges of a polygon. The difference at each is a rational number. Only the result is rounded, each
// number once.
//
// Rational numbers take a hundred times as long as doubles. So a bound in doubles comes first: in
// the common part the difference is at most as great as the greatest at the corners of either
// simplex, where the other function is continued beyond its own. Pairs whose bound is below the
// greatest so far are passed over. Of equal differences the one at the lexicographically least
// place counts, so the result does not depend on the order of the pairs.
#pragma once

#include "geometry/box.hpp"
#include "geometry/linear_piece.hpp"
#include "geometry/polygon.hpp"

#include <memory>

namespace abacus {

template <int D> class GreatestDifference {
public:
    GreatestDifference();
    ~GreatestDifference();
    GreatestDifference(const GreatestDifference &) = delete;
    GreatestDifference &operator=(const GreatestDifference &) = delete;

    /// Two simplices that overlap, as far as they lie in the box and, in the plane, in the polygon,
    /// which may be null. The difference is the first function less the second one.
    void add(const Piece<D> &first, const Piece<D> &second, const Box<D> &box,
             const Polygon *polygon);
    /// Whether any of them had a part with an area or volume there.
    bool is_any() const;

    struct Result {
        double difference; // with the greatest absolute value; infinite beyond all doubles
        Point<D> place;
    };
    Result result() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

extern template class GreatestDifference<2>;
extern template class GreatestDifference<3>;

} // namespace abacus
