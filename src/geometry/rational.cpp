#include "geometry/rational.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace abacus::exact {

namespace {

// Non-negative doubles have the same order as their bits.
double of_bits(std::uint64_t bits) { return std::bit_cast<double>(bits); }

/// The double nearest to a number that is not negative.
double nearest_to_positive(const Rational &x) {
    constexpr double greatest = std::numeric_limits<double>::max();
    if (x >= Rational(greatest)) {
        // From half a step beyond the greatest double on, the result is infinite.
        const Rational end = Rational(greatest) + Rational(std::ldexp(1.0, 970));
        return x < end ? greatest : std::numeric_limits<double>::infinity();
    }
    // below <= x < above. The conversion is usually right up to one step.
    std::uint64_t below = 0, above = std::bit_cast<std::uint64_t>(greatest);
    const double guess = std::fabs(CGAL::to_double(x));
    if (guess > 0 && guess < greatest) {
        const auto bits = std::bit_cast<std::uint64_t>(guess);
        if (Rational(of_bits(bits - 1)) <= x) below = bits - 1;
        if (Rational(of_bits(bits + 1)) > x) above = bits + 1;
    }
    while (above - below > 1) {
        const std::uint64_t middle = below + (above - below) / 2;
        (Rational(of_bits(middle)) <= x ? below : above) = middle;
    }
    const Rational twice = x + x, between = Rational(of_bits(below)) + Rational(of_bits(above));
    if (twice == between) return of_bits(below % 2 == 0 ? below : above);
    return of_bits(twice < between ? below : above);
}

} // namespace

double nearest_double(const Rational &x) {
    return x < 0 ? -nearest_to_positive(-x) : nearest_to_positive(x);
}

ScaledNumber scaled(Rational x) {
    constexpr int step = 500;
    const Rational large(std::ldexp(1.0, step));
    ScaledNumber number{0, 0};
    for (; CGAL::abs(x) > large; x /= large) number.exponent += step;
    for (; x != 0 && CGAL::abs(x) * large < 1; x *= large) number.exponent -= step;
    int exponent = 0;
    number.value = std::frexp(nearest_double(x), &exponent);
    number.exponent += exponent;
    return number;
}

} // namespace abacus::exact
