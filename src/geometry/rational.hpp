// Rational numbers: what is computed in them is exact, and rounded once.
#pragma once

#include "geometry/exact_sum.hpp"

#include <CGAL/Exact_rational.h>

namespace abacus::exact {

using Rational = CGAL::Exact_rational;

/// The double nearest to x, of two that are equally near the even one; infinite beyond all of them.
/// CGAL::to_double() may give the next one.
double nearest_double(const Rational &x);
/// Rounded; its value is from 1/2 to 1, or 0.
ScaledNumber scaled(Rational x);

} // namespace abacus::exact
