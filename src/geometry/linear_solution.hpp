// Solutions of small systems of linear equations that always have some ten digits: where little is
// left of the determinant, as in a flat simplex, they are found in rational numbers, which are
// exact.
#pragma once

#include "geometry/linear_system.hpp"
#include "host/error.hpp"

#include <CGAL/Exact_rational.h>

namespace abacus {

/// The solution, rounded at the end; nothing if there is none, or several.
template <int D>
std::optional<Point<D>> solve_exactly(const LinearSystem<CGAL::Exact_rational, D> &system) {
    using Rational = CGAL::Exact_rational;
    const Rational whole = system.determinant(system.matrix);
    if (whole == 0) return std::nullopt;
    Point<D> x;
    for (int axis = 0; axis < D; ++axis)
        x[axis] = CGAL::to_double(Rational(system.with_right_side(axis) / whole));
    return x;
}

/// Solves system.operator()<T>(), which is asked for in doubles and, if need be, in rational
/// numbers. Throws if it has no solution, or several: then a simplex is flat.
template <int D, class System> Point<D> solve(const System &system) {
    if (const auto x = solve_in_doubles<D>(system.template operator()<double>())) [[likely]]
        return *x;
    const auto x = solve_exactly<D>(system.template operator()<CGAL::Exact_rational>());
    if (!x) throw_corrupted("A simplex is flat.");
    return *x;
}

} // namespace abacus
