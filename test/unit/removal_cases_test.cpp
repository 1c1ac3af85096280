// Special cases of removal: mixed with insertion, of vertices with very many neighbours, down to
// the collapse, with attributes; and its effects on pages, counters and failures.
#include "support/mesh_in_change.hpp"
#include "support/point_sets.hpp"
#include "support/sanitized.hpp"

#include <cmath>
#include <set>

namespace abacus::test {
namespace {

constexpr std::size_t little = 60 << 10, ample = std::size_t(1) << 30;

// Inputs that take long under a sanitizer are smaller there.
const int scale = sanitized ? 10 : 1;

template <int D> Domain<D> cube(double lower, double upper) {
    Point<D> from, to;
    from.fill(lower);
    to.fill(upper);
    return {from, to};
}

// ---- In turns with insertion ------------------------------------------------------

/// Points of a small grid come and go at random; some that are requested do not exist.
template <int D> void insert_and_remove(int grid, int steps, int verified_every) {
    Random random(D);
    const auto any = [&] {
        Point<D> p;
        for (double &x : p) x = std::floor(unit(random) * grid) - grid / 2;
        return p;
    };
    MeshInChange<D> mesh(cube<D>(-grid, grid), little);
    std::vector<Point<D>> start;
    for (int i = 0; i < 20 * grid; ++i) start.push_back(any());
    std::set<Point<D>> points(start.begin(), start.end());
    ASSERT_TRUE(mesh.build(start));
    for (int step = 0; step < steps; ++step) {
        // Waves of growth and decline.
        const bool growing = unit(random) < (step / 500 % 2 == 0 ? 0.65 : 0.35);
        const Point<D> p = any();
        if (growing) {
            ASSERT_EQ(mesh.insertion.insert(p, step, nullptr), points.insert(p).second);
        } else {
            const Removed expected =
                points.erase(p) > 0 ? Removed::removed : Removed::no_such_vertex;
            ASSERT_EQ(mesh.removal.remove(p), expected);
        }
        ASSERT_EQ(mesh.cache.check_invariants(), nullptr) << "step " << step;
        if (step % verified_every == 0) {
            mesh.verify({points.begin(), points.end()});
            if (testing::Test::HasFatalFailure()) return;
        }
    }
    EXPECT_GT(mesh.cache.counters.evictions, 0u);
}
TEST(RemovalInTurns, InThePlane) { insert_and_remove<2>(40, 8000 / scale, 100); }
TEST(RemovalInTurns, InSpace) { insert_and_remove<3>(12, 5000 / scale, 200); }

// ---- Very many neighbours -----------------------------------------------------------

/// Inserts the points and the hub, and removes the hub again.
template <int D> void remove_hub(const std::vector<Point<D>> &points, const Point<D> &hub) {
    auto all = points;
    all.push_back(hub);
    const Domain<D> domain = box_around<D>(all);
    std::sort(all.begin(), all.end(), [&](const Point<D> &a, const Point<D> &b) {
        return domain.code(a) < domain.code(b);
    });
    MeshInChange<D> mesh(domain, ample);
    ASSERT_TRUE(mesh.build(all));
    ASSERT_EQ(mesh.removal.remove(hub), Removed::removed);
    mesh.verify(points);
    // The two operations undo each other.
    ASSERT_TRUE(mesh.insertion.insert(hub, 0, nullptr));
    mesh.verify(all);
}

TEST(RemovalOfAHub, CentreOfACircle) {
    std::vector<Point<2>> points;
    for (int i = 0; i < 50000 / scale; ++i) {
        const double angle = 6.283185307179586 * i * scale / 50000;
        points.push_back({std::cos(angle), std::sin(angle)});
    }
    remove_hub<2>(points, {0.001, 0.002});
}
TEST(RemovalOfAHub, ApexOverALineWithPointsOnTheOtherSide) {
    std::vector<Point<2>> points;
    for (int i = 0; i < 50000 / scale; ++i) points.push_back({i + 0.0, 0});
    points.push_back({7, -100});
    remove_hub<2>(points, {25000.0 / scale, 1e9});
}
TEST(RemovalOfAHub, CentreOfASphere) {
    Random random(1);
    std::vector<Point<3>> points;
    for (int i = 0; i < 20000 / scale; ++i) {
        const double z = 2 * unit(random) - 1, angle = 6.283185307179586 * unit(random);
        const double r = std::sqrt(1 - z * z) * (1 + 1e-7 * unit(random));
        points.push_back({r * std::cos(angle), r * std::sin(angle), z});
    }
    remove_hub<3>(points, {0.001, 0.002, -0.001});
}
TEST(RemovalOfAHub, ApexOverAGridWithAPointBelow) {
    const int side = 120 / (scale > 1 ? 4 : 1);
    std::vector<Point<3>> points;
    for (int i = 0; i < side * side; ++i) points.push_back({i % side + 0.0, i / side + 0.0, 0});
    points.push_back({side / 2.0, side / 3.0, -5});
    remove_hub<3>(points, {side / 2.0, side / 2.0, 1e6});
}
TEST(RemovalOfAHub, ApexOverABumpyGrid) {
    const int side = 80 / (scale > 1 ? 4 : 1);
    std::vector<Point<3>> points;
    for (int i = 0; i < side * side; ++i) {
        const double x = i % side, y = i / side;
        points.push_back({x, y, -0.01 * ((x - side) * (x - side) + y * y)});
    }
    remove_hub<3>(points, {side / 2.0, side / 2.0, 1e6});
}

/// On the moment curve, where all points are neighbours.
Point<3> on_moment_curve(double t) { return {t, t * t, t * t * t}; }

TEST(RemovalOfAHub, OfAMomentCurve) {
    std::vector<Point<3>> points;
    for (int i = 0; i < 200 / (scale > 1 ? 4 : 1); ++i) points.push_back(on_moment_curve(i));
    remove_hub<3>(points, on_moment_curve(20.5));
    remove_hub<3>(points, on_moment_curve(-1));
}
TEST(RemovalOfAHub, BesideALineFullOfPoints) {
    std::vector<Point<3>> points;
    for (int i = 0; i < 3000 / scale; ++i) points.push_back({i * 1.0, i * 2.0, i * 3.0});
    for (int i = 0; i < 60; ++i)
        points.push_back({i % 4 * 1000.0 / scale, i / 4 % 4 * 999.0, i / 16 * 1001.0});
    points = distinct(points);
    remove_hub<3>(points, {500.5, 1000, 1500});
}
TEST(RemovalOfAHub, BetweenTwoSkewLines) {
    std::vector<Point<3>> points;
    for (int i = -100 / scale; i < 100 / scale; ++i) {
        points.push_back({i + 0.5, 0, -50});
        points.push_back({0, i + 0.25, 50});
    }
    remove_hub<3>(points, {0, 0, 0});
    remove_hub<3>(points, {0.75, 0, -50});
}

/// The mesh of a hub's neighbours stays as small as the hole, even if their triangulation has a
/// simplex for every pair of them.
TEST(LinkMesh, HasNoMoreThanTheHole) {
    constexpr int n = 400;
    std::vector<Point<3>> points;
    for (int i = 0; i < n; ++i) points.push_back(on_moment_curve(i));
    MeshInChange<3> mesh(box_around<3>(points), ample);
    ASSERT_TRUE(mesh.build(points));
    Star<3> star(mesh.delaunay);
    const Handle h = mesh.delaunay.locate(points[n / 2], 0, no_handle);
    star.collect(h, mesh.delaunay.corner_at(h, points[n / 2]));
    EXPECT_GE(star.link().size(), n - 1u);
    std::array<VertexIndex, 4> independent;
    ASSERT_FALSE(star.is_flat(independent));
    LinkMesh<3> link(mesh.host());
    link.triangulate(mesh.cache, star, independent);
    EXPECT_GT(mesh.delaunay.simplices(), n * n / 3);
    EXPECT_LT(link.cells(), 12u * n);
}

// ---- The end of a mesh ------------------------------------------------------------

template <int D> void expect_collapse(const std::vector<Point<D>> &points, const Point<D> &last) {
    auto all = points;
    all.push_back(last);
    MeshInChange<D> mesh(box_around<D>(all), little, 1);
    ASSERT_TRUE(mesh.build(all));
    const auto deleted = mesh.cache.counters.deleted;
    ASSERT_EQ(mesh.removal.remove(last), Removed::collapses);
    // The removal reports the neighbours, and nothing has changed.
    std::vector<Point<D>> left;
    mesh.removal.each_neighbour([&](VertexIndex v) { left.push_back(mesh.cache.point(v)); });
    EXPECT_EQ(distinct(left), distinct(points));
    EXPECT_EQ(mesh.cache.counters.deleted, deleted);
    EXPECT_EQ(mesh.cache.counters.removals, 0u);
    mesh.verify(all);
}

TEST(Collapse, IsToldBeforeAnythingIsChanged) {
    expect_collapse<2>({{0, 0}, {1, 0}}, {0, 1});
    expect_collapse<2>({{0, 0}, {1, 1}, {3, 3}, {2, 2}}, {2, 1});
    expect_collapse<3>({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 0, 1});
    expect_collapse<3>({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {5, 7, 0}}, {2, 2, 1});
    std::vector<Point<2>> line;
    for (int i = 0; i < 3000; ++i) line.push_back({i + 0.0, 3});
    expect_collapse<2>(line, {17, 4});
    std::vector<Point<3>> plane;
    for (int i = 0; i < 400; ++i) plane.push_back({i % 20 + 0.0, i / 20 + 0.0, 3});
    expect_collapse<3>(plane, {4, 4, 4});
}
TEST(Collapse, IsNoneIfTheNeighboursSpanASimplex) {
    // Every simplex contains the vertex, but the other points span simplices without it.
    MeshInChange<2> square(cube<2>(-1, 1), little);
    ASSERT_TRUE(square.build({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, 0}}));
    ASSERT_EQ(square.removal.remove({0, 0}), Removed::removed);
    square.verify({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}});
    ASSERT_EQ(square.removal.remove({1, 1}), Removed::removed);
    square.verify({{-1, -1}, {1, -1}, {-1, 1}});
    ASSERT_EQ(square.removal.remove({-1, -1}), Removed::collapses);
}

