// Numbers of any size: doubles times powers of two. They are rounded like doubles, but neither
// overflow nor underflow.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace abacus {

/// A number of any size: value * 2^exponent. The value is an ordinary double.
struct ScaledNumber {
    double value;
    int exponent;
};

/// x * 2^exponent, with a value from 1/2 to 1, or 0.
inline ScaledNumber scaled(double x, int exponent = 0) {
    int more = 0;
    const double value = std::frexp(x, &more);
    return {value, exponent + more};
}
inline ScaledNumber scaled_difference(double a, double b) {
    const double difference = a - b;
    return std::isfinite(difference) ? scaled(difference) : scaled(a / 2 - b / 2, 1);
}

inline double rounded(const ScaledNumber &a) { return std::ldexp(a.value, a.exponent); }

inline ScaledNumber operator*(const ScaledNumber &a, const ScaledNumber &b) {
    const ScaledNumber x = scaled(a.value, a.exponent), y = scaled(b.value, b.exponent);
    return scaled(x.value * y.value, x.exponent + y.exponent);
}
inline ScaledNumber operator/(const ScaledNumber &a, const ScaledNumber &b) {
    const ScaledNumber x = scaled(a.value, a.exponent), y = scaled(b.value, b.exponent);
    return {x.value / y.value, x.exponent - y.exponent};
}
inline ScaledNumber operator+(const ScaledNumber &a, const ScaledNumber &b) {
    if (a.value == 0) return b;
    if (b.value == 0) return a;
    const int most = std::max(a.exponent, b.exponent);
    return scaled(std::ldexp(a.value, a.exponent - most) + std::ldexp(b.value, b.exponent - most),
                  most);
}
inline ScaledNumber operator-(const ScaledNumber &a, const ScaledNumber &b) {
    return a + ScaledNumber{-b.value, b.exponent};
}

/// The length of a vector.
inline ScaledNumber length(const ScaledNumber &x, const ScaledNumber &y, const ScaledNumber &z) {
    if (x.value == 0 && y.value == 0 && z.value == 0) return {0, 0};
    const auto exponent = [](const ScaledNumber &a) {
        return a.value == 0 ? std::numeric_limits<int>::min() : a.exponent;
    };
    const int most = std::max({exponent(x), exponent(y), exponent(z)});
    const auto part = [most](const ScaledNumber &a) {
        return a.value == 0 ? 0 : std::ldexp(a.value, a.exponent - most);
    };
    return {std::hypot(part(x), part(y), part(z)), most};
}

} // namespace abacus
