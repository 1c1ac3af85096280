// Distances, compared with rational arithmetic, on input that makes a filter fail.
#include "geometry/distance.hpp"

#include <CGAL/Exact_rational.h>

#include <gtest/gtest.h>

#include <random>

namespace abacus {
namespace {

using Random = std::mt19937_64;
using Rational = CGAL::Exact_rational;

template <int D> int rational_sign(const Point<D> &p, const Point<D> &a, const Point<D> &b) {
    Rational difference = 0;
    for (int i = 0; i < D; ++i) {
        const Rational to_a = Rational(a[i]) - Rational(p[i]),
                       to_b = Rational(b[i]) - Rational(p[i]);
        difference += to_a * to_a - to_b * to_b;
    }
    return CGAL::sign(difference);
}

template <int D> void compare(const std::function<double()> &coordinate, int least_ties) {
    int ties = 0;
    for (int round = 0; round < 3000; ++round) {
        Point<D> p, a, b;
        for (int i = 0; i < D; ++i) {
            p[i] = coordinate();
            a[i] = coordinate();
            b[i] = coordinate();
        }
        const int expected = rational_sign<D>(p, a, b);
        ties += expected == 0;
        ASSERT_EQ(compare_distance<D>(p, a, b), expected);
        ASSERT_EQ(compare_distance<D>(p, b, a), -expected);
        ASSERT_EQ(exact::compare_distance<D>(p, a, b), expected);
        ASSERT_EQ(compare_distance<D>(p, a, a), 0);
    }
    EXPECT_GE(ties, least_ties);
}

void compare_both(const std::function<double()> &coordinate, int least_ties = 0) {
    compare<2>(coordinate, least_ties);
    compare<3>(coordinate, least_ties);
}

TEST(Distance, IsComparedAsInRationalArithmetic) {
    Random random(1);
    const auto unit = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
    compare_both(unit);
    compare_both([&] { return static_cast<double>(random() % 5); }, 100);
    compare_both([&] { return 1 + static_cast<double>(random() % 3) * 0x1p-52; }, 100);
    compare_both([&] { return static_cast<double>(random() % 3) * 0x1p-1074; }, 100);
    compare_both([&] { return unit() * 1.7e308; });
    compare_both([&] { return (random() % 2 == 0 ? 1 : -1) * 1.7e308; }, 100);
    compare_both([&] { return std::ldexp(unit(), static_cast<int>(random() % 2000) - 1000); });
}

TEST(Distance, OfEquallyFarPointsTheLeastComesFirst) {
    const Point<2> p{0, 0}, a{-5, 0}, b{-3, 4}, c{3, -4};
    EXPECT_TRUE(comes_nearer<2>(p, a, b));
    EXPECT_FALSE(comes_nearer<2>(p, b, a));
    EXPECT_TRUE(comes_nearer<2>(p, b, c));
    EXPECT_FALSE(comes_nearer<2>(p, a, a));
    EXPECT_TRUE(comes_nearer<2>({0, -1e-300}, c, a));
}

TEST(Distance, DoesNotOverflowWhereItsSquareDoes) {
    EXPECT_DOUBLE_EQ(distance<2>({0, 0}, {3e200, 4e200}), 5e200);
    EXPECT_EQ(distance<3>({1, 1, 1}, {1, 1, 1}), 0);
}

} // namespace
} // namespace abacus
