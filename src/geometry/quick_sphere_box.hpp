// The box of a circumsphere in doubles: somewhat too large, and only where that is certain.
//
// Edges are rounded once each, so their products are off by a few units in the last place, and a
// determinant by at most 8 units of its permanent, the sum of the products' magnitudes. Where the
// determinant is no less than 10^-6 of the permanent, its relative error is below 10^-9; so is that
// of the centre, relative to the magnitudes that are summed for it. The box gets twice that room.
// Nothing underflows so far, or overflows, that it would matter: edges and permanent are not
// extreme. For all other simplices there is sphere_box.hpp, which takes several times as long.
#pragma once

#include "geometry/box.hpp"

#include <cmath>

namespace abacus {

/// A difference of two products, and the sum of their magnitudes.
struct Minor {
    double value, permanent;

    Minor(double a, double b, double c, double d)
        : value(a * b - c * d), permanent(std::fabs(a * b) + std::fabs(c * d)) {}
};

/// False where the box is not certain; it is not set then.
template <int D>
bool quick_sphere_box(const std::array<const Point<D> *, D + 1> &corners, Box<D> &box) {
    constexpr double error = 2e-9, least_share = 1e-6, least_permanent = 1e-220;
    constexpr double least_edge = 1e-60, longest_edge = 1e60; // squared
    const Point<D> &a = *corners[0];
    std::array<Point<D>, D> edge;
    std::array<double, D> square;
    bool is_usual = true;
    for (int i = 0; i < D; ++i) {
        square[i] = 0;
        for (int k = 0; k < D; ++k) {
            edge[i][k] = (*corners[i + 1])[k] - a[k];
            square[i] += edge[i][k] * edge[i][k];
        }
        is_usual &= square[i] > least_edge && square[i] < longest_edge;
    }
    if (!is_usual) return false;

    double determinant = 0, permanent = 0;
    Point<D> sum, sum_of_magnitudes; // for the centre, times twice the determinant
    if constexpr (D == 2) {
        const Point<2> &b = edge[0], &c = edge[1];
        const Minor area(b[0], c[1], b[1], c[0]);
        const Minor x(square[0], c[1], square[1], b[1]), y(b[0], square[1], c[0], square[0]);
        determinant = area.value;
        permanent = area.permanent;
        sum = {x.value, y.value};
        sum_of_magnitudes = {x.permanent, y.permanent};
    } else {
        const Point<3> &b = edge[0], &c = edge[1], &d = edge[2];
        for (int k = 0; k < 3; ++k) {
            const int i = (k + 1) % 3, j = (k + 2) % 3;
            const Minor cd(c[i], d[j], c[j], d[i]), db(d[i], b[j], d[j], b[i]),
                bc(b[i], c[j], b[j], c[i]);
            determinant += b[k] * cd.value;
            permanent += std::fabs(b[k]) * cd.permanent;
            sum[k] = square[0] * cd.value + square[1] * db.value + square[2] * bc.value;
            sum_of_magnitudes[k] =
                square[0] * cd.permanent + square[1] * db.permanent + square[2] * bc.permanent;
        }
    }
    if (!(permanent > least_permanent) || std::fabs(determinant) < least_share * permanent)
        return false;

    const double scale = 0.5 / std::fabs(determinant);
    Point<D> to_centre, room;
    double radius = 0;
    for (int k = 0; k < D; ++k) {
        to_centre[k] = sum[k] * (determinant < 0 ? -scale : scale);
        room[k] = error * sum_of_magnitudes[k] * scale;
        const double most = std::fabs(to_centre[k]) + room[k];
        radius += most * most;
    }
    radius = std::sqrt(radius);
    for (int k = 0; k < D; ++k) {
        const double reach =
            radius + room[k] + 1e-12 * (radius + std::fabs(to_centre[k]) + std::fabs(a[k]));
        box.lower[k] = a[k] + to_centre[k] - reach;
        box.upper[k] = a[k] + to_centre[k] + reach;
    }
    return true;
}

} // namespace abacus
