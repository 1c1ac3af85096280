// Weights and gradients in flat or nearly flat simplices, compared with rational numbers.
#include "geometry/flatness.hpp"
#include "geometry/rational.hpp"
#include "query/values/barycentric.hpp"
#include "query/values/gradient.hpp"

#include <gtest/gtest.h>

#include <random>

namespace abacus::test {
namespace {

using exact::Rational;

template <class Dimension> class FlatValues : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(FlatValues, Dimensions);

template <int D> Rational determinant(const std::array<std::array<Rational, D>, D> &m) {
    if constexpr (D == 2)
        return m[0][0] * m[1][1] - m[0][1] * m[1][0];
    else
        return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
               m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

template <int D> std::array<std::array<Rational, D>, D> edges_of(const abacus_simplex &simplex) {
    std::array<std::array<Rational, D>, D> edges;
    for (int i = 0; i < D; ++i)
        for (int axis = 0; axis < D; ++axis)
            edges[i][axis] =
                Rational(simplex.corner[i + 1][axis]) - Rational(simplex.corner[0][axis]);
    return edges;
}

/// The weights of all corners except the first, by Cramer's rule; then that of the first.
template <int D>
std::array<Rational, D + 1> exact_weights(const abacus_simplex &simplex, const Point<D> &p) {
    const auto edges = edges_of<D>(simplex);
    const Rational whole = determinant<D>(edges);
    std::array<Rational, D + 1> weights;
    weights[0] = 1;
    for (int i = 0; i < D; ++i) {
        auto replaced = edges;
        for (int axis = 0; axis < D; ++axis)
            replaced[i][axis] = Rational(p[axis]) - Rational(simplex.corner[0][axis]);
        weights[i + 1] = determinant<D>(replaced) / whole;
        weights[0] -= weights[i + 1];
    }
    return weights;
}

/// Simplices of several kinds, positively oriented.
template <int D> class Source {
public:
    explicit Source(unsigned seed) : random_(seed) {}

    abacus_simplex next() {
        for (;;) {
            abacus_simplex simplex{};
            make(simplex, static_cast<int>(random_() % 6));
            Corners<D> corners;
            std::array<Point<D>, D + 1> points;
            for (int i = 0; i <= D; ++i) {
                std::copy_n(simplex.corner[i], D, points[i].begin());
                corners[i] = &points[i];
            }
            const int sign = orientation<D>(corners);
            if (sign == 0) continue;
            if (sign < 0)
                std::swap_ranges(simplex.corner[0], simplex.corner[0] + D, simplex.corner[1]);
            return simplex;
        }
    }
    double uniform(double least, double greatest) {
        return std::uniform_real_distribution<double>(least, greatest)(random_);
    }
    int whole(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }

private:
    void make(abacus_simplex &simplex, int sort) {
        const double slope[3] = {1.0 + whole(9), (1 + whole(9)) * 0.1, (1 + whole(9)) / 7.0};
        const double angle = whole(90) * 0.1, size = std::ldexp(1.0, whole(900) - 450);
        for (int i = 0; i <= D; ++i) {
            const double steps = whole(40), x = whole(40), y = whole(3);
            double *const c = simplex.corner[i];
            for (int axis = 0; axis < D; ++axis) {
                c[axis] = uniform(-1, 1);                           // any
                if (sort == 1) c[axis] = slope[axis] * steps;       // on a line but for rounding
                if (sort == 3) c[axis] += (axis + 1) * steps * 1e6; // a needle
                if (sort == 4) c[axis] = slope[axis] * steps * size;
                if (sort == 5) c[axis] = std::ldexp(c[axis], whole(2040) - 1020);
            }
            if (sort == 2) { // on a turned grid, in space one that is sheared
                c[0] = x * std::cos(angle) - y * std::sin(angle);
                c[1] = x * std::sin(angle) + y * std::cos(angle);
                if (D == 3) c[2] = x * 0.3 + y * 0.7;
            }
        }
    }

    std::mt19937 random_;
};

/// Corners, middles of edges, and various places inside.
template <int D> std::vector<Point<D>> places_in(const abacus_simplex &simplex, Source<D> &source) {
    std::vector<Point<D>> candidates(4), places;
    for (Point<D> &p : candidates) {
        double weights[D + 1], sum = 0;
        for (double &weight : weights) sum += weight = source.uniform(0, 1);
        p.fill(0);
        for (int i = 0; i <= D; ++i)
            for (int axis = 0; axis < D; ++axis)
                p[axis] += simplex.corner[i][axis] * (weights[i] / sum);
    }
    for (int i = 0; i <= D; ++i)
        for (int j = 0; j <= i; ++j) {
            Point<D> middle;
            for (int axis = 0; axis < D; ++axis)
                middle[axis] = simplex.corner[i][axis] / 2 + simplex.corner[j][axis] / 2;
            candidates.push_back(middle);
        }
    Corners<D> corners;
    std::array<Point<D>, D + 1> points;
    for (int i = 0; i <= D; ++i) {
        std::copy_n(simplex.corner[i], D, points[i].begin());
        corners[i] = &points[i];
    }
    for (const Point<D> &p : candidates)
        if (in_simplex<D>(corners, p) >= 0) places.push_back(p);
    return places;
}

TYPED_TEST(FlatValues, WeightsAreThoseOfRationalNumbers) {
    constexpr int D = TypeParam::value;
    Source<D> source(1);
    int inside = 0, flat = 0;
    for (int n = 0; n < 1500; ++n) {
        const abacus_simplex simplex = source.next();
        for (const Point<D> &p : places_in<D>(simplex, source)) {
            const auto weights = barycentric_weights<D>(simplex, p);
            const auto expected = exact_weights<D>(simplex, p);
            double sum = 0, error = 0;
            for (int i = 0; i <= D; ++i) {
                ASSERT_EQ(weights[i] > 0, expected[i] > 0) << n;
                ASSERT_GE(weights[i], 0) << n;
                sum += weights[i];
                error += std::fabs(CGAL::to_double(Rational(expected[i] - Rational(weights[i]))));
            }
            ASSERT_NEAR(sum, 1, 1e-15) << n;
            ASSERT_LE(error, 2 * most_weight_error) << n;
            inside += *std::max_element(weights.begin(), weights.end()) < 1;
            flat += std::fabs(CGAL::to_double(determinant<D>(edges_of<D>(simplex)))) < 1e-12;
        }
    }
    EXPECT_GT(inside, 1000);
    EXPECT_GT(flat, 1000);
}

/// Beyond the facet opposite a corner, the corner has no weight.
TYPED_TEST(FlatValues, PlacesBeyondAFacetHaveNothingOfItsCorner) {
    constexpr int D = TypeParam::value;
    Source<D> source(2);
    for (int n = 0; n < 1000; ++n) {
        const abacus_simplex simplex = source.next();
        Point<D> p;
        for (int axis = 0; axis < D; ++axis)
            p[axis] = std::nextafter(simplex.corner[0][axis], source.uniform(-1, 1));
        const auto weights = barycentric_weights<D>(simplex, p);
        const auto expected = exact_weights<D>(simplex, p);
        double sum = 0;
        for (int i = 0; i <= D; ++i) {
            ASSERT_EQ(weights[i] > 0, expected[i] > 0) << n;
            sum += weights[i];
        }
        ASSERT_NEAR(sum, 1, 1e-15) << n;
    }
}

bool is_nearest(double found, const Rational &exact) {
    const auto distance = [&](double x) {
        const Rational way = exact - Rational(x);
        return way < 0 ? Rational(-way) : way;
    };
    constexpr double greatest = std::numeric_limits<double>::max();
    if (std::isinf(found)) return exact * (found > 0 ? 1 : -1) > Rational(greatest);
    for (const double towards : {-greatest, greatest})
        if (distance(std::nextafter(found, towards)) < distance(found)) return false;
    return true;
}

TYPED_TEST(FlatValues, GradientsAreRoundedOnce) {
    constexpr int D = TypeParam::value;
    Source<D> source(3);
    for (int n = 0; n < 1500; ++n) {
        const abacus_simplex simplex = source.next();
        double values[D + 1];
        for (int i = 0; i <= D; ++i)
            values[i] = n % 3 == 0   ? source.uniform(-1, 1)
                        : n % 3 == 1 ? source.whole(3)
                                     : simplex.corner[i][1]; // that does not depend on x
        const auto edges = edges_of<D>(simplex);
        const Point<D> gradient = gradient_in<D>(simplex, values);
        for (int axis = 0; axis < D; ++axis) {
            auto replaced = edges;
            for (int i = 0; i < D; ++i)
                replaced[i][axis] = Rational(values[i + 1]) - Rational(values[0]);
            const Rational exact = determinant<D>(replaced) / determinant<D>(edges);
            ASSERT_TRUE(is_nearest(gradient[axis], exact))
                << n << " " << axis << " " << gradient[axis] << " " << CGAL::to_double(exact);
        }
    }
}

TYPED_TEST(FlatValues, ScaledGradientsNeitherOverflowNorUnderflow) {
    constexpr int D = TypeParam::value;
    abacus_simplex simplex{};
    for (const auto &[extent, height] : {std::pair{0x1p-30, 0x1p1000},
                                         {0x1p-1000, 0x1p1000},
                                         {0x1p600, 0x1p-600},
                                         {0x1p1000, 0x1p-1060}}) {
        double values[D + 1] = {};
        for (int i = 0; i < D; ++i) {
            simplex.corner[i + 1][i] = extent;
            values[i + 1] = (i + 1) * height;
        }
        Point<D> gradient;
        const int exponent = scaled_gradient_in<D>(simplex, values, gradient);
        EXPECT_EQ(std::ldexp(gradient[0], exponent - std::ilogb(height) + std::ilogb(extent)), 1);
        for (int i = 1; i < D; ++i) EXPECT_EQ(gradient[i], (i + 1) * gradient[0]);
        std::fill(values, values + D + 1, height);
        EXPECT_EQ(scaled_gradient_in<D>(simplex, values, gradient), 0);
        for (const double x : gradient) EXPECT_EQ(x, 0);
    }
}

TEST(NearestDouble, RoundsToEvenAndToInfinity) {
    const auto third = [](double x) { return exact::nearest_double(Rational(Rational(x) / 3)); };
    EXPECT_EQ(third(1), 1.0 / 3);
    EXPECT_EQ(third(-2), -2.0 / 3);
    EXPECT_EQ(third(0), 0);
    const Rational half = Rational(1) / 2, least = Rational(std::ldexp(1.0, -1074));
    EXPECT_EQ(exact::nearest_double(Rational(least * half)), 0);
    EXPECT_EQ(exact::nearest_double(Rational(least * half * 3)), std::ldexp(1.0, -1073));
    EXPECT_EQ(exact::nearest_double(Rational(least / 3 * 2)), std::ldexp(1.0, -1074));
    EXPECT_EQ(exact::nearest_double(Rational(Rational(0x1p53) + 1)), 0x1p53);
    EXPECT_EQ(exact::nearest_double(Rational(Rational(0x1p53) + 3)), 0x1p53 + 4);
    const Rational greatest(std::numeric_limits<double>::max()), step(std::ldexp(1.0, 971));
    EXPECT_EQ(exact::nearest_double(greatest), std::numeric_limits<double>::max());
    EXPECT_EQ(exact::nearest_double(Rational(greatest + step / 3)),
              std::numeric_limits<double>::max());
    EXPECT_EQ(exact::nearest_double(Rational(greatest + step / 2)), INFINITY);
    EXPECT_EQ(exact::nearest_double(Rational(-greatest * 7)), -INFINITY);
}

TEST(Flatness, IsAPropertyOfThePoints) {
    const Point<2> a{0, 0}, b{0.1, 0.3}, c{0.5, 1.5}, d{0.5, 1.6};
    for (const Corners<2> &corners : {Corners<2>{&a, &b, &c}, {&b, &c, &a}, {&c, &b, &a}})
        EXPECT_TRUE(is_flat_in_doubles<2>(corners));
    EXPECT_FALSE(is_flat_in_doubles<2>({&a, &b, &d}));
    const Point<3> u{0, 0, 0}, v{1, 0, 0}, w{0, 1, 0}, low{0.1, 0.1, 1e-30};
    EXPECT_FALSE(is_flat_in_doubles<3>({&u, &v, &w, &low}));
    // Very small or large simplices are not flat.
    for (const double size : {1e-320, 1e-100, 1e200, 1.7e308}) {
        const Point<3> o{-size, -size, -size}, x{size, -size, -size}, y{-size, size, -size},
            z{0, 0, size};
        EXPECT_FALSE(is_flat_in_doubles<3>({&o, &x, &y, &z})) << size;
        const double tenth = size / 10;
        const Point<2> p{0, 0}, q{size, tenth}, r{tenth * 5, tenth / 2}, s{size, size};
        EXPECT_FALSE(is_flat_in_doubles<2>({&p, &q, &s})) << size;
        EXPECT_EQ(is_flat_in_doubles<2>({&p, &q, &r}), size > 1e-300) << size;
    }
}

} // namespace
} // namespace abacus::test
