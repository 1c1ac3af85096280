// Boxes by which an R-tree finds the simplices that a point is in conflict with
// (dissertation §2.3.1, there "circumrectangles").
//
// The box of a finite simplex is that of its circumsphere. That of a ghost, whose region
// is a half-space, needs a bound: all points to come are known before the first is
// inserted, so it is the box of what the half-space shares with their bounding box, the
// domain. The boxes of circumspheres end there too, since no point is searched for
// beyond.
//
// Everything is computed by interval arithmetic and rounded outwards, so a box may be too
// large but never too small: a search can find too many simplices, which the exact
// predicate dismisses, and never miss one. Results that underflow or overflow are also
// rounded outwards. Where the intervals say nothing, as for a simplex that is nearly
// flat, the domain is the box.
#pragma once

#include "geometry/predicates.hpp"

#include <abacus/goose.h>

namespace abacus {

template <int D> class Circumboxes {
public:
    explicit Circumboxes(const abacus_facts &facts);

    /// Of coordinates in an R-tree: a power of two. PostgreSQL's boxes are compared with a
    /// tolerance of 1e-6 and have an area that must neither overflow nor underflow; so a
    /// domain that is very small or very large is brought to a size between.
    double unit() const { return unit_; }
    void scale(const Point<D> &p, double *scaled) const {
        for (int k = 0; k < D; ++k) scaled[k] = p[k] * unit_;
    }
    /// Fills in the box of a row from its simplex.
    void enclose(abacus_boxed_simplex &row) const;

private:
    Point<D> lower_, upper_;
    double unit_;
};

extern template class Circumboxes<2>;
extern template class Circumboxes<3>;

} // namespace abacus
