// The same templates in 3D: the mesh equals CGAL's Delaunay tetrahedra, one by one and with their
// orientation, on general, cospherical, coplanar and clustered input, whatever the order of the
// points and the size of the cache.
#include "delaunay/insertion.hpp"
#include "support/oracle.hpp"
#include "support/point_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <set>

namespace abacus::test {
namespace {

using Points = std::vector<Point<3>>;

Points make(int n, const std::function<Point<3>(int)> &point) {
    Points points;
    for (int i = 0; i < n; ++i) points.push_back(point(i));
    return points;
}

// Caches of about three blocks, of some, and of all.
constexpr std::size_t cache_sizes[] = {60 << 10, 600 << 10, std::size_t(1) << 30};

class Tetrahedralization : public testing::TestWithParam<PointSet<3>> {};

TEST_P(Tetrahedralization, EqualsCgalForEveryOrderAndCacheSize) {
    Random random(7);
    Points points = GetParam().points(random);
    const auto expected = cgal_simplices<3>(points);
    const std::function<void()> orders[] = {
        [&] { std::shuffle(points.begin(), points.end(), random); },
        [&] { std::sort(points.begin(), points.end()); },
        [&] { std::reverse(points.begin(), points.end()); }};
    for (int i = 0; i < 3; ++i) {
        orders[i]();
        MeshOf<3> mesh(0, cache_sizes[i]);
        ASSERT_EQ(mesh.stage(number<3>(points)), ABACUS_OK) << mesh.error.message;
        ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.message << ' ' << mesh.error.detail;
        EXPECT_EQ(mesh.header.facts.census.simplices, expected.size());
        if (!expected.empty()) {
            EXPECT_EQ(mesh.header.facts.census.vertices + mesh.header.facts.census.duplicates,
                      points.size());
        }
        EXPECT_EQ(mesh.positions(), expected) << "cache of " << cache_sizes[i] << " bytes";
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
    }
}

INSTANTIATE_TEST_SUITE_P(Inputs, Tetrahedralization, testing::ValuesIn(point_sets<3>()),
                         [](const auto &info) { return info.param.name; });

TEST(Tetrahedralization, AddsToAMeshThatIsThere) {
    Random random(3);
    Points points = make(4000, [&](int) {
        return Point<3>{unit(random), unit(random), unit(random)};
    });
    // The second half reaches outside the domain of the first, and repeats points.
    for (std::size_t i = 2000; i < points.size(); ++i)
        if (i % 10 == 0)
            points[i] = points[i - 2000];
        else
            for (double &x : points[i]) x = x * 3 - 1;
    const auto all = number<3>(points);
    MeshOf<3> mesh(0, 100 << 10);
    for (std::size_t from = 0; from < all.size(); from += 1000) {
        ASSERT_EQ(mesh.stage({all.begin() + from, all.begin() + from + 1000}), ABACUS_OK);
        ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.detail;
    }
    EXPECT_EQ(mesh.positions(), cgal_simplices<3>(points));
    EXPECT_EQ(mesh.header.facts.census.duplicates, 200u);
    EXPECT_EQ(mesh.check(), std::vector<std::string>{});
}

TEST(Tetrahedralization, FewerDimensionsMakeAnEmptyMeshThatCanGrow) {
    const Points inputs[] = {
        {},
        {{1, 2, 3}},
        {{1, 2, 3}, {3, 4, 5}},
        {{1, 2, 3}, {3, 4, 5}, {0, 0, 7}},
        {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}},
        {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {1, 1, 1}, {-5, -5, -5}},
        {{0, 0, 1}, {4, 0, 1}, {0, 4, 1}, {4, 4, 1}, {2, 2, 1}, {4, 4, 1}},
        {{0, 0, 0}, {0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}, {0.1, 0.2, 0.3}, {0.3, 0.2, 0.1}}};
    for (const Points &points : inputs) {
        MeshOf<3> mesh;
        ASSERT_EQ(mesh.stage(number<3>(points)), ABACUS_OK);
        ASSERT_EQ(mesh.build(), ABACUS_OK);
        EXPECT_EQ(mesh.positions(), cgal_simplices<3>(points));
        EXPECT_EQ(mesh.header.facts.census.staged, points.size());
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        abacus_simplex simplex;
        if (mesh.header.facts.census.simplices == 0) {
            EXPECT_EQ(mesh.locate({1, 2, 3}, simplex), ABACUS_END);
        }
        Points all = points;
        const Points more = {{5, 0, 0}, {0, 7, 0}, {9, 9, 0}, {1, 1, 50}};
        for (const Point<3> &p : more) { // one at a time
            all.push_back(p);
            ASSERT_EQ(mesh.stage(number<3>({p})), ABACUS_OK);
            ASSERT_EQ(mesh.build(), ABACUS_OK);
            EXPECT_EQ(mesh.positions(), cgal_simplices<3>(all));
            EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        }
        EXPECT_GT(mesh.header.facts.census.simplices, 0u);
    }
}

TEST(ProbingInSpace, GivesTheSameMeshAsStoredLinks) {
    Random random(8);
    const Points points = make(3000, [&](int) {
        return Point<3>{unit(random), unit(random), unit(random)};
    });
    MeshOf<3> mesh;
    const Host host = mesh.host.host();
    Cache<3> cache(host, Domain<3>({0, 0, 0}, {1, 1, 1}), 0,
                   {.budget = std::size_t(400) << 10, .stored_links = false});
    Delaunay<3> delaunay(host, cache, 0, 0);
    Insertion<3> insertion(delaunay);
    std::array<VertexIndex, 4> first;
    for (int i = 0; i < 4; ++i) first[i] = cache.create_vertex(points[i], i, nullptr);
    insertion.start(first);
    for (std::size_t i = 4; i < points.size(); ++i)
        EXPECT_TRUE(insertion.insert(points[i], static_cast<std::int64_t>(i), nullptr));
    cache.flush();
    EXPECT_GT(cache.counters.quick_probes, 0u);
    EXPECT_GT(cache.counters.ray_probes, 0u);
    EXPECT_GT(cache.counters.concentric_probes, 0u);
    EXPECT_EQ(cache.counters.link_probes, 0u);

    mesh.header.facts.form.has_domain = 1;
    std::fill_n(mesh.header.facts.form.upper, 3, 1.0);
    mesh.header.facts.census.vertices = points.size();
    mesh.header.facts.census.simplices = static_cast<std::uint64_t>(delaunay.simplices());
    mesh.header.facts.census.ghosts = static_cast<std::uint64_t>(delaunay.ghosts());
    EXPECT_EQ(mesh.positions(), cgal_simplices<3>(points));
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
}

} // namespace
} // namespace abacus::test
