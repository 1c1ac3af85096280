#include "geometry/exact_sum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace abacus {

template <int below, int above> void SumOf<below, above>::carry() {
    for (std::size_t i = 0; i + 1 < size; ++i) {
        const std::int64_t over = digits_[i] >> digit_bits;
        digits_[i] -= over << digit_bits;
        digits_[i + 1] += over;
    }
    added_ = 0;
}

template <int below, int above> void SumOf<below, above>::add(const SumOf &other) {
    SumOf more = other;
    more.carry();
    carry(); // so that digits have room
    for (std::size_t i = 0; i < size; ++i) digits_[i] += more.digits_[i];
    added_ = 1;
}

template <int below, int above>
SumOf<below, above> SumOf<below, above>::times(std::uint32_t factor) const {
    SumOf product = *this;
    product.carry();
    __int128 over = 0;
    for (std::size_t i = 0; i < size; ++i) {
        over += static_cast<__int128>(product.digits_[i]) * factor;
        if (i + 1 == size) { // the greatest has the sign
            product.digits_[i] = static_cast<std::int64_t>(over);
            break;
        }
        const auto digit = static_cast<std::uint32_t>(over);
        product.digits_[i] = digit;
        over = (over - digit) >> digit_bits;
    }
    return product;
}

template <int below, int above> bool SumOf<below, above>::operator<(const SumOf &other) const {
    SumOf difference = *this, less = other;
    difference.carry();
    less.carry();
    for (std::size_t i = 0; i < size; ++i) difference.digits_[i] -= less.digits_[i];
    difference.carry();
    return difference.digits_.back() < 0;
}

template <int below, int above> double SumOf<below, above>::value() const {
    const auto rounded = [](const SumOf &sum) {
        const ScaledNumber number = sum.scaled();
        return std::scalbn(number.value, number.exponent);
    };
    const double value = rounded(*this);
    constexpr double least = std::numeric_limits<double>::min();
    if (below == 0 || std::fabs(value) > least) return value;
    // A subnormal double would be rounded twice. The last bit of the least normal ones is the same.
    const double lift = std::copysign(least, value);
    SumOf lifted = *this;
    lifted.add(lift);
    return rounded(lifted) - lift;
}

template <int below, int above> ScaledNumber SumOf<below, above>::scaled() const {
    if (special_ != 0) return {special_, 0}; // also NaN
    SumOf sum = *this;
    sum.carry();
    const bool is_negative = sum.digits_.back() < 0;
    if (is_negative) {
        for (std::int64_t &digit : sum.digits_) digit = -digit;
        sum.carry();
    }
    std::size_t first = size - 1;
    while (first > 0 && sum.digits_[first] == 0) --first;
    // Three digits have more bits than a double, and a spare one that stands for all lower digits.
    const std::size_t last = std::max<std::size_t>(first, 2) - 2;
    Wide leading = 0;
    for (std::size_t i = first + 1; i-- > last;)
        leading = leading << digit_bits | static_cast<Wide>(sum.digits_[i]);
    const bool is_rest = std::any_of(sum.digits_.begin(), sum.digits_.begin() + last,
                                     [](std::int64_t digit) { return digit != 0; });
    const auto value = static_cast<double>(leading | static_cast<Wide>(is_rest));
    return {is_negative ? -value : value, static_cast<int>(last * digit_bits) - 1074 - below};
}

void add_product(WideSum &sum, double a, double b, int scale) {
    int of_a = 0, of_b = 0;
    a = std::frexp(a, &of_a);
    b = std::frexp(b, &of_b);
    const double product = a * b;
    sum.add(product, of_a + of_b + scale);
    sum.add(std::fma(a, b, -product), of_a + of_b + scale);
}

template class SumOf<0, 0>;
template class SumOf<5440, 5184>;

} // namespace abacus
