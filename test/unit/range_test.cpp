// The pages of a region: they contain all its simplices, each is read once, and few others are
// read.
#include "keys/domain_of.hpp"
#include "query/pages/page_simplex.hpp"
#include "query/scan/range_scan.hpp"
#include "support/point_sets.hpp"
#include "support/sanitized.hpp"
#include "support/triangulations.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace abacus::test {
namespace {

template <int D> bool meets(const abacus_simplex &s, const Box<D> &box) {
    std::array<Point<D>, D + 1> at;
    Corners<D> corners;
    for (int i = 0; i <= D; ++i) {
        std::copy_n(s.corner[i], D, at[i].begin());
        corners[i] = &at[i];
    }
    return abacus::meets<D>(corners, box);
}

template <int D> Positions<D> places(const abacus_simplex &s) {
    Positions<D> at;
    for (int i = 0; i <= D; ++i) std::copy_n(s.corner[i], D, at[i].begin());
    return at;
}

template <int D> Box<D> around(const Point<D> &a, const Point<D> &b) {
    Box<D> box;
    box.extend(a);
    box.extend(b);
    return box;
}

/// Large and small boxes, inside and outside; some touch the mesh or are flat.
template <int D> std::vector<Box<D>> boxes(const std::vector<Point<D>> &points, Random &random) {
    std::vector<Box<D>> result;
    const auto any = [&]() -> const Point<D> & { return points[random() % points.size()]; };
    Box<D> all;
    for (const Point<D> &p : points) all.extend(p);
    const auto moved = [&](Point<D> p, double by) {
        for (int i = 0; i < D; ++i) {
            const double x =
                p[i] + (all.upper[i] * 0.5 - all.lower[i] * 0.5) * by * (unit(random) - 0.5);
            if (std::isfinite(x)) p[i] = x;
        }
        return p;
    };
    for (int i = 0; i < 6; ++i) {
        const Point<D> p = any();
        result.push_back(around<D>(p, p));
        result.push_back(around<D>(p, any()));
        result.push_back(around<D>(moved(p, 0.01), moved(p, 0.01)));
        result.push_back(around<D>(moved(p, 0.2), moved(p, 0.2)));
        result.push_back(around<D>(moved(p, 3), moved(p, 3)));
        const Point<D> q = moved(p, 6); // mostly outside
        result.push_back(around<D>(q, moved(q, 0.5)));
        // Beside the mesh, touching its box along a side.
        Box<D> beside = around<D>(p, any());
        const int axis = static_cast<int>(random() % D);
        beside.lower[axis] = beside.upper[axis] = all.upper[axis];
        result.push_back(beside);
    }
    return result;
}

/// Reads a region; fails the test if a page comes twice.
template <int D>
std::multiset<Positions<D>> read(MeshOf<D> &mesh, const Box<D> &box,
                                 std::uint64_t *pages = nullptr) {
    const Host host = mesh.host.host();
    const BoxRegion<D> region(box);
    RangeScan<D> scan(host, mesh.header, &region);
    std::multiset<Positions<D>> found, again;
    std::vector<Key> keys;
    const auto take = [&](std::multiset<Positions<D>> &simplices) {
        const PageView<D> &page = scan.page();
        for (int s = 0; s < page.simplices(); ++s) {
            if (page.is_ghost(s) || !abacus::meets<D>(corners_of(page, s), box)) continue;
            abacus_simplex described;
            describe(page, s, domain_of<D>(mesh.header.facts.form), described);
            simplices.insert(places<D>(described));
        }
    };
    const std::uint64_t before = mesh.host.calls.find + mesh.host.calls.next;
    for (; scan.advance(); keys.push_back(scan.page().lower())) take(found);
    if (pages != nullptr) *pages = mesh.host.calls.find + mesh.host.calls.next - before;
    std::sort(keys.begin(), keys.end(), [](const Key &a, const Key &b) { return a < b; });
    EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end(),
                                 [](const Key &a, const Key &b) { return a == b; }),
              keys.end());
    // Again: the same pages, along the curve.
    std::size_t n = 0;
    for (scan.rewind(); scan.advance(); ++n) {
        EXPECT_TRUE(n < keys.size() && keys[n] == scan.page().lower());
        take(again);
    }
    EXPECT_EQ(n, keys.size());
    EXPECT_EQ(found, again);
    return found;
}

template <int D> void expect_all(MeshOf<D> &mesh, const std::vector<Box<D>> &boxes) {
    const auto all = mesh.simplices(false);
    for (const Box<D> &box : boxes) {
        std::multiset<Positions<D>> expected;
        for (const abacus_simplex &s : all)
            if (meets<D>(s, box)) expected.insert(places<D>(s));
        const auto found = read<D>(mesh, box);
        EXPECT_TRUE(found == expected) << found.size() << " of " << expected.size();
    }
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
    EXPECT_EQ(mesh.host.bytes, 0u);
}

template <int D> std::vector<Point<D>> uniform(int n, Random &random) {
    std::vector<Point<D>> points(n);
    for (auto &p : points)
        for (double &x : p) x = unit(random);
    return points;
}

