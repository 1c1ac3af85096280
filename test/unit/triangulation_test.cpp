// The mesh equals CGAL's Delaunay triangulation, triangle by triangle, on inputs
// that are hard in different ways, whatever the order of the points and the size of
// the cache.
#include "support/oracle.hpp"
#include "support/point_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace abacus::test {
namespace {

using Points = std::vector<Point<2>>;

Points make(int n, const std::function<Point<2>(int)> &point) {
    Points points;
    for (int i = 0; i < n; ++i) points.push_back(point(i));
    return points;
}

// Caches of about three blocks, of some, and of all.
constexpr std::size_t cache_sizes[] = {60 << 10, 600 << 10, std::size_t(1) << 30};

class Triangulation : public testing::TestWithParam<PointSet<2>> {};

TEST_P(Triangulation, EqualsCgalForEveryOrderAndCacheSize) {
    Random random(7);
    Points points = GetParam().points(random);
    const std::vector<Positions<2>> expected = cgal_simplices<2>(points);
    for (const std::size_t cache : cache_sizes) {
        std::shuffle(points.begin(), points.end(), random);
        Mesh mesh(0, cache);
        ASSERT_EQ(mesh.stage(number(points)), ABACUS_OK) << mesh.error.message;
        ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.message << ' ' << mesh.error.detail;
        EXPECT_EQ(mesh.header.facts.census.simplices, expected.size());
        EXPECT_EQ(mesh.header.facts.census.vertices + mesh.header.facts.census.duplicates,
                  points.size());
        EXPECT_EQ(mesh.positions(), expected) << "cache of " << cache << " bytes";
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
    }
}

INSTANTIATE_TEST_SUITE_P(Inputs, Triangulation, testing::ValuesIn(point_sets<2>()),
                         [](const auto &info) { return info.param.name; });

TEST(Triangulation, AddsToAMeshThatIsThere) {
    Random random(3);
    Points points = make(12000, [&](int) { return Point<2>{unit(random), unit(random)}; });
    // The second half reaches outside the domain of the first, and repeats points.
    for (std::size_t i = 6000; i < points.size(); ++i)
        if (i % 10 == 0)
            points[i] = points[i - 6000];
        else
            points[i] = {points[i][0] * 3 - 1, points[i][1] * 3 - 1};
    const std::vector<Input> all = number(points);
    Mesh mesh(0, 100 << 10);
    ASSERT_EQ(mesh.stage({all.begin(), all.begin() + 6000}), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    ASSERT_EQ(mesh.stage({all.begin() + 6000, all.end()}), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.detail;
    EXPECT_EQ(mesh.positions(), cgal_simplices<2>(points));
    EXPECT_EQ(mesh.header.facts.census.duplicates, 600u);
    EXPECT_EQ(mesh.check(), std::vector<std::string>{});
}

TEST(Triangulation, TheFourPointsThatGeosGetsWrong) {
    // libgeos issue 1286: GEOS gives {p1 p2 p3, p1 p3 p4}. The first three are nearly
    // collinear; p2 is a corner of the hull, by rational arithmetic.
    const Point<2> p1{-1.3890020986020145e-10, 4.860466764224401},
        p2{-1.3889120965221466e-10, -5.531838081766228},
        p3{-1.388852095135568e-10, -12.460041312426647}, p4{0.9999999999166641, -3.799787274101123};
    Mesh mesh;
    ASSERT_EQ(mesh.stage(number({p1, p2, p3, p4})), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    EXPECT_EQ(mesh.positions(), (std::vector<Positions<2>>{{p1, p2, p4}, {p2, p3, p4}}));
    EXPECT_EQ(mesh.positions(), cgal_simplices<2>({p1, p2, p3, p4}));
}

TEST(Triangulation, FewerDimensionsMakeAnEmptyMeshThatCanGrow) {
    const std::vector<Points> inputs = {
        {}, {{1, 2}}, {{1, 2}, {3, 4}}, {{1, 2}, {1, 2}, {1, 2}}, {{0, 0}, {1, 1}, {2, 2}, {1, 1}}};
    for (const Points &points : inputs) {
        Mesh mesh;
        ASSERT_EQ(mesh.stage(number(points)), ABACUS_OK);
        ASSERT_EQ(mesh.build(), ABACUS_OK);
        EXPECT_EQ(mesh.header.facts.census.simplices, 0u);
        EXPECT_EQ(mesh.header.facts.census.staged, points.size());
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        abacus_simplex simplex;
        EXPECT_EQ(mesh.locate({1, 2}, simplex), ABACUS_END);

        Points more = points;
        more.insert(more.end(), {{5, 0}, {0, 7}, {9, 9}});
        ASSERT_EQ(mesh.stage(number({{5, 0}, {0, 7}, {9, 9}})), ABACUS_OK);
        ASSERT_EQ(mesh.build(), ABACUS_OK);
        EXPECT_EQ(mesh.positions(), cgal_simplices<2>(more));
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
    }
}

} // namespace
} // namespace abacus::test
