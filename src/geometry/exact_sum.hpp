// A sum of doubles without rounding: the same to the last bit in whatever order they come.
//
// A double is a whole number of times the least one, 2^-1074. The sum is kept as such a number, in
// digits of 32 bits, each in a word of 64 (R. Neal, "Fast exact summation using small and large
// superaccumulators", 2015). So a digit takes a billion summands before it must be carried, and a
// summand changes three digits. The sum is rounded once, when it is asked for.
//
// Summands may have a power of two as a factor, which reaches beyond the range of doubles: products
// of several doubles are summed that neither overflow nor underflow.
#pragma once

#include "geometry/scaled_number.hpp"

#include <array>
#include <bit>
#include <cstdint>

namespace abacus {

/// Of doubles times powers of two, from 2^-below to 2^above.
template <int below, int above> class SumOf {
public:
    /// Adds x * 2^scale.
    void add(double x, int scale = 0) {
        const auto bits = std::bit_cast<std::uint64_t>(x);
        const auto exponent = static_cast<unsigned>(bits >> fraction_bits & 0x7ff);
        if (exponent == 0x7ff) { // infinite, or no number
            special_ += x;
            return;
        }
        std::uint64_t fraction = bits & ((std::uint64_t{1} << fraction_bits) - 1);
        auto place = static_cast<unsigned>(below + scale);
        if (exponent != 0) {
            fraction |= std::uint64_t{1} << fraction_bits;
            place += exponent - 1;
        }
        const Wide wide = static_cast<Wide>(fraction) << place % digit_bits;
        std::int64_t *const digit = &digits_[place / digit_bits];
        const std::int64_t sign = static_cast<std::int64_t>(bits) < 0 ? -1 : 1;
        digit[0] += sign * static_cast<std::int64_t>(static_cast<std::uint32_t>(wide));
        digit[1] += sign * static_cast<std::int64_t>(static_cast<std::uint32_t>(wide >> 32));
        digit[2] += sign * static_cast<std::int64_t>(wide >> 64);
        if (++added_ == most_added) carry();
    }
    /// Sums without infinities and NaN.
    void add(const SumOf &other);
    SumOf times(std::uint32_t factor) const;
    bool operator<(const SumOf &other) const;
    bool is_zero() const { return scaled().value == 0; }
    /// The double nearest to the sum; infinite beyond all of them, or after an infinite summand.
    double value() const;
    /// The sum with the precision of a double, whatever its size.
    ScaledNumber scaled() const;

private:
    using Wide = unsigned __int128;
    static constexpr unsigned fraction_bits = 52, digit_bits = 32;
    /// 2^2098 is beyond all doubles; there is room for as many as a word can count.
    static constexpr std::size_t size = (below + 2098 + above + 64) / digit_bits + 1;
    /// Of 2^32 each, in 63 bits, with what was carried into a digit.
    static constexpr std::uint32_t most_added = 1u << 30;

    /// Leaves each digit but the last from 0 to 2^32 - 1.
    void carry();

    std::array<std::int64_t, size> digits_{};
    std::uint32_t added_ = 0; ///< since the last carry
    double special_ = 0;
};

using ExactSum = SumOf<0, 0>;
/// Of products of up to five doubles.
using WideSum = SumOf<5440, 5184>;

/// Adds a * b * 2^scale without rounding, of finite doubles.
void add_product(WideSum &sum, double a, double b, int scale = 0);

extern template class SumOf<0, 0>;
extern template class SumOf<5440, 5184>;

} // namespace abacus