// ---- Vertices ------------------------------------------------------------------------

TEST(Removal, FindsVerticesByTheirExactCoordinates) {
    MeshInChange<2> mesh(cube<2>(-1, 1), little);
    const std::vector<Point<2>> points = {{-1, -1}, {1, -1}, {0, 1}, {0, 0}, {0.5, -1}};
    ASSERT_TRUE(mesh.build(points));
    for (const Point<2> &p : std::vector<Point<2>>{
             {0, 5e-324}, {2, 0}, {-7, -7}, {-0.5, -1}, {std::nextafter(1.0, 0.0), -1}})
        EXPECT_EQ(mesh.removal.remove(p), Removed::no_such_vertex);
    mesh.verify(points);
    Leaving leaving(mesh.host(), 1 << 20, false, 0);
    leaving.want(0, nullptr);
    const auto is_there = [&](const Point<2> &p) {
        leaving.begin();
        return mesh.removal.offer(p, leaving).has_value();
    };
    EXPECT_FALSE(is_there({0, 5e-324}));
    EXPECT_TRUE(is_there({-0.0, 0}));
    EXPECT_EQ(mesh.removal.remove({-0.0, -0.0}), Removed::removed);
    EXPECT_FALSE(is_there({0, 0}));
    EXPECT_EQ(mesh.removal.remove({0, 0}), Removed::no_such_vertex);
    mesh.verify({{-1, -1}, {1, -1}, {0, 1}, {0.5, -1}});
}

