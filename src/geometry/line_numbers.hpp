// Lines in rational numbers, for what doubles do not decide.
#pragma once

#include "geometry/line.hpp"
#include "geometry/rational.hpp"

namespace abacus::exact {

/// The direction of a line, exactly.
template <int D> std::array<Rational, D> direction_of(const Line<D> &line) {
    std::array<Rational, D> d;
    for (int i = 0; i < D; ++i)
        d[i] = line.to ? Rational((*line.to)[i]) - Rational(line.from[i])
                       : Rational(line.direction[i]);
    return d;
}

/// det(d, a - o) in the plane, where b is not read, and det(d, a - o, b - o) in space.
template <int D>
Rational line_side_value(const Line<D> &line, const Point<D> &a, const Point<D> &b) {
    const std::array<Rational, D> d = direction_of<D>(line);
    std::array<Rational, D> u, v;
    for (int i = 0; i < D; ++i) {
        u[i] = Rational(a[i]) - Rational(line.from[i]);
        if (D == 3) v[i] = Rational(b[i]) - Rational(line.from[i]);
    }
    if constexpr (D == 2)
        return d[0] * u[1] - d[1] * u[0];
    else
        return d[0] * (u[1] * v[2] - u[2] * v[1]) + d[1] * (u[2] * v[0] - u[0] * v[2]) +
               d[2] * (u[0] * v[1] - u[1] * v[0]);
}

/// The weights of a facet's points in the place where the line meets it, but for a factor.
template <int D, class Get> std::array<Rational, D> facet_weights(const Line<D> &line, Get point) {
    std::array<Rational, D> weights;
    if constexpr (D == 2) {
        weights[0] = line_side_value<2>(line, point(1), point(1));
        weights[1] = -line_side_value<2>(line, point(0), point(0));
    } else {
        for (int i = 0; i < 3; ++i)
            weights[i] = -line_side_value<3>(line, point((i + 1) % 3), point((i + 2) % 3));
    }
    return weights;
}

/// Where it does: the parameter.
template <int D> Rational parameter_at(const Line<D> &line, const std::array<Point<D>, D> &facet) {
    const auto weights = facet_weights<D>(line, [&](int i) { return facet[i]; });
    Rational sum = 0, along = 0;
    for (int i = 0; i < D; ++i) {
        sum += weights[i];
        along += weights[i] * (Rational(facet[i][line.axis]) - Rational(line.from[line.axis]));
    }
    return along / (sum * direction_of<D>(line)[line.axis]);
}

} // namespace abacus::exact
