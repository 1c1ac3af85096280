// The predicates equal CGAL's exact ones, in sign and in the perturbation of
// degenerate cases, on input that makes floating-point filters fail.
#include "geometry/in_sphere.hpp"
#include "geometry/predicates.hpp"
#include "support/sanitized.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <random>
#include <utility>

namespace abacus {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Random = std::mt19937_64;

template <int D> auto cgal(const Point<D> &p) {
    if constexpr (D == 2)
        return Kernel::Point_2(p[0], p[1]);
    else
        return Kernel::Point_3(p[0], p[1], p[2]);
}

template <int D> int exact_orientation(const Corners<D> &c) {
    if constexpr (D == 2)
        return CGAL::orientation(cgal<D>(*c[0]), cgal<D>(*c[1]), cgal<D>(*c[2]));
    else
        return CGAL::orientation(cgal<D>(*c[0]), cgal<D>(*c[1]), cgal<D>(*c[2]), cgal<D>(*c[3]));
}

template <int D> int unfiltered_orientation(const Corners<D> &c) {
    if constexpr (D == 2)
        return exact::orientation(*c[0], *c[1], *c[2]);
    else
        return exact::orientation(*c[0], *c[1], *c[2], *c[3]);
}

template <int D> int exact_position(const Corners<D> &c, const Point<D> &p) {
    if constexpr (D == 2)
        return Kernel::Triangle_2(cgal<D>(*c[0]), cgal<D>(*c[1]), cgal<D>(*c[2]))
            .bounded_side(cgal<D>(p));
    else
        return Kernel::Tetrahedron_3(cgal<D>(*c[0]), cgal<D>(*c[1]), cgal<D>(*c[2]), cgal<D>(*c[3]))
            .bounded_side(cgal<D>(p));
}

/// CGAL's triangulations contain the perturbation; the deciding functions are protected.
class Perturbed2 : public CGAL::Delaunay_triangulation_2<Kernel> {
public:
    int in_sphere(const Corners<2> &c, const abacus::Point<2> &p) const {
        return side_of_oriented_circle(cgal<2>(*c[0]), cgal<2>(*c[1]), cgal<2>(*c[2]), cgal<2>(p),
                                       true);
    }
};
class Perturbed3 : public CGAL::Delaunay_triangulation_3<Kernel> {
public:
    int in_sphere(const Corners<3> &c, const abacus::Point<3> &p) const {
        return side_of_oriented_sphere(cgal<3>(*c[0]), cgal<3>(*c[1]), cgal<3>(*c[2]),
                                       cgal<3>(*c[3]), cgal<3>(p), true);
    }
};
template <int D> using Perturbed = std::conditional_t<D == 2, Perturbed2, Perturbed3>;

/// Coordinates that are hard in different ways.
struct Source {
    const char *name;
    std::function<double(Random &)> coordinate;
};

double unit(Random &r) { return std::uniform_real_distribution<double>(-1, 1)(r); }

/// An integer with this many bits, every second time next to the ends of their range.
double lattice(Random &r, int bits) {
    const std::uint64_t end = std::uint64_t{1} << bits;
    if (r() % 2) return double(r() % end);
    return r() % 2 ? double(r() % 3) : double(end - 1 - r() % 3);
}

/// Numbers with drawn exponents. Each draw is a statement of its own, so that the order is the same
/// with every compiler.
std::function<double(Random &)> powers(int (*exponent)(Random &)) {
    return [exponent](Random &r) {
        const double mantissa = unit(r);
        return std::ldexp(mantissa, exponent(r));
    };
}

const Source sources[] = {
    {"uniform", unit},
    {"tiny_grid", [](Random &r) { return double(r() % 4); }},
    {"grid", [](Random &r) { return double(r() % 1000) - 500; }},
    // At the bit widths up to which integers are large enough for the determinants, and beyond.
    {"grid_of_24_bits", [](Random &r) { return lattice(r, 24); }},
    {"grid_of_25_bits", [](Random &r) { return lattice(r, 25); }},
    {"grid_of_30_bits", [](Random &r) { return lattice(r, 30); }},
    {"grid_of_31_bits", [](Random &r) { return lattice(r, 31); }},
    {"grid_of_32_bits", [](Random &r) { return lattice(r, 32); }},
    {"grid_far_from_zero", [](Random &r) { return 1e6 + double(r() % 8) * 0.125; }},
    {"decimals", [](Random &r) { return double(r() % 10) * 0.1; }},
    {"nearly_a_grid",
     [](Random &r) {
         const double x = double(r() % 4) + 1;
         return r() % 2 ? x : std::nextafter(x, r() % 2 ? 0.0 : 9.0);
     }},
    {"near_one_point", [](Random &r) { return 1 + unit(r) * 1e-15; }},
    {"subnormal", [](Random &r) { return 5e-324 * double(r() % 6); }},
    {"small", [](Random &r) { return unit(r) * 1e-120; }},
    {"tiny_normal", [](Random &r) { return unit(r) * 1e-300; }},
    {"large", [](Random &r) { return unit(r) * 1e120; }},
    {"largest", [](Random &r) { return unit(r) * std::numeric_limits<double>::max(); }},
    {"largest_grid",
     [](Random &r) { return (double(r() % 3) - 1) * std::numeric_limits<double>::max(); }},
    {"all_exponents", powers([](Random &r) { return int(r() % 2040) - 1020; })},
    // Products of small numbers underflow, and are multiplied by large ones.
    {"far_apart_exponents",
     powers([](Random &r) { return r() % 3 == 0 ? 1000 : -int(r() % 560) - 20; })},
    // Differences that are exact, but have no common unit for the smallest and the largest.
    {"grids_far_apart",
     [](Random &r) {
         const double step = double(r() % 4);
         return std::ldexp(step, r() % 3 == 0 ? -int(r() % 1074) : 700);
     }},
    // Squares and products of pairs reach the least double, and are multiplied by large numbers.
    {"products_underflow",
     powers([](Random &r) { return r() % 8 == 0 ? 400 : -int(r() % 60) - 510; })},
    // The compared values are a few times the least double.
    {"least_squares", powers([](Random &r) { return int(r() % 8) - 540; })},
    {"least_cubes", powers([](Random &r) { return int(r() % 8) - 360; })},
    {"least_fourth_powers", powers([](Random &r) { return int(r() % 8) - 272; })},
    // Where the filters begin to answer, and where squares, cubes and fifth powers overflow.
    {"ends_of_the_filters",
     [](Random &r) {
         constexpr int ends[] = {-482, -277, -208, -83, 102, 204, 255, 340, 511, 1023};
         const double mantissa = unit(r);
         const int end = ends[r() / 7 % std::size(ends)];
         return r() % 8 ? std::ldexp(mantissa, end - int(r() % 4)) : 0;
     }},
    {"mixed",
     [](Random &r) {
         if (r() % 3 != 0) return double(r() % 3);
         return powers([](Random &r) { return int(r() % 400) - 200; })(r);
     }},
};

template <int D> Point<D> point(const Source &source, Random &random) {
    Point<D> p;
    for (double &x : p) x = source.coordinate(random) + 0.0;
    return p;
}

// Inputs that take long under a sanitizer are smaller there.
const int scale = test::sanitized ? 10 : 1;

class Predicates : public testing::TestWithParam<Source> {
protected:
    template <int D> void compare(int rounds) {
        Random random(42);
        const Perturbed<D> triangulation;
        int degenerate = 0;
        for (int round = 0; round < rounds; ++round) {
            std::array<Point<D>, D + 1> points;
            Corners<D> corners;
            for (int i = 0; i <= D; ++i) {
                points[i] = point<D>(GetParam(), random);
                corners[i] = &points[i];
            }
            Point<D> p = point<D>(GetParam(), random);
            if (round % 16 == 0) p = points[random() % (D + 1)];
            const int sign = orientation<D>(corners);
            ASSERT_EQ(sign, exact_orientation<D>(corners));
            // Also the code after the filter, where the filter decides.
            ASSERT_EQ(unfiltered_orientation<D>(corners), sign);
            degenerate += sign == 0;
            if (sign < 0) std::swap(corners[0], corners[1]);
            if (sign == 0) continue;
            ASSERT_EQ(orientation<D>(corners), 1);
            ASSERT_EQ(in_simplex<D>(corners, p), exact_position<D>(corners, p));
            const int side = in_sphere(corners, p);
            const bool is_corner = std::find(points.begin(), points.end(), p) != points.end();
            ASSERT_EQ(side == 0, is_corner);
            if (is_corner) continue;
            ASSERT_EQ(side, triangulation.in_sphere(corners, p));
            ASSERT_EQ(exact::in_sphere<D>(corners, p), side);
            parts_are_right_where_they_are_sure(corners, p, side);
            // The same for every even permutation of the corners.
            std::rotate(corners.begin(), corners.begin() + 1, corners.begin() + 3);
            ASSERT_EQ(in_sphere(corners, p), side);
        }
        RecordProperty("degenerate", degenerate);
    }

