// How two meshes in the plane differ where both have a surface: over the pieces of their overlay.
//
// The difference is linear in each piece. So it is greatest at a corner of one, and its integrals
// follow from its values there. Sums are exact, and of equal differences that with the
// lexicographically least place counts; so the result does not depend on the order of the pieces.
//
// Over a triangle that is flat in doubles, rounding decides how the surface rises from one side to
// the other. So its pieces have next to no part in the sums, and none in the greatest difference.
#pragma once

#include "geometry/exact_sum.hpp"
#include "query/volume/overlay.hpp"

namespace abacus {

class Comparison {
public:
    /// A piece, whose values are differences, seen from an origin. Its corners count for the
    /// greatest difference if `has_sure_values`.
    void add(const Piece<2> &piece, const Point<2> &origin, bool has_sure_values);
    abacus_comparison result() const;

private:
    void look_at(double difference, const Point<2> &seen, const Point<2> &origin);

    bool is_any_ = false;
    double greatest_ = 0;
    Point<2> place_{};
    ExactSum size_, sum_, absolute_, squares_;
};

abacus_comparison compare(const Host &host, const abacus_facts &facts,
                          const abacus_surface &surface, const OtherMesh &other);

} // namespace abacus