template <class Dimension> class Range : public testing::Test {
protected:
    static constexpr int D = Dimension::value;
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Range, Dimensions);

TYPED_TEST(Range, HasAllSimplicesOfHardSets) {
    constexpr int D = TestFixture::D;
    for (const PointSet<D> &set : point_sets<D>()) {
        SCOPED_TRACE(set.name);
        Random random(1);
        auto points = set.points(random);
        if (sanitized && points.size() > 300) points.resize(300);
        MeshOf<D> mesh;
        ASSERT_EQ(mesh.insert(number<D>(points)), ABACUS_OK) << mesh.error.message;
        expect_all<D>(mesh, boxes<D>(points, random));
    }
}

TYPED_TEST(Range, HasAllSimplicesOfManyPages) {
    constexpr int D = TestFixture::D;
    Random random(2);
    std::vector<std::vector<Point<D>>> sets(1, uniform<D>(6000, random));
    std::vector<Point<D>> clustered, thin, round;
    for (int i = 0; i < 6000; ++i) {
        Point<D> p, q, r;
        double length = 0;
        for (int k = 0; k < D; ++k) {
            p[k] = i % 5 * (k == 0 ? 1 : 0.3) + std::pow(unit(random), 8) * 0.5;
            q[k] = k == 0 ? i : unit(random) + (i % 2) * 1e4; // two lines of needles
            r[k] = unit(random) - 0.5;
            length += r[k] * r[k];
        }
        for (int k = 0; k < D; ++k) r[k] /= std::sqrt(length); // all on the hull
        clustered.push_back(p);
        thin.push_back(q);
        if (i < 3000) round.push_back(r);
    }
    sets.insert(sets.end(), {clustered, thin, round});
    for (const auto &points : sets) {
        MeshOf<D> mesh;
        ASSERT_EQ(mesh.insert(number<D>(points)), ABACUS_OK) << mesh.error.message;
        expect_all<D>(mesh, boxes<D>(points, random));
    }
}

TYPED_TEST(Range, ReadsFewPages) {
    constexpr int D = TestFixture::D;
    Random random(3);
    MeshOf<D> mesh;
    ASSERT_EQ(mesh.insert(number<D>(uniform<D>(D == 2 ? 60000 : 20000, random))), ABACUS_OK);
    ASSERT_GT(mesh.host.pages.size(), 150u);
    Point<D> lower, upper, far;
    lower.fill(0.4);
    upper.fill(0.41);
    far.fill(5);
    std::uint64_t pages;
    EXPECT_FALSE(read<D>(mesh, around<D>(lower, upper), &pages).empty());
    EXPECT_LE(pages, D == 2 ? 20u : 50u);
    // Far outside, the first facet of the hull is enough.
    EXPECT_TRUE(read<D>(mesh, around<D>(far, far), &pages).empty());
    EXPECT_LE(pages, D == 2 ? 10u : 30u);
    // For a large window, every page once.
    lower.fill(-1);
    EXPECT_EQ(read<D>(mesh, around<D>(lower, far), &pages).size(),
              mesh.header.facts.census.simplices);
    EXPECT_LE(pages, mesh.host.pages.size() + 2);
}

TYPED_TEST(Range, HasAllSimplicesOfLoadedMeshes) {
    constexpr int D = TestFixture::D;
    Random random(4);
    const auto points = uniform<D>(D == 2 ? 3000 : 800, random);
    auto shells = keeping<D>(delaunay<D>(points), [](const Point<D> &c) {
        double sum = 0;
        for (const double x : c) sum += (x - 0.5) * (x - 0.5);
        return static_cast<int>(8 * std::sqrt(sum)) % 2 == 0;
    });
    MeshOf<D> mesh;
    ASSERT_EQ(mesh.load(shells.vertices, shells.simplices), ABACUS_OK) << mesh.error.message;
    ASSERT_EQ(mesh.header.facts.standing, ABACUS_NOT_CONVEX);
    expect_all<D>(mesh, boxes<D>(points, random));
}

TYPED_TEST(Range, NoticesAMissingPage) {
    constexpr int D = TestFixture::D;
    Random random(5);
    const auto points = uniform<D>(3000, random);
    MeshOf<D> mesh;
    ASSERT_EQ(mesh.insert(number<D>(points)), ABACUS_OK);
    Point<D> lower, upper;
    lower.fill(0.25);
    upper.fill(0.6);
    const Host host = mesh.host.host();
    const BoxRegion<D> region(around<D>(lower, upper));
    std::vector<Key> keys;
    {
        RangeScan<D> scan(host, mesh.header, &region);
        while (scan.advance()) keys.push_back(scan.page().lower());
    }
    ASSERT_GT(keys.size(), 2u);
    for (const Key &key : keys) {
        const auto page = mesh.host.pages.extract(key);
        EXPECT_THROW(
            {
                RangeScan<D> scan(host, mesh.header, &region);
                while (scan.advance()) {
                }
            },
            Error);
        mesh.host.pages.insert({key, page.mapped()});
    }
}

} // namespace
} // namespace abacus::test
