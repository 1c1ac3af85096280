#include "geometry/circumradius.hpp"

#include "geometry/linear_system.hpp"

#include <CGAL/Exact_rational.h>

namespace abacus {

namespace {

/// The equations of the centre relative to the first corner.
template <class T, int D> LinearSystem<T, D> centre_of(const Corners<D> &corners) {
    LinearSystem<T, D> system;
    for (int i = 0; i < D; ++i) {
        T half = T(0);
        for (int axis = 0; axis < D; ++axis) {
            system.matrix[i][axis] = T((*corners[i + 1])[axis]) - T((*corners[0])[axis]);
            half += system.matrix[i][axis] * system.matrix[i][axis];
        }
        system.right[i] = half / T(2);
    }
    return system;
}

} // namespace

template <int D> bool has_circumsphere_within(const Corners<D> &corners, double square) {
    if (const auto centre = solve_in_doubles<D>(centre_of<double, D>(corners))) {
        double found = 0;
        for (const double x : *centre) found += x * x;
        // The centre is right to ten digits.
        const double slack = 1e-8 * (found + square);
        if (found > 1e-250 && std::abs(found - square) > slack) [[likely]]
            return found < square;
    }
    using Rational = CGAL::Exact_rational;
    const LinearSystem<Rational, D> system = centre_of<Rational, D>(corners);
    const Rational whole = system.determinant(system.matrix);
    Rational sum = 0; // times the square of the determinant
    for (int axis = 0; axis < D; ++axis) {
        const Rational part = system.with_right_side(axis);
        sum += part * part;
    }
    return sum <= Rational(square) * whole * whole;
}

template bool has_circumsphere_within<2>(const Corners<2> &, double);
template bool has_circumsphere_within<3>(const Corners<3> &, double);

} // namespace abacus
