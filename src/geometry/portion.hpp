// A simplex with a linear function, as far as integrals go: its measure, and the values at its
// corners.
#pragma once

#include "geometry/exact_sum.hpp"

#include <array>
#include <cmath>

namespace abacus {

/// The measure, an area or a volume, and the values are each times a power of two.
template <int D> struct Portion {
    double measure;
    std::array<double, D + 1> value;
    int of_measure, of_values;

    void negate() {
        for (double &v : value) v = -v;
    }
    ScaledNumber size() const { return {measure, of_measure}; }
    ScaledNumber integral() const { return {measure * (sum() / (D + 1)), of_measure + of_values}; }
    ScaledNumber integral_of_square() const {
        double squares = 0;
        for (const double v : value) squares += v * v;
        return {measure * ((squares + sum() * sum()) / ((D + 1) * (D + 2))),
                of_measure + 2 * of_values};
    }

private:
    double sum() const {
        double sum = 0;
        for (const double v : value) sum += v;
        return sum;
    }
};

/// Calls visit(portion) for portions that make one up, in each of which the values have one sign.
/// An edge with both signs is divided where the value is 0, and the simplex with it.
template <int D, class Visit> void each_of_one_sign(const Portion<D> &portion, Visit &&visit) {
    int above = -1, below = -1;
    for (int i = 0; i <= D; ++i) {
        if (portion.value[i] > 0) above = i;
        if (portion.value[i] < 0) below = i;
    }
    if (above < 0 || below < 0) return visit(portion);
    const double high = portion.value[above], low = -portion.value[below];
    Portion<D> part = portion;
    part.value[below] = 0;
    part.measure = portion.measure * (high / (high + low));
    each_of_one_sign<D>(part, visit);
    part.value[below] = -low;
    part.value[above] = 0;
    part.measure = portion.measure * (low / (high + low));
    each_of_one_sign<D>(part, visit);
}

} // namespace abacus