TEST(Removal, FindsNothingInAnEmptyMesh) {
    MeshInChange<2> mesh(cube<2>(-1, 1), little);
    EXPECT_EQ(mesh.removal.remove({0, 0}), Removed::no_such_vertex);
    EXPECT_FALSE(mesh.removal.rename({0, 0}, 1, nullptr));
}

template <int D> void rename_all() {
    Random random(5);
    std::vector<Point<D>> points((D == 2 ? 6000 : 2500) / scale);
    for (auto &p : points)
        for (double &x : p) x = unit(random);
    MeshInChange<D> mesh(cube<D>(0, 1), little, 1);
    ASSERT_TRUE(mesh.build(points));
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double value = points[i][0] + 1;
        ASSERT_TRUE(mesh.removal.rename(points[i], static_cast<std::int64_t>(i) - 1000, &value));
    }
    EXPECT_FALSE(mesh.removal.rename(cube<D>(0, 1).upper(), 0, nullptr));
    mesh.cache.flush();
    // In every page; load() compares the pages with one another.
    Cache<D> fresh(mesh.host(), mesh.cache.domain(), 1, {.budget = ample});
    std::set<std::int64_t> ids;
    for (Key key = first_key; key < end_key;)
        key = fresh.visit(key, [&](Handle h) {
            const Simplex<D> &s = fresh.simplex(h);
            for (int i = 0; i < s.finite_vertices(); ++i) {
                const VertexIndex v = s.vertex[i];
                const std::int64_t id = fresh.vertices().id(v);
                ids.insert(id);
                ASSERT_EQ(fresh.point(v), points[static_cast<std::size_t>(id + 1000)]);
                ASSERT_EQ(*fresh.vertices().attributes(v), fresh.point(v)[0] + 1);
            }
        });
    EXPECT_EQ(ids.size(), points.size());
}
TEST(Rename, ReachesEveryPageInThePlane) { rename_all<2>(); }
TEST(Rename, ReachesEveryPageInSpace) { rename_all<3>(); }

