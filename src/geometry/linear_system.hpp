// Small systems of linear equations, such as a gradient or a circumcentre solves.
//
// By Cramer's rule in doubles. Where little is left of the determinant, as in a flat simplex, it is
// done in rational numbers, which are exact; so the solution always has some ten digits.
#pragma once

#include "geometry/point.hpp"
#include "host/error.hpp"

#include <CGAL/Exact_rational.h>

#include <cmath>

namespace abacus {

/// matrix[i] · x = right[i] for every i.
template <class T, int D> struct LinearSystem {
    using Matrix = std::array<std::array<T, D>, D>;

    static T determinant(const Matrix &m) {
        if constexpr (D == 2) {
            return m[0][0] * m[1][1] - m[0][1] * m[1][0];
        } else {
            T sum(0);
            for (int i = 0; i < 3; ++i) {
                const auto &a = m[(i + 1) % 3], &b = m[(i + 2) % 3];
                sum += m[i][0] * (a[1] * b[2] - a[2] * b[1]);
            }
            return sum;
        }
    }
    /// The sum of the products that make up the determinant, without their signs.
    static double permanent(const Matrix &m) {
        using std::abs;
        if constexpr (D == 2) {
            return abs(m[0][0] * m[1][1]) + abs(m[0][1] * m[1][0]);
        } else {
            double sum = 0;
            for (int i = 0; i < 3; ++i) {
                const auto &a = m[(i + 1) % 3], &b = m[(i + 2) % 3];
                sum += abs(m[i][0]) * (abs(a[1] * b[2]) + abs(a[2] * b[1]));
            }
            return sum;
        }
    }
    /// The determinant of the matrix with the right side in place of a column.
    T with_right_side(int column) const {
        Matrix m = matrix;
        for (int i = 0; i < D; ++i) m[i][column] = right[i];
        return determinant(m);
    }

    Matrix matrix;
    std::array<T, D> right;
};

/// Solves system.operator()<T>(), which is asked for in doubles and, if need be, in rational
/// numbers. Throws if it has no solution, or several: then a simplex is flat.
template <int D, class System> Point<D> solve(const System &system) {
    Point<D> x;
    const LinearSystem<double, D> rounded = system.template operator()<double>();
    const double whole = rounded.determinant(rounded.matrix);
    const double size = rounded.permanent(rounded.matrix);
    if (std::abs(whole) > 1e-5 * size && size > 1e-250 && size < 1e250) [[likely]] {
        bool is_finite = true;
        for (int axis = 0; axis < D; ++axis) {
            x[axis] = rounded.with_right_side(axis) / whole;
            is_finite = is_finite && std::isfinite(x[axis]);
        }
        if (is_finite) return x;
    }
    using Rational = CGAL::Exact_rational;
    const LinearSystem<Rational, D> exact = system.template operator()<Rational>();
    const Rational exact_whole = exact.determinant(exact.matrix);
    if (exact_whole == 0) throw_corrupted("A simplex is flat.");
    for (int axis = 0; axis < D; ++axis)
        x[axis] = CGAL::to_double(Rational(exact.with_right_side(axis) / exact_whole));
    return x;
}

} // namespace abacus
