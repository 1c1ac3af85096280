// Locating, walking and scanning tetrahedra, compared with brute force over all of them, which the
// tetrahedralization tests compare with CGAL, and with CGAL's own point location.
#include "support/containment.hpp"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>

namespace abacus::test {
namespace {

using Points = std::vector<Point<3>>;
using Random = std::mt19937_64;
using Mesh3 = MeshOf<3>;
using OpenMesh3 = OpenMeshOf<3>;
using Facet = std::array<std::int64_t, 3>;

constexpr std::size_t little = 60 << 10, ample = 64 << 20;

double unit(Random &random) { return std::uniform_real_distribution<double>(0, 1)(random); }

Points grid(int n) {
    Points points;
    for (int i = 0; i < n * n * n; ++i)
        points.push_back({i % n + 0.0, i / n % n + 0.0, i / (n * n) + 0.0});
    return points;
}

Points random_points(int n, unsigned seed) {
    Random random(seed);
    Points points(n);
    for (Point<3> &p : points) p = {unit(random), unit(random), unit(random)};
    return points;
}

void build(Mesh3 &mesh, std::vector<InputOf<3>> input, unsigned seed = 0) {
    if (seed != 0) std::shuffle(input.begin(), input.end(), Random(seed));
    ASSERT_EQ(mesh.stage(input), ABACUS_OK) << mesh.error.message;
    ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.message << mesh.error.detail;
}

/// The facet opposite corner i, with its ids in order.
Facet facet(const abacus_simplex &s, int i) {
    Facet ids{s.id[(i + 1) % 4], s.id[(i + 2) % 4], s.id[(i + 3) % 4]};
    std::sort(ids.begin(), ids.end());
    return ids;
}

TEST(LocateInSpace, GivesTheFirstOfTheTetrahedraAroundThePoint) {
    for (const Points &points : {grid(6), random_points(120, 1)}) {
        Points targets = points; // vertices
        Random random(2);
        for (int i = 0; i < 300; ++i) {
            const auto &a = points[random() % points.size()], &b = points[random() % points.size()];
            Point<3> middle, beside; // in a grid the middle also lies on edges and facets
            for (int k = 0; k < 3; ++k) {
                middle[k] = (a[k] + b[k]) / 2;
                beside[k] = a[k] + unit(random) - 0.5;
            }
            targets.insert(targets.end(), {middle, beside});
        }
        Mesh3 first(0, ample), second(0, little);
        build(first, number<3>(points));
        build(second, number<3>(points), 5);
        const auto all = first.simplices(false);
        OpenMesh3 large(first, ample), small(second, little);
        for (const Point<3> &p : targets) {
            const abacus_simplex *expected = nullptr;
            for (const abacus_simplex &s : all)
                if (contains<3>(s, p) && (expected == nullptr || rank<3>(s) < rank<3>(*expected)))
                    expected = &s;
            for (OpenMesh3 *mesh : {&large, &small}) {
                abacus_simplex found;
                ASSERT_EQ(mesh->locate(p, found), expected ? ABACUS_OK : ABACUS_END);
                if (expected) {
                    EXPECT_EQ(rank<3>(found), rank<3>(*expected));
                }
            }
        }
        EXPECT_EQ(first.host.violations, std::vector<std::string>{});
        EXPECT_EQ(second.host.violations, std::vector<std::string>{});
    }
}

TEST(LocateInSpace, EqualsCgals) {
    const Points points = random_points(4000, 3);
    Mesh3 mesh(0, ample);
    build(mesh, number<3>(points));
    CGAL::Delaunay_triangulation_3<CGAL::Exact_predicates_inexact_constructions_kernel> reference;
    std::map<decltype(reference)::Vertex_handle, std::int64_t> ids;
    for (std::size_t i = 0; i < points.size(); ++i)
        ids[reference.insert({points[i][0], points[i][1], points[i][2]})] = std::int64_t(i);
    OpenMesh3 small(mesh, little), large(mesh, ample);
    Random random(4);
    for (int round = 0; round < 2000; ++round) {
        const Point<3> p{unit(random) * 1.2 - 0.1, unit(random) * 1.2 - 0.1,
                         unit(random) * 1.2 - 0.1};
        const auto cell = reference.locate({p[0], p[1], p[2]});
        abacus_simplex found;
        ASSERT_EQ((round % 10 == 0 ? small : large).locate(p, found),
                  reference.is_infinite(cell) ? ABACUS_END : ABACUS_OK);
        if (reference.is_infinite(cell)) continue;
        std::array<std::int64_t, 4> expected;
        for (int i = 0; i < 4; ++i) expected[i] = ids[cell->vertex(i)];
        std::sort(expected.begin(), expected.end());
        std::sort(found.id, found.id + 4);
        EXPECT_TRUE(std::equal(expected.begin(), expected.end(), found.id));
    }
}

TEST(LocateInSpace, TreatsOddCoordinatesProperly) {
    Mesh3 mesh(0, ample);
    build(mesh, number<3>(grid(2)));
    OpenMesh3 open(mesh, ample);
    abacus_simplex plus, minus;
    ASSERT_EQ(open.locate({0.0, 0.0, 0.0}, plus), ABACUS_OK);
    ASSERT_EQ(open.locate({-0.0, 0.0, -0.0}, minus), ABACUS_OK);
    EXPECT_EQ(rank<3>(plus), rank<3>(minus));
    for (const double far : {1e300, -1e300, 1.7e308, -1.7e308, -5e-324})
        EXPECT_EQ(open.locate({0.5, far, 0.5}, plus), ABACUS_END);
    for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        OpenMesh3 other(mesh, ample);
        EXPECT_EQ(other.locate({0.5, 0.5, bad}, plus), ABACUS_ERROR);
        EXPECT_EQ(other.error.kind, ABACUS_ERROR_ARGUMENT);
    }
}

TEST(WalkInSpace, CrossesEveryFacetOfEveryTetrahedron) {
    for (const std::size_t cache : {little, ample}) {
        Mesh3 mesh(0, cache);
        build(mesh, number<3>(random_points(800, 6)));
        const auto all = mesh.simplices(false);
        std::map<Facet, std::vector<const abacus_simplex *>> sides;
        for (const auto &s : all)
            for (int i = 0; i < 4; ++i) sides[facet(s, i)].push_back(&s);
        OpenMesh3 open(mesh, cache);
        std::uint64_t hull = 0;
        for (const auto &s : all)
            for (int i = 0; i < 4; ++i) {
                const auto &both = sides.at(facet(s, i));
                ASSERT_LE(both.size(), 2u);
                abacus_simplex found;
                ASSERT_EQ(open.walk(s, i, found), both.size() == 1 ? ABACUS_END : ABACUS_OK);
                if (both.size() == 1)
                    ++hull;
                else
                    EXPECT_EQ(rank<3>(found), rank<3>(*both[both[0] == &s]));
            }
        EXPECT_EQ(hull, mesh.header.facts.census.ghosts);
        EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
    }
}

TEST(WalkInSpace, TakesTheIdsInAnyOrderAndRefusesOthers) {
    Mesh3 mesh(0, ample);
    build(mesh, number<3>(random_points(100, 7)));
    OpenMesh3 open(mesh, ample);
    for (abacus_simplex s : mesh.simplices(false)) {
        abacus_simplex expected, found;
        const abacus_status status = open.walk(s, 0, expected);
        std::swap(s.id[0], s.id[3]); // the facet opposite the same corner
        ASSERT_EQ(open.walk(s, 3, found), status);
        if (status == ABACUS_OK) {
            EXPECT_EQ(rank<3>(found), rank<3>(expected));
        }
        for (const int facet : {-1, 4, INT32_MIN, INT32_MAX}) {
            OpenMesh3 other(mesh, ample);
            EXPECT_EQ(other.walk(s, facet, found), ABACUS_ERROR);
            EXPECT_EQ(other.error.kind, ABACUS_ERROR_ARGUMENT);
        }
        s.id[2] = s.id[1];
        OpenMesh3 other(mesh, ample);
        EXPECT_EQ(other.walk(s, 0, found), ABACUS_ERROR);
    }
}

TEST(ScanInSpace, GivesPositiveTetrahedraAndAClosedHull) {
    for (const Points &points : {grid(7), random_points(1500, 12)}) {
        Mesh3 mesh(0, ample);
        build(mesh, number<3>(points));
        std::map<std::pair<std::int64_t, std::int64_t>, int> edges; // of the hull, directed
        std::uint64_t finite = 0, ghosts = 0;
        for (const auto &s : mesh.simplices(true)) {
            if (s.ghost) {
                ++ghosts;
                for (int i = 0; i < 3; ++i) ++edges[{s.id[i], s.id[(i + 1) % 3]}];
                continue;
            }
            ++finite;
            EXPECT_EQ(s.id[0], *std::min_element(s.id, s.id + 4));
            EXPECT_EQ(s.id[1], *std::min_element(s.id + 1, s.id + 4));
            EXPECT_EQ(side<3>(s, 0, nullptr), 1);
        }
        EXPECT_EQ(finite, mesh.header.facts.census.simplices);
        EXPECT_EQ(ghosts, mesh.header.facts.census.ghosts);
        EXPECT_EQ(2 * edges.size(), 6 * ghosts); // each once in both directions
        for (const auto &[edge, count] : edges) {
            EXPECT_EQ(count, 1);
            EXPECT_TRUE(edges.count({edge.second, edge.first}));
        }
    }
}

} // namespace
} // namespace abacus::test
