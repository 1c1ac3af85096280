// Rational numbers: what is computed in them is exact, and rounded once.
#pragma once

#include <CGAL/Exact_rational.h>

namespace abacus::exact {

using Rational = CGAL::Exact_rational;

/// The double nearest to x, of two that are equally near the even one; infinite beyond all of them.
/// CGAL::to_double() may give the next one.
double nearest_double(const Rational &x);

} // namespace abacus::exact
