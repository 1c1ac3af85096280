// Whether simplices overlap, against rational arithmetic: one is cut at the facets of the other.
#include "geometry/greatest_difference.hpp"
#include "geometry/overlap.hpp"

#include <CGAL/Exact_rational.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace abacus::test {
namespace {

using Rational = CGAL::Exact_rational;
using Random = std::mt19937_64;
template <int D> using Place = std::array<Rational, D>;
template <int D> using Part = std::array<Place<D>, D + 1>;
template <int D> using Simplex = std::array<Point<D>, D + 1>;

template <int D> Rational measure(const Part<D> &part) {
    std::array<Place<D>, D> way;
    for (int i = 0; i < D; ++i)
        for (int axis = 0; axis < D; ++axis) way[i][axis] = part[i + 1][axis] - part[0][axis];
    if constexpr (D == 2) {
        return way[0][0] * way[1][1] - way[0][1] * way[1][0];
    } else {
        Rational sum = 0;
        for (int i = 0; i < 3; ++i) {
            const auto &a = way[(i + 1) % 3], &b = way[(i + 2) % 3];
            sum += way[i][0] * (a[1] * b[2] - a[2] * b[1]);
        }
        return sum;
    }
}

template <int D> Part<D> rational(const Simplex<D> &simplex) {
    Part<D> part;
    for (int i = 0; i <= D; ++i)
        for (int axis = 0; axis < D; ++axis) part[i][axis] = Rational(simplex[i][axis]);
    return part;
}

/// Parts that make up what is beyond no facet of a simplex: bisected at edges that cross one.
template <int D>
bool has_common_part(const Part<D> &part, const Part<D> &other, int facet, const Rational &whole) {
    if (facet > D) return true;
    std::array<Rational, D + 1> side;
    for (int i = 0; i <= D; ++i) {
        Part<D> replaced = other;
        replaced[facet] = part[i];
        side[i] = measure<D>(replaced) * whole;
    }
    int inside = -1, outside = -1;
    for (int i = 0; i <= D; ++i) {
        if (side[i] > 0) inside = i;
        if (side[i] < 0) outside = i;
    }
    if (inside < 0) return false;
    if (outside < 0) return has_common_part<D>(part, other, facet + 1, whole);
    Place<D> between;
    const Rational share = side[inside] / (side[inside] - side[outside]);
    for (int axis = 0; axis < D; ++axis)
        between[axis] = part[inside][axis] + share * (part[outside][axis] - part[inside][axis]);
    for (const int replaced : {outside, inside}) {
        Part<D> half = part;
        half[replaced] = between;
        if (has_common_part<D>(half, other, facet, whole)) return true;
    }
    return false;
}

template <int D> Corners<D> corners_of(const Simplex<D> &simplex) {
    Corners<D> corners;
    for (int i = 0; i <= D; ++i) corners[i] = &simplex[i];
    return corners;
}

/// Of positive orientation.
template <int D, class Coordinate> Simplex<D> random_simplex(Coordinate coordinate) {
    for (;;) {
        Simplex<D> simplex;
        for (Point<D> &p : simplex)
            for (double &x : p) x = coordinate();
        const int sign = orientation<D>(corners_of<D>(simplex));
        if (sign == 0) continue;
        if (sign < 0) std::swap(simplex[0], simplex[1]);
        return simplex;
    }
}

template <int D, class Coordinate> void expect_as_rational(Coordinate coordinate, int rounds) {
    int overlapping = 0;
    for (int round = 0; round < rounds; ++round) {
        const Simplex<D> a = random_simplex<D>(coordinate), b = random_simplex<D>(coordinate);
        const Part<D> first = rational<D>(a), second = rational<D>(b);
        const bool expected = has_common_part<D>(first, second, 0, measure<D>(second));
        const Corners<D> of_a = corners_of<D>(a), of_b = corners_of<D>(b);
        EXPECT_EQ(overlap<D>(of_a, of_b), expected);
        EXPECT_EQ(overlap<D>(of_b, of_a), expected);
        overlapping += expected;
        // Cut exactly, they have a part in common in the same cases.
        Box<D> all;
        all.lower.fill(-1e9);
        all.upper.fill(1e9);
        GreatestDifference<D> within;
        within.add({a, {}}, {b, {}}, all, nullptr);
        EXPECT_EQ(within.is_any(), expected);
    }
    EXPECT_GT(overlapping, rounds / 20);
    EXPECT_LT(overlapping, rounds);
}

template <int D> void expect_as_rational() {
    Random random(D);
    for (const int most : {1, 2, 3, 8})
        expect_as_rational<D>([&] { return static_cast<double>(random() % (most + 1)); }, 400);
    // Tenths far from the origin: nearly coplanar, and not integers.
    expect_as_rational<D>([&] { return 1e6 + static_cast<double>(random() % 6) / 10; }, 300);
    expect_as_rational<D>([&] { return std::uniform_real_distribution<double>(-1, 1)(random); },
                          300);
}

TEST(Overlap, OfTrianglesIsExact) { expect_as_rational<2>(); }
TEST(Overlap, OfTetrahedraIsExact) { expect_as_rational<3>(); }

/// Each of two tetrahedra with an edge above the other's: only a plane along both keeps them apart.
TEST(Overlap, OfTetrahedraWithCrossingEdges) {
    for (const double gap : {-0x1p-52, 0.0, 0x1p-52}) {
        const Simplex<3> lower{{{-1, 0, 1}, {1, 0, 1}, {0, 1, 0}, {0, -1, 0}}},
            upper{{{0, -1, 1 + gap}, {0, 1, 1 + gap}, {-1, 0, 2}, {1, 0, 2}}};
        Corners<3> a = corners_of<3>(lower), b = corners_of<3>(upper);
        if (orientation<3>(a) < 0) std::swap(a[0], a[1]);
        if (orientation<3>(b) < 0) std::swap(b[0], b[1]);
        EXPECT_EQ(overlap<3>(a, b), gap < 0) << gap;
        EXPECT_EQ(overlap<3>(b, a), gap < 0) << gap;
    }
}

TEST(Overlap, SideOfAParallelPlane) {
    Random random(7);
    const auto coordinate = [&](int kind) {
        if (kind == 0) return static_cast<double>(random() % 4);
        if (kind == 1) return 1e6 + static_cast<double>(random() % 5) / 10;
        return std::ldexp(std::uniform_real_distribution<double>(-1, 1)(random),
                          static_cast<int>(random() % 900) - 600);
    };
    for (int round = 0; round < 6000; ++round) {
        Point<3> p[5];
        for (Point<3> &q : p)
            for (double &x : q) x = coordinate(round % 3);
        Part<3> part{};
        for (int axis = 0; axis < 3; ++axis) {
            part[1][axis] = Rational(p[1][axis]) - Rational(p[0][axis]);
            part[2][axis] = Rational(p[3][axis]) - Rational(p[2][axis]);
            part[3][axis] = Rational(p[4][axis]) - Rational(p[0][axis]);
        }
        const Rational expected = measure<3>(part);
        EXPECT_EQ(side_of_parallel(p[0], p[1], p[2], p[3], p[4]), (expected > 0) - (expected < 0));
    }
}

} // namespace
} // namespace abacus::test