    /// The triangle as seen across each of its edges.
    void parts_are_right_where_they_are_sure(const Corners<2> &corners, const Point<2> &p,
                                             int side) {
        for (int i = 0; i < 3; ++i) {
            const SeenPoint<2> b = seen(*corners[i], p), a = seen(*corners[(i + 1) % 3], p),
                               c = seen(*corners[(i + 2) % 3], p);
            const InCircle test = in_circle(a, b, cross(a, b), c);
            ASSERT_TRUE(!test.is_sure || test.is_inside == (side > 0));
            // The input of the next tests: NaN after an overflow.
            const auto equal = [](double x, double y) { return x == y || (x != x && y != y); };
            ASSERT_TRUE(equal(test.cross_ac, cross(a, c)));
            ASSERT_TRUE(equal(test.cross_cb, cross(c, b)));
        }
    }

    /// The tetrahedron as seen across each of its facets, in each order of these.
    void parts_are_right_where_they_are_sure(const Corners<3> &corners, const Point<3> &p,
                                             int side) {
        std::array<int, 4> order{0, 1, 2, 3};
        do {
            const SeenPoint<3> s = seen(*corners[order[0]], p), t = seen(*corners[order[1]], p),
                               u = seen(*corners[order[2]], p), e = seen(*corners[order[3]], p);
            if (orientation(*corners[order[0]], *corners[order[1]], *corners[order[2]],
                            *corners[order[3]]) > 0)
                continue; // the apex is not behind the facet
            const Cross su = cross(s, u), tu = cross(t, u);
            for (const InSphere &test :
                 {in_sphere(lifted_plane(s, t, u, cross(s, t), su, tu, 1), e),
                  in_sphere(lifted_plane(s, t, u, cross(t, s), su, tu, -1), e)})
                ASSERT_TRUE(!test.is_sure || test.is_inside == (side > 0));
        } while (std::next_permutation(order.begin(), order.end()));
    }

