// Where points are, and the box that determines a domain.
#include "keys/domain_of.hpp"
#include "points/spread.hpp"
#include "support/memory_host.hpp"
#include "support/point_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace abacus::test {
namespace {

template <class Dimension> class WherePointsAre : public testing::Test {
protected:
    static constexpr int D = Dimension::value;
    using Points = std::vector<Point<D>>;

    Points cube(std::size_t n, double corner, double edge) {
        Points points(n);
        for (Point<D> &p : points)
            for (double &x : p) x = corner + edge * unit(random);
        return points;
    }
    static Point<D> all(double x) {
        Point<D> p;
        p.fill(x);
        return p;
    }
    Spread<D> spread(const Points &points) {
        Spread<D> result(host);
        for (const Point<D> &p : points) result.add(p);
        return result;
    }
    Box<D> choose(const Points &points) { return spread(points).choose(); }
    static double extent(const Box<D> &box) {
        double extent = 0;
        for (int i = 0; i < D; ++i) extent = std::max(extent, box.upper[i] - box.lower[i]);
        return extent;
    }
    static std::size_t inside(const Box<D> &box, const Points &points) {
        return static_cast<std::size_t>(std::count_if(
            points.begin(), points.end(), [&](const Point<D> &p) { return box.contains(p); }));
    }

    MemoryHost memory;
    const Host host = memory.host();
    Random random{11};
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(WherePointsAre, Dimensions);

TYPED_TEST(WherePointsAre, AreInTheirBoxAsARule) {
    constexpr int D = TypeParam::value;
    for (const PointSet<D> &set : point_sets<D>()) {
        auto points = set.points(this->random);
        std::sort(points.begin(), points.end());
        points.erase(std::unique(points.begin(), points.end()), points.end());
        Spread<D> spread = this->spread(points);
        const Box<D> box = spread.choose();
        // If one scale cannot show them all, some may be left out, but never most.
        EXPECT_GE(2 * this->inside(box, points), points.size()) << set.name;
    }
    for (const std::size_t n : {0, 1, 2, 3, 10, 1000, 50000}) {
        const auto points = this->cube(n, 5e5, 1000);
        EXPECT_EQ(this->choose(points), this->spread(points).box()) << n;
    }
}

// One point or many, on any side and axis, at one or several distances.
TYPED_TEST(WherePointsAre, OutliersAreLeftOut) {
    constexpr int D = TypeParam::value;
    for (const std::size_t n : {50, 3000, 60000})
        for (const std::size_t outliers : {std::size_t(1), n / 50})
            for (const double far : {-3.4028234663852886e38, 1e20, -1e300, 1.7e308})
                for (int axis = -1; axis < D; ++axis) {
                    auto points = this->cube(n, 5e5, 1000);
                    for (std::size_t i = 0; i < outliers; ++i) {
                        Point<D> p = points[i];
                        const double x = std::ldexp(far, -int(i % 7));
                        if (axis < 0)
                            p.fill(x);
                        else
                            p[axis] = x;
                        points.push_back(p);
                    }
                    const Box<D> box = this->choose(points);
                    EXPECT_LE(this->extent(box), 2500);
                    EXPECT_GE(this->inside(box, points), n - n / 16) << n << ' ' << far;
                }
}

TYPED_TEST(WherePointsAre, CopiesOfAPointCountOnce) {
    auto points = this->cube(2000, 0, 1);
    points.insert(points.end(), 20000, this->all(1e30));
    EXPECT_LE(this->extent(this->choose(points)), 2.5);
}

TYPED_TEST(WherePointsAre, WhateverTheirOrder) {
    constexpr int D = TypeParam::value;
    auto points = this->cube(20000, 0, 1);
    for (int i = 0; i < 40; ++i) points.push_back(this->all(1e25 * (i + 1)));
    for (int i = 0; i < 5000; ++i) points.push_back(points[i]);
    const Box<D> box = this->choose(points);
    for (int round = 0; round < 5; ++round) {
        std::shuffle(points.begin(), points.end(), this->random);
        EXPECT_EQ(this->choose(points), box);
        const auto middle = points.begin() + 3000 * round;
        Spread<D> first = this->spread({points.begin(), middle});
        first.add(this->spread({middle, points.end()}));
        EXPECT_EQ(first.choose(), box);
    }
}

TYPED_TEST(WherePointsAre, ClustersThatOneScaleShowsStay) {
    constexpr int D = TypeParam::value;
    for (const double share : {0.5, 0.1}) {
        const auto many = static_cast<std::size_t>(20000 * (1 - share));
        auto points = this->cube(many, 0, 1);
        for (const Point<D> &p : this->cube(20000 - many, 3000, 1)) points.push_back(p);
        EXPECT_EQ(this->choose(points), this->spread(points).box());
    }
}

TYPED_TEST(WherePointsAre, OfClustersTooFarApartOneIsServedIfItIsMost) {
    constexpr int D = TypeParam::value;
    auto points = this->cube(8000, 0, 256);
    for (const Point<D> &p : this->cube(2000, 1e15, 256)) points.push_back(p);
    EXPECT_LE(this->extent(this->choose(points)), 640);
    // With many of them, none would gain what the others lose.
    points.clear();
    for (int cluster = 0; cluster < 5; ++cluster)
        for (const Point<D> &p : this->cube(2000, cluster * 1e15, 256)) points.push_back(p);
    EXPECT_EQ(this->choose(points), this->spread(points).box());
}

TYPED_TEST(WherePointsAre, OfAnyMagnitude) {
    for (const double size : {5e-324, 1e-310, 1e-200, 1e200, 1e303}) {
        auto points = this->cube(3000, 0, 1);
        for (auto &p : points)
            for (double &x : p) x = size * std::floor(x * 16384);
        EXPECT_EQ(this->choose(points), this->spread(points).box()) << size;
        if (size > 1e200) continue;
        points.push_back(this->all(1e308));
        EXPECT_LE(this->extent(this->choose(points)), 2.5 * 16384 * size) << size;
    }
}

// The domain may have been given, or come from points that have gone.
TYPED_TEST(WherePointsAre, TellWhetherADomainFits) {
    constexpr int D = TypeParam::value;
    const auto points = this->cube(5000, 0, 1);
    Spread<D> spread = this->spread(points);
    const Box<D> unit(this->all(0), this->all(1)), vast(this->all(-1e30), this->all(1e30));
    const Box<D> wide(this->all(-10), this->all(10)), point(this->all(0), this->all(0));
    EXPECT_EQ(spread.choose(wide), wide);
    EXPECT_EQ(spread.choose(vast), spread.box());
    EXPECT_EQ(spread.choose(point), spread.box());
    EXPECT_TRUE(spread.is_better(unit, vast));
    EXPECT_FALSE(spread.is_better(unit, wide));
    EXPECT_FALSE(spread.is_better(vast, unit));
}

} // namespace
} // namespace abacus::test
