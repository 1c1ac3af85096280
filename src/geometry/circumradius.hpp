// How large the circumsphere of a simplex is. Exact.
#pragma once

#include "geometry/predicates.hpp"

namespace abacus {

/// Whether the square of the radius is at most `square`. The simplex is not flat.
template <int D> bool has_circumsphere_within(const Corners<D> &corners, double square);

extern template bool has_circumsphere_within<2>(const Corners<2> &, double);
extern template bool has_circumsphere_within<3>(const Corners<3> &, double);

} // namespace abacus
