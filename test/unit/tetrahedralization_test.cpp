// The same templates in 3D: the mesh equals CGAL's Delaunay tetrahedra, one by one and
// with their orientation, on general, cospherical, coplanar and clustered input, whatever
// the order of the points and the size of the cache.
#include "delaunay/insertion.hpp"
#include "support/oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <set>

namespace abacus::test {
namespace {

using Points = std::vector<Point<3>>;
using Random = std::mt19937_64;

double unit(Random &random) { return std::uniform_real_distribution<double>(0, 1)(random); }

Points make(int n, const std::function<Point<3>(int)> &point) {
    Points points;
    for (int i = 0; i < n; ++i) points.push_back(point(i));
    return points;
}

Points integer_points_of_a_sphere(int radius) {
    Points points;
    for (int x = -radius; x <= radius; ++x)
        for (int y = -radius; y <= radius; ++y)
            for (int z = -radius; z <= radius; ++z)
                if (x * x + y * y + z * z == radius * radius)
                    points.push_back({x + 0.0, y + 0.0, z + 0.0});
    return points;
}

/// Corners of the octants of an octree that is refined towards a bent surface.
Points octree_corners() {
    std::set<Point<3>> corners;
    const std::function<void(Point<3>, double, int)> visit = [&](Point<3> at, double edge,
                                                                 int level) {
        const double height = 10 + 5 * std::sin(at[0] / 7) * std::cos(at[1] / 9);
        if (level < 5 && std::fabs(at[2] + edge / 2 - height) < edge) {
            for (int i = 0; i < 8; ++i)
                visit({at[0] + (i & 1) * edge / 2, at[1] + (i >> 1 & 1) * edge / 2,
                       at[2] + (i >> 2) * edge / 2},
                      edge / 2, level + 1);
            return;
        }
        for (int i = 0; i < 8; ++i)
            corners.insert(
                {at[0] + (i & 1) * edge, at[1] + (i >> 1 & 1) * edge, at[2] + (i >> 2) * edge});
    };
    visit({0, 0, 0}, 32, 0);
    return {corners.begin(), corners.end()};
}

struct DataSet {
    const char *name;
    std::function<Points(Random &)> points;
};

const DataSet data_sets[] = {
    {"uniform",
     [](Random &r) {
         return make(6000, [&](int) { return Point<3>{unit(r), unit(r), unit(r)}; });
     }},
    {"grid",
     [](Random &) {
         return make(12 * 12 * 12, [](int i) {
             return Point<3>{i % 12 + 0.0, i / 12 % 12 + 0.0, i / 144 + 0.0};
         });
     }},
    {"negative_grid_with_duplicates",
     [](Random &r) {
         const auto any = [&] { return std::floor(unit(r) * 14) - 7; };
         return make(4000, [&](int) { return Point<3>{any(), any(), any()}; });
     }},
    {"octree_corners", [](Random &) { return octree_corners(); }},
    {"integer_points_of_a_sphere", [](Random &) { return integer_points_of_a_sphere(45); }},
    {"integer_points_of_a_sphere_and_its_centre",
     [](Random &) {
         Points points = integer_points_of_a_sphere(35);
         points.push_back({0, 0, 0});
         return points;
     }},
    {"sphere", // nearly cospherical
     [](Random &r) {
         return make(1500, [&](int) {
             const double z = 2 * unit(r) - 1, angle = 6.283185307179586 * unit(r);
             const double radius = std::sqrt(1 - z * z);
             return Point<3>{radius * std::cos(angle), radius * std::sin(angle), z};
         });
     }},
    {"cone", // an apex with every facet of the hull
     [](Random &r) {
         Points points = make(800, [&](int) {
             const double angle = 6.283185307179586 * unit(r);
             return Point<3>{std::cos(angle), std::sin(angle), 0};
         });
         points.push_back({0, 0, 1});
         return points;
     }},
    {"skew_lines",
     [](Random &r) {
         return make(200, [&](int i) {
             const double t = unit(r);
             return i % 2 == 0 ? Point<3>{t, 0, 0} : Point<3>{0.3, t, 1};
         });
     }},
    {"lines_and_planes",
     [](Random &r) {
         return make(1500, [&](int i) {
             const double s = std::floor(unit(r) * 40), t = std::floor(unit(r) * 40);
             return i % 3 == 0   ? Point<3>{s, t, 0}
                    : i % 3 == 1 ? Point<3>{s, s, t}
                                 : Point<3>{7, 5, t};
         });
     }},
    {"clusters_below_the_code",
     [](Random &r) {
         return make(2000, [&](int i) {
             return Point<3>{i % 5 * 0.2 + unit(r) * 1e-12, i % 3 * 0.3 + unit(r) * 1e-12,
                             i % 7 * 0.1 + unit(r) * 1e-12};
         });
     }},
    {"cluster_at_zero",
     [](Random &r) {
         const auto any = [&] { return (unit(r) - 0.5) * 1e-30; };
         Points points = make(1500, [&](int) { return Point<3>{any(), any(), any()}; });
         for (int i = 0; i < 8; ++i)
             points.push_back({(i & 1) * 2 - 1.0, (i >> 1 & 1) * 2 - 1.0, (i >> 2) * 2 - 1.0});
         return points;
     }},
    {"exponents",
     [](Random &r) {
         const auto any = [&] { return std::ldexp(unit(r) - 0.5, int(r() % 1990) - 995); };
         return make(300, [&](int) { return Point<3>{any(), any(), any()}; });
     }},
    {"largest_doubles",
     [](Random &r) {
         const auto any = [&] { return (2 * unit(r) - 1) * 1.7e308; };
         return make(300, [&](int) { return Point<3>{any(), any(), any()}; });
     }},
    {"denormals",
     [](Random &r) {
         const auto any = [&] { return 5e-324 * std::floor(unit(r) * 20); };
         return make(500, [&](int) { return Point<3>{any(), any(), any()}; });
     }},
    {"coplanar",
     [](Random &r) { return make(200, [&](int) {
                         return Point<3>{unit(r), unit(r), 0};
                     }); }},
};

// Caches of three blocks, of some, and of all.
constexpr std::size_t cache_sizes[] = {60 << 10, 600 << 10, std::size_t(1) << 30};

class Tetrahedralization : public testing::TestWithParam<DataSet> {};

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
        EXPECT_EQ(mesh.header.simplices, expected.size());
        if (!expected.empty()) {
            EXPECT_EQ(mesh.header.vertices + mesh.header.duplicates, points.size());
        }
        EXPECT_EQ(mesh.positions(), expected) << "cache of " << cache_sizes[i] << " bytes";
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
    }
}

