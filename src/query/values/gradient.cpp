#include "query/values/gradient.hpp"

#include "geometry/double_double.hpp"
#include "geometry/linear_system.hpp"
#include "geometry/predicates.hpp"
#include "geometry/rational.hpp"

#include <algorithm>
#include <limits>

namespace abacus {

namespace {

constexpr double roundoff = 0x1p-53; // u in double_double.hpp

template <class T, int D>
LinearSystem<T, D> gradient_system(const abacus_simplex &simplex, const double *values) {
    LinearSystem<T, D> system;
    for (int i = 0; i < D; ++i) {
        for (int axis = 0; axis < D; ++axis)
            system.matrix[i][axis] = T(simplex.corner[i + 1][axis]) - T(simplex.corner[0][axis]);
        system.right[i] = T(values[i + 1]) - T(values[0]);
    }
    return system;
}

/// A determinant of numbers of two doubles, and a bound on its error.
struct Determinant {
    DoubleDouble value;
    double error;

    bool is_sure() const { return std::fabs(value.high) > error; }
};

/// The entries are exact. A product of two has an error of 5u², their difference 3u² more, the
/// product with a third 5u² more, and the sum of three such products twice 3u²: altogether 19u² of
/// the permanent, or 32u² of the permanent as computed here. As long as all entries and the
/// permanent are within bounds, nothing overflows, and what underflows is less than a part of
/// 2^-110.
template <int D>
Determinant determinant_of(const typename LinearSystem<DoubleDouble, D>::Matrix &matrix) {
    typename LinearSystem<double, D>::Matrix rounded;
    double largest = 0;
    for (int i = 0; i < D; ++i)
        for (int axis = 0; axis < D; ++axis) {
            rounded[i][axis] = matrix[i][axis].high;
            largest = std::max(largest, std::fabs(rounded[i][axis]));
        }
    const double permanent = LinearSystem<double, D>::permanent(rounded);
    const bool is_bounded = largest < 1e80 && permanent > 1e-200;
    return {LinearSystem<DoubleDouble, D>::determinant(matrix),
            is_bounded ? 32 * roundoff * roundoff * permanent : INFINITY};
}

/// The quotient, rounded once; nothing if the error could lead to another double.
std::optional<double> rounded_quotient(const Determinant &part, const Determinant &whole) {
    if (!part.is_sure() || !whole.is_sure()) return std::nullopt;
    const DoubleDouble quotient = part.value / whole.value;
    const double size = std::fabs(quotient.high);
    if (!(size > 1e-200 && size < 1e200)) return std::nullopt;
    // Twice the largest possible error.
    const double error = 4 * size *
                         (part.error / std::fabs(part.value.high) +
                          whole.error / std::fabs(whole.value.high) + 16 * roundoff * roundoff);
    const double least = quotient.high + (quotient.low - error),
                 greatest = quotient.high + (quotient.low + error);
    return least == greatest ? std::optional(least) : std::nullopt;
}

/// Whether the values at the corners do not change along an axis.
template <int D> bool is_level(const abacus_simplex &simplex, const double *values, int axis) {
    std::array<Point<D>, D + 1> points;
    Corners<D> corners;
    for (int i = 0; i <= D; ++i) {
        std::copy_n(simplex.corner[i], D, points[i].begin());
        points[i][axis] = values[i];
        corners[i] = &points[i];
    }
    return orientation<D>(corners) == 0;
}

template <int D>
exact::Rational exact_part(const abacus_simplex &simplex, const double *values, int axis) {
    using exact::Rational;
    const auto system = gradient_system<Rational, D>(simplex, values);
    const Rational whole = system.determinant(system.matrix);
    if (whole == 0) throw_corrupted("A simplex is flat.");
    return system.with_right_side(axis) / whole;
}

} // namespace

template <int D> Point<D> gradient_in(const abacus_simplex &simplex, const double *values) {
    const auto system = gradient_system<DoubleDouble, D>(simplex, values);
    const Determinant whole = determinant_of<D>(system.matrix);
    Point<D> gradient;
    for (int axis = 0; axis < D; ++axis) {
        auto matrix = system.matrix;
        for (int i = 0; i < D; ++i) matrix[i][axis] = system.right[i];
        const Determinant part = determinant_of<D>(matrix);
        if (const auto quotient = rounded_quotient(part, whole))
            gradient[axis] = *quotient;
        else if (!part.is_sure() && is_level<D>(simplex, values, axis))
            gradient[axis] = 0;
        else
            gradient[axis] = exact::nearest_double(exact_part<D>(simplex, values, axis));
    }
    return gradient;
}

template <int D>
int scaled_gradient_in(const abacus_simplex &simplex, const double *values, Point<D> &gradient) {
    gradient = gradient_in<D>(simplex, values);
    double most = 0;
    for (const double x : gradient) most = std::max(most, std::fabs(x));
    const bool is_ordinary = most > 1e-280 && std::isfinite(most);
    if (is_ordinary || std::all_of(values, values + D, [&](double x) { return x == values[D]; }))
        return 0;
    std::array<ScaledNumber, D> parts;
    int exponent = std::numeric_limits<int>::min();
    for (int axis = 0; axis < D; ++axis) {
        parts[axis] = exact::scaled(exact_part<D>(simplex, values, axis));
        if (parts[axis].value != 0) exponent = std::max(exponent, parts[axis].exponent);
    }
    for (int axis = 0; axis < D; ++axis)
        gradient[axis] = std::ldexp(parts[axis].value, parts[axis].exponent - exponent);
    return exponent;
}

template <int D>
bool gradient_at(Reader<D> &reader, const abacus_interpolation &what, const Point<D> &p,
                 double *gradient, int *exponent) {
    abacus_simplex simplex;
    CornerValues carried(what.attribute, 1);
    if (!reader.locate(p, simplex, &carried, what.extent)) return false;
    std::array<double, D + 1> values;
    bool is_finite = true;
    for (int i = 0; i <= D; ++i) {
        values[i] = carried.value(i, 0);
        is_finite = is_finite && std::isfinite(values[i]);
    }
    Point<D> result;
    result.fill(NAN);
    if (exponent != nullptr) *exponent = 0;
    if (is_finite && exponent != nullptr)
        *exponent = scaled_gradient_in<D>(simplex, values.data(), result);
    else if (is_finite)
        result = gradient_in<D>(simplex, values.data());
    std::copy(result.begin(), result.end(), gradient);
    return true;
}

template Point<2> gradient_in<2>(const abacus_simplex &, const double *);
template Point<3> gradient_in<3>(const abacus_simplex &, const double *);
template int scaled_gradient_in<2>(const abacus_simplex &, const double *, Point<2> &);
template int scaled_gradient_in<3>(const abacus_simplex &, const double *, Point<3> &);
template bool gradient_at<2>(Reader<2> &, const abacus_interpolation &, const Point<2> &, double *,
                             int *);
template bool gradient_at<3>(Reader<3> &, const abacus_interpolation &, const Point<3> &, double *,
                             int *);

} // namespace abacus