    template <int D> void compare_independence() {
        Random random(43);
        for (int round = 0; round < 2000 / scale; ++round) {
            std::array<Point<D>, D + 1> points;
            Corners<D> corners;
            int n = 0;
            for (int i = 0; i < 12 && n <= D; ++i) {
                const Point<D> p = point<D>(GetParam(), random);
                bool independent = true;
                if (n == 1) independent = p != points[0];
                if (n == 2)
                    independent =
                        !CGAL::collinear(cgal<D>(points[0]), cgal<D>(points[1]), cgal<D>(p));
                if constexpr (D == 3)
                    if (n == 3)
                        independent = !CGAL::coplanar(cgal<D>(points[0]), cgal<D>(points[1]),
                                                      cgal<D>(points[2]), cgal<D>(p));
                ASSERT_EQ(is_independent(corners, n, p), independent);
                if (!independent) continue;
                points[n] = p;
                corners[n] = &points[n];
                ++n;
            }
        }
    }
};

TEST_P(Predicates, EqualCgalsInThePlane) { compare<2>(20000 / scale); }
TEST_P(Predicates, EqualCgalsInSpace) { compare<3>(10000 / scale); }
TEST_P(Predicates, KnowIndependentPoints) {
    compare_independence<2>();
    compare_independence<3>();
}

INSTANTIATE_TEST_SUITE_P(Inputs, Predicates, testing::ValuesIn(sources),
                         [](const auto &info) { return info.param.name; });

TEST(Predicates, HaveTheSignsOfTheirConvention) {
    // Counterclockwise; the right hand's fingers along three corners, its thumb up.
    EXPECT_EQ(orientation({0, 0}, {1, 0}, {0, 1}), 1);
    EXPECT_EQ(orientation({0, 0}, {0, 1}, {1, 0}), -1);
    EXPECT_EQ(orientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);
    EXPECT_EQ(orientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}), -1);
    const Point<2> a{0, 0}, b{1, 0}, c{0, 1};
    EXPECT_EQ(in_sphere({&a, &b, &c}, {0.5, 0.5 - 1e-9}), 1);
    EXPECT_EQ(in_sphere({&a, &b, &c}, {2, 2}), -1);
    const Point<3> e{0, 0, 0}, f{1, 0, 0}, g{0, 1, 0}, h{0, 0, 1};
    EXPECT_EQ(in_sphere({&e, &f, &g, &h}, {0.25, 0.25, 0.25}), 1);
    EXPECT_EQ(in_sphere({&e, &f, &g, &h}, {2, 2, 2}), -1);
}

