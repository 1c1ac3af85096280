// Numbers of two doubles, which have 106 bits: for what doubles do not tell and rational numbers
// take long to tell.
//
// The algorithms and their bounds are those of Joldes, Muller and Popescu ("Tight and Rigorous
// Error Bounds for Basic Building Blocks of Double-Word Arithmetic", 2017), where u = 2^-53: a sum
// is right to 3u² of itself (and a sum or difference of two doubles is exact), a product to 5u², a
// quotient to 15u². They hold while nothing underflows or overflows.
#pragma once

#include <cmath>

namespace abacus {

struct DoubleDouble {
    double high = 0, low = 0; // low is at most half a unit of high's last place

    DoubleDouble() = default;
    explicit DoubleDouble(double x) : high(x) {}
    DoubleDouble(double h, double l) : high(h), low(l) {}

    DoubleDouble operator-() const { return {-high, -low}; }
};

/// a + b without rounding (Knuth).
inline DoubleDouble two_sum(double a, double b) {
    const double sum = a + b, part = sum - a;
    return {sum, (a - (sum - part)) + (b - part)};
}

/// The same where b is not larger than a (Dekker).
inline DoubleDouble quick_two_sum(double a, double b) {
    const double sum = a + b;
    return {sum, b - (sum - a)};
}

inline DoubleDouble operator+(const DoubleDouble &x, const DoubleDouble &y) {
    const DoubleDouble high = two_sum(x.high, y.high), low = two_sum(x.low, y.low);
    const DoubleDouble sum = quick_two_sum(high.high, high.low + low.high);
    return quick_two_sum(sum.high, low.low + sum.low);
}

inline DoubleDouble operator-(const DoubleDouble &x, const DoubleDouble &y) { return x + -y; }

inline DoubleDouble &operator+=(DoubleDouble &x, const DoubleDouble &y) { return x = x + y; }

inline DoubleDouble operator*(const DoubleDouble &x, const DoubleDouble &y) {
    const double high = x.high * y.high, rest = std::fma(x.high, y.high, -high);
    const double cross = std::fma(x.low, y.high, std::fma(x.high, y.low, x.low * y.low));
    return quick_two_sum(high, rest + cross);
}

inline DoubleDouble operator/(const DoubleDouble &x, const DoubleDouble &y) {
    const double high = x.high / y.high;
    // y · high, to 2u²
    const double product = y.high * high, rest = std::fma(y.high, high, -product);
    const DoubleDouble back = quick_two_sum(product, std::fma(y.low, high, rest));
    const double left = (x.high - back.high) + (x.low - back.low);
    return quick_two_sum(high, left / y.high);
}

} // namespace abacus
