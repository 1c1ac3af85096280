// Boxes around circumspheres, by interval arithmetic and rounded outwards: such a box may be too
// large, but never too small.
#pragma once

#include "geometry/box.hpp"

namespace abacus {

/// The box of the sphere through D+1 corners. Where the intervals show no bound on a side, as of a
/// simplex that is nearly flat, or where something overflows, that side is infinite or NaN.
template <int D> Box<D> sphere_box(const std::array<const Point<D> *, D + 1> &corners);

/// The box of the least ball that has the D corners of a facet on its border: in the hyperplane of
/// the facet it is the circumcircle, or in the plane the edge. Sides without a bound as above.
template <int D> Box<D> facet_ball_box(const std::array<const Point<D> *, D + 1> &corners);

extern template Box<2> sphere_box<2>(const std::array<const Point<2> *, 3> &);
extern template Box<3> sphere_box<3>(const std::array<const Point<3> *, 4> &);
extern template Box<2> facet_ball_box<2>(const std::array<const Point<2> *, 3> &);
extern template Box<3> facet_ball_box<3>(const std::array<const Point<3> *, 4> &);

} // namespace abacus