TEST(Predicates, InCircleIsMostlySureAndNeverOfThePointAtInfinity) {
    Random random(7);
    int sure = 0;
    for (int round = 0; round < 1000; ++round) {
        const auto next = [&] { return Point<2>{unit(random), unit(random)}; };
        const Point<2> p = next();
        const SeenPoint<2> a = seen(next(), p), b = seen(next(), p), c = seen(next(), p);
        sure += in_circle(a, b, cross(a, b), c).is_sure;
        const double nan = std::numeric_limits<double>::quiet_NaN();
        const SeenPoint<2> infinity = seen({nan, nan}, p);
        EXPECT_FALSE(in_circle(a, b, cross(a, b), infinity).is_sure);
        EXPECT_FALSE(in_circle(a, infinity, cross(a, infinity), c).is_sure);
        EXPECT_FALSE(in_circle(infinity, b, cross(infinity, b), c).is_sure);
    }
    EXPECT_GT(sure, 990);
}

TEST(Predicates, InSphereIsMostlySureAndNeverOfThePointAtInfinity) {
    Random random(7);
    int sure = 0;
    for (int round = 0; round < 1000; ++round) {
        const auto next = [&] { return Point<3>{unit(random), unit(random), unit(random)}; };
        const double nan = std::numeric_limits<double>::quiet_NaN();
        const Point<3> p = next();
        std::array<SeenPoint<3>, 4> point;
        for (SeenPoint<3> &corner : point) corner = seen(next(), p);
        const auto is_sure = [&] {
            const auto &[s, t, u, e] = point;
            return in_sphere(lifted_plane(s, t, u, cross(s, t), cross(s, u), cross(t, u), 1), e)
                .is_sure;
        };
        sure += is_sure();
        for (SeenPoint<3> &corner : point) {
            const SeenPoint<3> finite = std::exchange(corner, seen({nan, nan, nan}, p));
            EXPECT_FALSE(is_sure());
            corner = finite;
        }
    }
    EXPECT_GT(sure, 990);
}

// Integers would be large enough for the determinant if the least coordinate were 0.
TEST(Predicates, SeeTheLeastCoordinateBesideTheLargest) {
    for (const double tiny : {5e-324, 1e-300, 1e-200, 1e-170}) {
        const double large = 0x1p600;
        EXPECT_EQ(orientation({large, tiny}, {tiny, 0}, {0, 0}), -1);
        EXPECT_EQ(orientation({large, 0, 0}, {0, tiny, 0}, {0, 0, tiny}, {0, 0, 0}), -1);
        EXPECT_EQ(orientation({0, 0, 0}, {large, 0, 0}, {0, tiny, 0}, {0, 0, tiny}), 1);
        // Near the fourth corner of a square, and in the plane of three corners of a cube.
        const Point<2> a{0, 0}, b{large, 0}, c{large, large};
        EXPECT_EQ(in_sphere({&a, &b, &c}, {tiny, large}), 1);
        EXPECT_EQ(in_sphere({&a, &b, &c}, {-tiny, large}), -1);
        const Point<3> e{0, 0, 0}, f{large, 0, 0}, g{0, large, 0}, h{0, 0, large};
        EXPECT_EQ(in_sphere({&e, &f, &g, &h}, {large, large, tiny}), 1);
        EXPECT_EQ(in_sphere({&e, &f, &g, &h}, {large, large, -tiny}), -1);
    }
}

TEST(Predicates, PerturbationDecidesConsistently) {
    // Exactly one of the two ways to cut a square is Delaunay, whatever the order.
    std::array<Point<2>, 4> square{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (int i = 0; i < 4; ++i) {
        const auto &a = square[i], &b = square[(i + 1) % 4], &c = square[(i + 2) % 4],
                   &d = square[(i + 3) % 4];
        EXPECT_EQ(in_sphere({&a, &b, &c}, d), in_sphere({&c, &d, &a}, b));
        EXPECT_EQ(in_sphere({&a, &b, &c}, d), -in_sphere({&b, &c, &d}, a));
    }
}

TEST(Predicates, HullFacetHoldsWhatLiesStrictlyBetweenItsEnds) {
    const auto place = [](Point<2> a, Point<2> b, Point<2> p) {
        return in_hull_facet({&a, &b, nullptr}, p);
    };
    Random random(1);
    for (int round = 0; round < 1000; ++round) {
        // On a line, with exact points.
        const double dx = double(random() % 7) - 3, dy = double(random() % 7) - 3;
        if (dx == 0 && dy == 0) continue;
        const auto at = [&](int t) { return Point<2>{5 + t * dx, -3 + t * dy}; };
        const int a = int(random() % 9), b = a + 2 + int(random() % 5);
        for (int t = a - 3; t < b + 3; ++t) {
            const int expected = t == a || t == b ? 0 : t > a && t < b ? 1 : -1;
            EXPECT_EQ(place(at(a), at(b), at(t)), expected);
            EXPECT_EQ(place(at(b), at(a), at(t)), expected);
        }
    }
}

} // namespace
} // namespace abacus
