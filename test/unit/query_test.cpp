// Locating, walking and scanning, compared with brute force over all triangles, which the
// triangulation tests compare with CGAL, and with CGAL's own point location.
#include "support/containment.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <tuple>

namespace abacus::test {
namespace {

using Random = std::mt19937_64;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Ids = std::array<std::int64_t, 3>;

constexpr std::size_t little = 40 << 10, ample = 64 << 20;

double unit(Random &random) { return std::uniform_real_distribution<double>(0, 1)(random); }

std::vector<Point<2>> grid(int n) {
    std::vector<Point<2>> points;
    for (int x = 0; x < n; ++x)
        for (int y = 0; y < n; ++y) points.push_back({x + 0.0, y + 0.0});
    return points;
}

void build(Mesh &mesh, std::vector<Input> input, unsigned seed = 0) {
    if (seed != 0) std::shuffle(input.begin(), input.end(), Random(seed));
    ASSERT_EQ(mesh.stage(input), ABACUS_OK) << mesh.error.message;
    ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.message << mesh.error.detail;
}

Point<2> corner(const abacus_simplex &s, int i) { return {s.corner[i][0], s.corner[i][1]}; }

void expect_same(const abacus_simplex &a, const abacus_simplex &b) {
    EXPECT_EQ(rank<2>(a), rank<2>(b));
    EXPECT_EQ(a.ghost, b.ghost);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(corner(a, i), corner(b, i));
}

TEST(Locate, GivesTheFirstOfTheTrianglesAroundThePoint) {
    for (const auto &points : {grid(20), unit_square_points(400, 1)}) {
        std::vector<Point<2>> targets = points; // vertices
        Random random(2);
        for (int i = 0; i < 300; ++i) {
            const auto &a = points[random() % points.size()], &b = points[random() % points.size()];
            targets.push_back({(a[0] + b[0]) / 2, (a[1] + b[1]) / 2}); // in a grid: edges
            targets.push_back({a[0] + unit(random) - 0.5, a[1] + unit(random) - 0.5});
        }
        Mesh first(0, ample), second(0, little);
        build(first, number(points));
        build(second, number(points), 5);
        const auto all = first.simplices(false);
        OpenMesh large(first, ample), small(second, little);
        for (const Point<2> &p : targets) {
            const abacus_simplex *expected = nullptr;
            for (const abacus_simplex &s : all)
                if (contains<2>(s, p) && (expected == nullptr || rank<2>(s) < rank<2>(*expected)))
                    expected = &s;
            for (OpenMesh *mesh : {&large, &small}) {
                abacus_simplex found;
                ASSERT_EQ(mesh->locate(p, found), expected ? ABACUS_OK : ABACUS_END);
                if (expected) expect_same(found, *expected);
            }
        }
        EXPECT_EQ(first.host.violations, std::vector<std::string>{});
    }
}

TEST(Locate, EqualsCgals) {
    const auto points = unit_square_points(20000, 3);
    Mesh mesh(0, ample);
    build(mesh, number(points));
    CGAL::Delaunay_triangulation_2<Kernel> reference;
    std::map<CGAL::Delaunay_triangulation_2<Kernel>::Vertex_handle, std::int64_t> ids;
    for (std::size_t i = 0; i < points.size(); ++i)
        ids[reference.insert({points[i][0], points[i][1]})] = static_cast<std::int64_t>(i);
    OpenMesh small(mesh, little), large(mesh, ample);
    Random random(4);
    for (int round = 0; round < 3000; ++round) {
        const Point<2> p{unit(random) * 1.2 - 0.1, unit(random) * 1.2 - 0.1};
        const auto face = reference.locate({p[0], p[1]});
        abacus_simplex found, again;
        const abacus_status status = large.locate(p, found);
        if (round % 10 == 0) {
            ASSERT_EQ(small.locate(p, again), status);
            if (status == ABACUS_OK) expect_same(again, found);
        }
        ASSERT_EQ(status, reference.is_infinite(face) ? ABACUS_END : ABACUS_OK);
        if (status != ABACUS_OK) continue;
        Ids expected{ids[face->vertex(0)], ids[face->vertex(1)], ids[face->vertex(2)]};
        std::rotate(expected.begin(), std::min_element(expected.begin(), expected.end()),
                    expected.end());
        EXPECT_EQ(expected, (Ids{found.id[0], found.id[1], found.id[2]}));
    }
    const abacus_counters counters = large.counters();
    EXPECT_EQ(counters.walks, 3000u);
    EXPECT_EQ(counters.loads, mesh.host.pages.size()); // each page once
    EXPECT_EQ(counters.stores, 0u);
}

TEST(Locate, TreatsOddCoordinatesProperly) {
    Mesh mesh(0, ample);
    build(mesh, number({{0, 0}, {1, 0}, {0, 1}, {1, 1}}));
    OpenMesh open(mesh, ample);
    abacus_simplex plus, minus;
    ASSERT_EQ(open.locate({0.0, 0.0}, plus), ABACUS_OK);
    ASSERT_EQ(open.locate({-0.0, -0.0}, minus), ABACUS_OK);
    expect_same(plus, minus);
    for (const double far : {1e300, -1e300, 1.7e308, -1.7e308, -5e-324})
        EXPECT_EQ(open.locate({far, 0.5}, plus), ABACUS_END);
    for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        OpenMesh other(mesh, ample);
        EXPECT_EQ(other.locate({0.5, bad}, plus), ABACUS_ERROR);
        EXPECT_EQ(other.error.kind, ABACUS_ERROR_ARGUMENT);
    }
}

TEST(Walk, CrossesEveryFacetOfEveryTriangle) {
    for (const std::size_t cache : {little, ample}) {
        Mesh mesh(0, cache);
        build(mesh, number(unit_square_points(3000, 6)));
        const auto all = mesh.simplices(false);
        std::map<std::pair<std::int64_t, std::int64_t>, const abacus_simplex *> by_edge;
        for (const auto &s : all)
            for (int i = 0; i < 3; ++i) by_edge[{s.id[i], s.id[(i + 1) % 3]}] = &s;
        OpenMesh open(mesh, cache);
        std::uint64_t hull = 0;
        for (const auto &s : all)
            for (int i = 0; i < 3; ++i) {
                const auto beyond = by_edge.find({s.id[(i + 2) % 3], s.id[(i + 1) % 3]});
                abacus_simplex found;
                const abacus_status status = open.walk(s, i, found);
                ASSERT_EQ(status, beyond == by_edge.end() ? ABACUS_END : ABACUS_OK);
                if (status == ABACUS_OK)
                    expect_same(found, *beyond->second);
                else
                    ++hull;
            }
        EXPECT_EQ(hull, mesh.header.facts.census.ghosts);
        EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
    }
}

TEST(Walk, TakesTheIdsInAnyOrder) {
    Mesh mesh(0, ample);
    build(mesh, number(unit_square_points(100, 7)));
    OpenMesh open(mesh, ample);
    for (abacus_simplex s : mesh.simplices(false)) {
        abacus_simplex expected, found;
        const abacus_status status = open.walk(s, 0, expected);
        std::swap(s.id[0], s.id[2]); // the facet opposite the same corner
        ASSERT_EQ(open.walk(s, 2, found), status);
        if (status == ABACUS_OK) expect_same(found, expected);
    }
}

TEST(Walk, RefusesWhatTheMeshDoesNotHave) {
    Mesh mesh(0, ample), empty(0, ample);
    build(mesh, number(unit_square_points(500, 8)));
    const auto refused = [](Mesh &mesh, const abacus_simplex &s, int facet) {
        OpenMesh open(mesh, ample);
        abacus_simplex found;
        return open.walk(s, facet, found) == ABACUS_ERROR &&
               open.error.kind == ABACUS_ERROR_ARGUMENT;
    };
    abacus_simplex s = mesh.simplices(false)[100];
    for (const int facet : {-1, 3, 4, INT32_MIN, INT32_MAX}) EXPECT_TRUE(refused(mesh, s, facet));
    EXPECT_FALSE(refused(mesh, s, 2));
    EXPECT_TRUE(refused(empty, s, 0));
    for (const std::uint64_t code : {std::uint64_t(0), s.code + 1, ~std::uint64_t(0),
                                     std::uint64_t(1) << 62, std::uint64_t(1) << 63}) {
        abacus_simplex other = s;
        other.code = code;
        EXPECT_TRUE(refused(mesh, other, 0));
    }
    s.id[0] = s.id[1];
    EXPECT_TRUE(refused(mesh, s, 0));
    s.id[0] = -1;
    EXPECT_TRUE(refused(mesh, s, 0));
}

TEST(Walk, RefusesWhatIdsDoNotTellApart) {
    // All triangles around one vertex have its code, the greatest; in a large mesh on many pages.
    for (const int n : {8, 3000}) {
        std::vector<Input> points = {{1, {0, 0}}};
        for (int i = 0; i < n; ++i) {
            const double angle = 6.283 * i / n;
            points.push_back({2, {-1 - std::cos(angle), -1 - std::sin(angle)}});
        }
        Mesh mesh(0, ample);
        build(mesh, points);
        std::map<std::pair<std::uint64_t, Ids>, int> named;
        const auto all = mesh.simplices(false);
        const auto name = [](const abacus_simplex &s) {
            Ids ids{s.id[0], s.id[1], s.id[2]};
            std::sort(ids.begin(), ids.end());
            return std::pair(s.code, ids);
        };
        for (const abacus_simplex &s : all) ++named[name(s)];
        ASSERT_LT(named.size(), all.size());
        int refused = 0;
        for (const abacus_simplex &s : all) {
            OpenMesh open(mesh, little);
            abacus_simplex neighbour;
            const bool is_unique = named[name(s)] == 1;
            const abacus_status status = open.walk(s, 0, neighbour);
            ASSERT_EQ(status == ABACUS_ERROR, !is_unique);
            refused += !is_unique;
            if (!is_unique) {
                ASSERT_EQ(open.error.kind, ABACUS_ERROR_ARGUMENT);
                ASSERT_THAT(open.error.message, testing::HasSubstr("several simplices"));
            }
            if (refused > 100) break;
        }
        EXPECT_GT(refused, 0);
    }
}

TEST(Walk, LeavesOutTheCornerAskedForWhereIdsAreEqual) {
    std::vector<Input> points = number(unit_square_points(3000, 5));
    for (Input &p : points) p.id %= 40;
    Mesh mesh(0, ample);
    build(mesh, points);
    OpenMesh open(mesh, little);
    int walked = 0;
    for (const abacus_simplex &s : mesh.simplices(false)) {
        if (s.id[0] != s.id[1] && s.id[1] != s.id[2] && s.id[2] != s.id[0]) continue;
        for (int facet = 0; facet < 3; ++facet) {
            abacus_simplex found;
            if (open.walk(s, facet, found) != ABACUS_OK) continue; // the hull, or not unique
            ++walked;
            for (int i = 0; i < 3; ++i) {
                const auto is_it = [&](const double *corner) {
                    return std::equal(corner, corner + 2, s.corner[i]);
                };
                const bool is_shared = std::any_of(found.corner, found.corner + 3, is_it);
                ASSERT_EQ(is_shared, i != facet);
            }
        }
    }
    EXPECT_GT(walked, 1000);
}

TEST(Walk, KeepsToItsMemoryWhereManyPagesShareACode) {
    // They are far below the resolution of the codes, in a given domain.
    std::vector<Input> points = number(unit_square_points(40000, 3));
    for (Input &p : points)
        for (double &x : p.point) x = 0.3 + x * 1e-11;
    Mesh mesh(0, ample);
    mesh.header.facts.form.has_domain = 1;
    mesh.header.facts.form.upper[0] = mesh.header.facts.form.upper[1] = 1;
    build(mesh, points);
    const auto all = mesh.simplices(false);
    const auto peak = [&](std::size_t cache_bytes) {
        mesh.host.peak_bytes = 0;
        OpenMesh open(mesh, cache_bytes);
        for (std::size_t i = 0; i < all.size(); i += all.size() / 10) {
            abacus_simplex neighbour;
            EXPECT_EQ(open.walk(all[i], 0, neighbour), ABACUS_OK) << open.error.message;
            // and back
            bool is_back = false;
            for (int facet = 0; facet < 3; ++facet) {
                abacus_simplex found;
                is_back |= open.walk(neighbour, facet, found) == ABACUS_OK &&
                           std::equal(found.id, found.id + 3, all[i].id);
            }
            EXPECT_TRUE(is_back);
        }
        return mesh.host.peak_bytes;
    };
    EXPECT_LT(peak(little), peak(ample) / 2);
}

TEST(Walk, LooksIntoFewOfThePagesThatShareACode) {
    std::vector<Input> points = number(unit_square_points(40000, 3));
    for (Input &p : points)
        for (double &x : p.point) x = 0.3 + x * 1e-11;
    for (int i = 0; i < 40000; ++i) // most are elsewhere, and decide the domain
        points.push_back({std::int64_t(points.size()), {0.001 * (i % 200), 0.001 * (i / 200)}});
    Mesh mesh(0, ample);
    build(mesh, points);
    std::uint64_t crowded = 0;
    for (const auto &[key, page] : mesh.host.pages) crowded += key.part != 0;
    ASSERT_GT(crowded, 150u);
    const auto all = mesh.simplices(false);
    OpenMesh open(mesh, ample);
    abacus_simplex neighbour;
    EXPECT_EQ(open.walk(all[all.size() / 2], 0, neighbour), ABACUS_OK) << open.error.message;
    const std::uint64_t found = mesh.host.calls.find;
    int walks = 0;
    for (std::size_t i = 0; i < all.size(); i += all.size() / 50, ++walks)
        ASSERT_EQ(open.walk(all[i], 0, neighbour) == ABACUS_ERROR, false) << open.error.message;
    EXPECT_LE(mesh.host.calls.find - found, 8u * static_cast<unsigned>(walks) + crowded + 10);
}

TEST(Scan, IsTheSameForEveryOrderOfTheInput) {
    for (const auto &points : {grid(30), unit_square_points(3000, 9)}) {
        Mesh first(0, ample), second(0, little);
        build(first, number(points));
        build(second, number(points), 11);
        for (const bool ghosts : {false, true}) {
            auto a = first.simplices(ghosts), b = second.simplices(ghosts);
            ASSERT_EQ(a.size(), b.size());
            const auto key = [](const abacus_simplex &s) {
                return std::tuple(s.code, s.ghost, s.id[0], s.id[1], s.ghost ? 0 : s.id[2]);
            };
            const auto less = [&](const auto &x, const auto &y) { return key(x) < key(y); };
            std::sort(a.begin(), a.end(), less);
            std::sort(b.begin(), b.end(), less);
            for (std::size_t i = 0; i < a.size(); ++i) ASSERT_EQ(key(a[i]), key(b[i]));
        }
    }
}

TEST(Scan, GivesTheHullAsGhosts) {
    Mesh mesh(0, ample);
    build(mesh, number(unit_square_points(2000, 12)));
    std::map<std::int64_t, std::int64_t> next;
    std::uint64_t triangles = 0;
    for (const auto &s : mesh.simplices(true)) {
        if (!s.ghost) {
            ++triangles;
            EXPECT_EQ(s.id[0], std::min({s.id[0], s.id[1], s.id[2]}));
            EXPECT_EQ(orientation(corner(s, 0), corner(s, 1), corner(s, 2)), 1);
        } else {
            next[s.id[0]] = s.id[1];
        }
    }
    EXPECT_EQ(triangles, mesh.header.facts.census.simplices);
    EXPECT_EQ(next.size(), mesh.header.facts.census.ghosts);
    std::size_t steps = 0; // the hull is one cycle
    for (std::int64_t at = next.begin()->first; steps == 0 || at != next.begin()->first; ++steps)
        at = next.at(at);
    EXPECT_EQ(steps, next.size());
}

TEST(VertexScan, TracesEveryPointToItsVertex) {
    // Repetitions within a staging, and of earlier stagings; the last staging still waits.
    Random random(13);
    const auto any = [&] { return Point<2>{double(random() % 40), double(random() % 40)}; };
    Mesh mesh(1, little);
    std::map<Point<2>, std::int64_t> vertex;
    std::vector<Input> all;
    for (int batch = 0; batch < 4; ++batch) {
        std::vector<Input> inputs;
        for (int i = 0; i < 500; ++i) {
            inputs.push_back({batch * 1000 + i, any(), {i + 0.5}});
            vertex.emplace(inputs.back().point, inputs.back().id);
        }
        all.insert(all.end(), inputs.begin(), inputs.end());
        ASSERT_EQ(mesh.stage(inputs), ABACUS_OK);
        if (batch == 3) break;
        ASSERT_EQ(mesh.build(), ABACUS_OK);
    }
    abacus_vertex_scan *scan = nullptr;
    ASSERT_EQ(
        abacus_vertex_scan_open(mesh.host.table(), &mesh.header.facts, little, &scan, &mesh.error),
        ABACUS_OK);
    std::map<std::int64_t, Input> seen;
    abacus_vertex v;
    std::uint64_t sequence = mesh.header.facts.census.inserted;
    abacus_status status;
    while ((status = abacus_vertex_scan_next(scan, &v, &mesh.error)) == ABACUS_OK) {
        EXPECT_EQ(seen.count(v.id), 0u);
        seen[v.id] = {v.id, {v.point[0], v.point[1]}, {v.attributes[0]}};
        EXPECT_EQ(v.waits, v.id >= 3000);
        if (v.waits) {
            EXPECT_EQ(v.sequence, sequence++);
        } else {
            EXPECT_EQ(v.vertex, vertex.at({v.point[0], v.point[1]})) << v.id;
        }
    }
    EXPECT_EQ(status, ABACUS_END) << mesh.error.detail;
    abacus_vertex_scan_close(scan);
    ASSERT_EQ(seen.size(), all.size());
    for (const Input &input : all) {
        EXPECT_EQ(seen.at(input.id).point, input.point);
        EXPECT_EQ(seen.at(input.id).attributes, input.attributes);
    }
    EXPECT_EQ(mesh.host.bytes, 0u);
}

} // namespace
} // namespace abacus::test
