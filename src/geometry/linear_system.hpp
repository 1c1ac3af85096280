// Small systems of linear equations, such as a circumcentre solves.
//
// By Cramer's rule in doubles, where enough is left of the determinant; linear_solution.hpp always
// has a solution.
#pragma once

#include "geometry/point.hpp"

#include <cmath>
#include <optional>

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

/// The solution in doubles; nothing where too little is left of the determinant, or where this is
/// so small that a product with the right side may underflow.
template <int D> std::optional<Point<D>> solve_in_doubles(const LinearSystem<double, D> &system) {
    const double whole = system.determinant(system.matrix);
    const double size = system.permanent(system.matrix);
    if (!(std::abs(whole) > 1e-5 * size && size > 1e-150 && size < 1e250)) return std::nullopt;
    Point<D> x;
    bool is_finite = true;
    for (int axis = 0; axis < D; ++axis) {
        x[axis] = system.with_right_side(axis) / whole;
        is_finite = is_finite && std::isfinite(x[axis]);
    }
    return is_finite ? std::optional(x) : std::nullopt;
}

} // namespace abacus
