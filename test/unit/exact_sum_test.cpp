// Sums without rounding: compared with rational arithmetic, in any order.
#include "geometry/exact_sum.hpp"
#include "geometry/rational.hpp"

#include <CGAL/Exact_rational.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace abacus::test {
namespace {

using Rational = CGAL::Exact_rational;

double sum_of(const std::vector<double> &summands) {
    ExactSum sum;
    for (const double x : summands) sum.add(x);
    return sum.value();
}

Rational size_of(const Rational &x) { return x < 0 ? Rational(-x) : x; }

/// No double is nearer to the sum, and if two are equally near, it is the even one.
void expect_nearest(const std::vector<double> &summands) {
    Rational sum = 0;
    for (const double x : summands) sum += Rational(x);
    const double value = sum_of(summands);
    ASSERT_TRUE(std::isfinite(value));
    const Rational error = size_of(sum - Rational(value));
    for (const double other : {std::nextafter(value, -HUGE_VAL), std::nextafter(value, HUGE_VAL)}) {
        if (!std::isfinite(other)) continue;
        const Rational further = size_of(sum - Rational(other));
        EXPECT_LE(error, further) << value;
        if (error == further) {
            EXPECT_EQ(std::bit_cast<std::uint64_t>(value) % 2, 0u) << value;
        }
    }
}

TEST(ExactSum, IsTheNearestDouble) {
    std::mt19937_64 random(1);
    for (const int spread : {0, 3, 60, 500, 1020}) {
        for (int round = 0; round < 200; ++round) {
            std::vector<double> summands;
            for (std::uint64_t n = random() % 40; n > 0; --n) {
                const double x = std::uniform_real_distribution<double>(-1, 1)(random);
                const int shift = spread == 0 ? 0 : static_cast<int>(random() % (2 * spread + 1));
                summands.push_back(std::scalbn(x, shift - spread));
                if (random() % 3 == 0) summands.push_back(-summands[random() % summands.size()]);
            }
            expect_nearest(summands);
        }
    }
}

/// Sums of sums, multiples, and which of two is less: as rational numbers.
TEST(ExactSum, CalculatesExactly) {
    std::mt19937_64 random(3);
    for (int round = 0; round < 2000; ++round) {
        ExactSum sums[2];
        Rational exact[2] = {0, 0};
        for (int i = 0; i < 2; ++i)
            for (std::uint64_t n = random() % 6; n > 0; --n) {
                const double x = std::scalbn(static_cast<double>(random() % 9) - 3,
                                             static_cast<int>(random() % 2 * (random() % 900)));
                sums[i].add(x);
                exact[i] += Rational(x);
            }
        const auto factor = static_cast<std::uint32_t>(random() >> random() % 33 >> 32);
        ExactSum both = sums[0];
        both.add(sums[1]);
        const Rational all = exact[0] + exact[1];
        EXPECT_EQ(sums[0] < sums[1], exact[0] < exact[1]);
        EXPECT_FALSE(sums[0] < sums[0]);
        EXPECT_EQ(both.times(factor) < sums[0], all * factor < exact[0]);
        EXPECT_EQ(sums[1] < both.times(factor), exact[1] < all * factor);
        EXPECT_EQ(both.is_zero(), all == 0);
        ExactSum repeated; // the same once more, by adding
        for (std::uint32_t i = 0; i < factor % 50; ++i) repeated.add(both);
        const ExactSum product = both.times(factor % 50);
        EXPECT_FALSE(product < repeated || repeated < product);
    }
}

TEST(ExactSum, IsTheSameInAnyOrder) {
    std::mt19937_64 random(2);
    std::vector<double> summands;
    for (int i = 0; i < 1000; ++i)
        summands.push_back(std::scalbn(std::uniform_real_distribution<double>(-1, 1)(random),
                                       static_cast<int>(random() % 200)));
    const double value = sum_of(summands);
    for (int round = 0; round < 20; ++round) {
        std::shuffle(summands.begin(), summands.end(), random);
        EXPECT_EQ(sum_of(summands), value);
    }
}

TEST(ExactSum, HasNoLimits) {
    constexpr double most = std::numeric_limits<double>::max();
    constexpr double least = std::numeric_limits<double>::denorm_min();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(sum_of({}), 0);
    EXPECT_EQ(sum_of({most, most, -most, -most, least}), least);
    EXPECT_EQ(sum_of({most, 1, -most}), 1);
    EXPECT_EQ(sum_of({-least, -least, least}), -least);
    EXPECT_EQ(sum_of({most, most}), infinity);
    EXPECT_EQ(sum_of({-most, -most}), -infinity);
    EXPECT_EQ(sum_of({1, infinity, 5}), infinity);
    EXPECT_TRUE(std::isnan(sum_of({infinity, -infinity})));
    // Ties, and sums that just break one.
    EXPECT_EQ(sum_of({1, 0x1p-53}), 1);
    EXPECT_EQ(sum_of({1, 0x1p-52, 0x1p-53}), 1 + 0x1p-51);
    EXPECT_EQ(sum_of({1, 0x1p-53, least}), 1 + 0x1p-52);
}

/// Summands far beyond the range of doubles cancel, and what is left is exact.
TEST(WideSum, ReachesBeyondDoubles) {
    for (const int scale : {-5440, -3000, -1, 0, 1, 3000, 5184}) {
        WideSum sum;
        sum.add(3, scale);
        sum.add(0x1p1023, 5184);
        sum.add(0x1p-1074, scale);
        sum.add(-0x1p1023, 5184);
        sum.add(-0.5, scale);
        sum.add(-0x1p-1074, scale);
        const ScaledNumber number = sum.scaled();
        int exponent = 0;
        EXPECT_EQ(std::frexp(number.value, &exponent), 0.625) << scale; // of 2.5
        EXPECT_EQ(number.exponent + exponent, 2 + scale);
    }
}

/// Products of doubles of any size, and what is left of them where they cancel.
TEST(WideSum, OfProductsIsTheNearestDouble) {
    std::mt19937_64 random(4);
    const auto any = [&](int least, int most) {
        const double x = std::uniform_real_distribution<double>(-1, 1)(random);
        return std::scalbn(x, std::uniform_int_distribution<int>(least, most)(random));
    };
    for (int round = 0; round < 3000; ++round) {
        WideSum sum;
        Rational exact = 0;
        const auto add = [&](double a, double b, int scale) {
            add_product(sum, a, b, scale);
            exact += Rational(a) * Rational(b) * (scale < 0 ? Rational(0.5) : Rational(1));
        };
        const int least = round % 2 == 0 ? -1074 : -550, most = round % 2 == 0 ? 1024 : -500;
        for (std::uint64_t n = random() % 4; n > 0; --n) {
            const double a = any(least, most), b = any(least, most);
            const int scale = -static_cast<int>(random() % 2);
            add(a, b, scale);
            if (random() % 2 == 0) add(std::nextafter(a, 0), -b, scale);
        }
        EXPECT_EQ(sum.is_zero(), exact == 0);
        EXPECT_EQ(sum.value(), exact::nearest_double(exact));
    }
}

} // namespace
} // namespace abacus::test