INSTANTIATE_TEST_SUITE_P(Inputs, Tetrahedralization, testing::ValuesIn(data_sets),
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
    EXPECT_EQ(mesh.header.duplicates, 200u);
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
        EXPECT_EQ(mesh.header.staged, points.size());
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        abacus_simplex simplex;
        if (mesh.header.simplices == 0) {
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
        EXPECT_GT(mesh.header.simplices, 0u);
    }
}

TEST(ProbingInSpace, GivesTheSameMeshAsStoredLinks) {
    Random random(8);
    const Points points =
        make(3000, [&](int) { return Point<3>{unit(random), unit(random), unit(random)}; });
    MeshOf<3> mesh;
    const Host host = mesh.host.host();
    Cache<3> cache(host, Domain<3>({0, 0, 0}, {1, 1, 1}), 0,
                   {.budget = std::size_t(400) << 10, .stored_links = false});
    Insertion<3> insertion(host, cache, 0, 0);
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

    mesh.header.has_domain = 1;
    std::fill_n(mesh.header.upper, 3, 1.0);
    mesh.header.vertices = points.size();
    mesh.header.simplices = static_cast<std::uint64_t>(insertion.simplices());
    mesh.header.ghosts = static_cast<std::uint64_t>(insertion.ghosts());
    EXPECT_EQ(mesh.positions(), cgal_simplices<3>(points));
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
}

} // namespace
} // namespace abacus::test
