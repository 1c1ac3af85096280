// The order of lengths as numbers to sort by.
//
// The square of a length is a sum of products of doubles, computed without rounding, as a sum of
// doubles that do not overlap (Shewchuk 1997). The double nearest to it comes first, the one
// nearest to the rest second, and so on. Rounding preserves order; so the lesser of two squares has
// the lesser first double, or, if these are equal, the lesser second one, and so on. Four doubles
// separate squares that agree in their first 212 bits. The exponent of the first comes before them.
#pragma once

#include "blocks/bit_column.hpp"
#include "geometry/point.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace abacus {

class LengthSum {
public:
    void add(double x) {
        std::size_t left = 0;
        for (std::size_t i = 0; i < size_; ++i) {
            double part = parts_[i];
            if (std::abs(x) < std::abs(part)) std::swap(x, part);
            const double high = x + part, low = part - (high - x);
            if (low != 0) parts_[left++] = low;
            x = high;
        }
        parts_[left] = x;
        size_ = left + 1;
    }
    void add_product(double a, double b) {
        const double product = a * b;
        add(std::fma(a, b, -product));
        add(product);
    }
    /// Subtracts the double nearest to the sum from it, and returns that double.
    double take_nearest() {
        std::size_t i = size_ - 1;
        double high = parts_[i], low = 0;
        while (i > 0 && low == 0) {
            const double part = parts_[--i], sum = high + part;
            low = part - (sum - high);
            high = sum;
        }
        // Halfway between two doubles the rest decides, if there is one.
        if (i > 0 && low != 0 && (low < 0) == (parts_[i - 1] < 0) && parts_[i - 1] != 0) {
            const double twice = 2 * low, other = high + twice;
            if (other - high == twice) high = other;
        }
        add(-high);
        return high;
    }

private:
    // For three products of sums of two, and what is subtracted.
    static constexpr std::size_t most = 32;
    std::array<double, most> parts_{}; // the least first
    std::size_t size_ = 1;
};

/// Words whose lexicographic order, as numbers without a sign, is that of the lengths.
using LengthKey = std::array<std::uint64_t, 5>;
inline constexpr int length_key_bias = 4096; // no exponent is less than its negative

/// The key of a length that is not 0.
template <int D> LengthKey length_key(const Point<D> &a, const Point<D> &b) {
    // Powers of two bring the length near to 1, so that no square is lost or too large.
    double greatest = 0, extent = 0;
    for (int i = 0; i < D; ++i) greatest = std::max({greatest, std::abs(a[i]), std::abs(b[i])});
    const double shrink = greatest > 0x1p1020 ? 0x1p-4 : 1;
    for (int i = 0; i < D; ++i) extent = std::max(extent, std::abs(b[i] * shrink - a[i] * shrink));
    const int exponent = std::ilogb(extent);
    LengthSum sum;
    for (int i = 0; i < D; ++i) {
        const double from = a[i] * shrink, to = b[i] * shrink, rounded = to - from;
        const double to_part = rounded + from, from_part = to_part - rounded;
        const double edge = std::ldexp(rounded, -exponent);
        const double rest = std::ldexp((to - to_part) - (from - from_part), -exponent);
        sum.add_product(edge, edge);
        if (rest == 0) continue;
        sum.add_product(2 * edge, rest);
        sum.add_product(rest, rest);
    }
    const double first = sum.take_nearest();
    const int more = std::ilogb(first);
    const int shrunk = shrink < 1 ? 8 : 0;
    LengthKey key{static_cast<std::uint64_t>(2 * exponent + more + shrunk + length_key_bias),
                  ordered(std::ldexp(first, -more))};
    for (std::size_t i = 2; i < key.size(); ++i)
        key[i] = ordered(std::ldexp(sum.take_nearest(), -more) + 0.0);
    return key;
}

/// The length itself, rounded: a longer one has no lesser double.
inline double length_of(const LengthKey &key) {
    const int exponent = static_cast<int>(key[0]) - length_key_bias, half = exponent >> 1;
    return std::ldexp(std::sqrt(std::ldexp(from_ordered(key[1]), exponent - 2 * half)), half);
}

} // namespace abacus