// ---- Pages, counters, failures ----------------------------------------------------------

TEST(Removal, LeavesNoEmptyPagesThatWereNeverStored) {
    auto points = unit_square_points(20000, 3);
    MeshInChange<2> mesh(cube<2>(0, 1), ample);
    ASSERT_TRUE(mesh.build(points));
    while (points.size() > 10) {
        ASSERT_EQ(mesh.removal.remove(points.back()), Removed::removed);
        points.pop_back();
    }
    mesh.verify(points);
    EXPECT_LE(mesh.memory().pages.size(), 2u);
}

/// Removes points one by one until this many are left.
template <int D, class Points>
void remove_down_to(MeshInChange<D> &mesh, Points &points, std::size_t left) {
    for (; points.size() > left; points.pop_back())
        ASSERT_EQ(mesh.removal.remove(points.back()), Removed::removed);
}
template <int D> double bytes_a_simplex(MeshInChange<D> &mesh) {
    std::size_t bytes = 0;
    for (const auto &[key, page] : mesh.memory().pages) bytes += page.size;
    return double(bytes) / double(mesh.delaunay.simplices());
}

template <int D> void merge_stored_pages(std::size_t count) {
    Random random(2);
    std::vector<Point<D>> points(count);
    for (auto &p : points)
        for (double &x : p) x = unit(random);
    MeshInChange<D> mesh(cube<D>(0, 1), 10 * little);
    std::sort(points.begin(), points.end(), [&](const Point<D> &a, const Point<D> &b) {
        return mesh.cache.domain().code(a) < mesh.cache.domain().code(b);
    });
    ASSERT_TRUE(mesh.build(points));
    mesh.cache.flush();
    const double before = bytes_a_simplex(mesh);
    const std::size_t pages = mesh.memory().pages.size();
    // Every second point along the curve.
    std::vector<Point<D>> left;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (i % 2 == 0)
            left.push_back(points[i]);
        else
            ASSERT_EQ(mesh.removal.remove(points[i]), Removed::removed);
    mesh.verify(left);
    EXPECT_LT(bytes_a_simplex(mesh), 1.25 * before);
    remove_down_to<D>(mesh, left, 100);
    mesh.verify(left);
    EXPECT_LT(mesh.memory().pages.size(), pages / 20);
}
TEST(Removal, MergesStoredPagesInThePlane) { merge_stored_pages<2>(30000); }
TEST(Removal, MergesStoredPagesInSpace) { merge_stored_pages<3>(6000); }

