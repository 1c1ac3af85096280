#include "geometry/cutting_plane.hpp"

#include <CGAL/Exact_rational.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace abacus {

namespace {

using Rational = CGAL::Exact_rational;

/// 2 to a power that may be outside the range of doubles.
Rational power_of_two(int exponent) {
    const int half = exponent / 2;
    return Rational(std::ldexp(1.0, half)) * Rational(std::ldexp(1.0, exponent - half));
}

} // namespace

CuttingPlane::CuttingPlane(const Point<3> &through, const Point<3> &normal)
    : through_(through), given_(normal) {
    double largest = 0;
    for (const double x : normal) largest = std::max(largest, std::fabs(x));
    exponent_ = std::ilogb(largest) + 5;
    if (std::count(normal.begin(), normal.end(), 0.0) == 2)
        axis_ = static_cast<int>(
            std::find_if(normal.begin(), normal.end(), [](double x) { return x != 0; }) -
            normal.begin());
    for (int i = 0; i < 3; ++i) {
        normal_[i] = std::scalbn(normal[i], -exponent_);
        is_rounded_ = is_rounded_ || std::scalbn(normal_[i], exponent_) != normal[i];
    }
}

double CuttingPlane::height(const Point<3> &p) const {
    double sum = 0, size = 0;
    bool is_zero = true;
    for (int i = 0; i < 3; ++i) {
        const double way = p[i] - through_[i]; // 0 only if they are equal
        const double term = normal_[i] * way;
        is_zero = is_zero && (given_[i] == 0 || way == 0);
        sum += term;
        size += std::fabs(term);
    }
    if (is_zero) return 0;
    // Right to nine digits. Infinite sums are not below any bound.
    if (std::fabs(sum) > 1e-6 * size && size > 1e-280 && size < 1e300 && !is_rounded_) [[likely]]
        return sum;
    return exact_height(p);
}

double CuttingPlane::exact_height(const Point<3> &p) const {
    Rational sum = 0;
    for (int i = 0; i < 3; ++i)
        sum += Rational(given_[i]) * (Rational(p[i]) - Rational(through_[i]));
    const int side = sum > 0 ? 1 : sum < 0 ? -1 : 0;
    constexpr double least = std::numeric_limits<double>::denorm_min();
    const double height = std::fabs(CGAL::to_double(Rational(sum * power_of_two(-exponent_))));
    return side == 0 ? 0 : side * std::max(height, least);
}

} // namespace abacus