TEST(Removal, MergesStoredPagesInRandomOrder) {
    auto points = unit_square_points(6000, 3);
    MeshInChange<2> mesh(cube<2>(0, 1), little);
    ASSERT_TRUE(mesh.build(points));
    mesh.cache.flush();
    EXPECT_GT(mesh.memory().pages.size(), 15u);
    remove_down_to<2>(mesh, points, 50);
    mesh.verify(points);
    EXPECT_LE(mesh.memory().pages.size(), 3u);
    for (const Point<2> &p : unit_square_points(200, 4)) {
        ASSERT_TRUE(mesh.insertion.insert(p, 0, nullptr));
        points.push_back(p);
    }
    mesh.verify(points);
}

TEST(Removal, IsCounted) {
    auto points = unit_square_points(1000, 3);
    MeshInChange<2> mesh(cube<2>(0, 1), ample);
    ASSERT_TRUE(mesh.build(points));
    mesh.cache.counters = {};
    for (int i = 0; i < 100; ++i) ASSERT_EQ(mesh.removal.remove(points[i]), Removed::removed);
    EXPECT_EQ(mesh.removal.remove({2, 2}), Removed::no_such_vertex);
    const abacus_counters &counters = mesh.cache.counters;
    EXPECT_EQ(counters.removals, 100u);
    EXPECT_EQ(counters.insertions, 0u);
    EXPECT_EQ(counters.deleted - counters.created, 200u); // in 2D two triangles for each vertex
}

/// Removes half of the points. The n-th fallible call fails, or memory ends at the n-th request.
/// Returns whether the work was completed.
template <int D>
bool remove_and_fail(MemoryHost &stored, const MeshInChange<D> &from,
                     const std::vector<Point<D>> &points, std::uint64_t n, bool memory_ends) {
    MemoryHost memory;
    memory.restore(stored);
    const Host host = memory.host();
    bool done = false;
    {
        std::size_t i = 0;
        Cache<D> cache(host, from.cache.domain(), 0, {.budget = little});
        Delaunay<D> delaunay(host, cache, from.delaunay.simplices(), from.delaunay.ghosts());
        Removal<D> removal(delaunay);
        if (memory_ends)
            memory.fail_resize_at(n);
        else
            memory.fail_at(n);
        try {
            for (; i < points.size() / 2; ++i) removal.remove(points[i]);
            cache.flush();
            done = true;
        } catch (const HostFailure &) {
            EXPECT_FALSE(memory_ends);
        } catch (const std::bad_alloc &) {
            EXPECT_TRUE(memory_ends);
        }
    }
    EXPECT_EQ(memory.bytes, 0u);
    EXPECT_EQ(memory.violations, std::vector<std::string>{});
    return done;
}
template <int D> void fail_everywhere() {
    Random random(9);
    std::vector<Point<D>> points(D == 2 ? 1500 : 400);
    for (auto &p : points)
        for (double &x : p) x = std::floor(unit(random) * 64);
    points = distinct(points);
    std::shuffle(points.begin(), points.end(), random);
    MeshInChange<D> mesh(cube<D>(0, 64), little);
    ASSERT_TRUE(mesh.build(points));
    mesh.cache.flush();
    for (const bool memory_ends : {false, true})
        for (std::uint64_t n = 1;
             n < 100000 && !remove_and_fail<D>(mesh.memory(), mesh, points, n, memory_ends);
             n += 1 + n / 8)
            ;
}
TEST(RemovalFailure, GivesEverythingBackInThePlane) { fail_everywhere<2>(); }
TEST(RemovalFailure, GivesEverythingBackInSpace) { fail_everywhere<3>(); }

TEST(RemovalFailure, ALongRemovalIsInterrupted) {
    std::vector<Point<2>> points = {{0.001, 0.002}};
    for (int i = 0; i < 20000; ++i) {
        const double angle = 6.283185307179586 * i / 20000;
        points.push_back({std::cos(angle), std::sin(angle)});
    }
    MeshInChange<2> mesh(cube<2>(-1, 1), ample);
    ASSERT_TRUE(mesh.build(points));
    mesh.memory().cancel();
    EXPECT_THROW(mesh.removal.remove(points[0]), HostFailure);
}

} // namespace
} // namespace abacus::test
