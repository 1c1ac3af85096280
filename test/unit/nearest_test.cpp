// The nearest vertices, compared with brute force in exact arithmetic over all points.
#include "query/locate/nearest.hpp"
#include "support/flipped_mesh.hpp"
#include "support/point_sets.hpp"
#include "support/sanitized.hpp"
#include "support/triangulations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace abacus::test {
namespace {

constexpr std::size_t little = 60 << 10, ample = 64 << 20;

template <int D> using Found = std::vector<std::pair<std::int64_t, Point<D>>>;

template <int D> Found<D> nearest(Reader<D> &reader, const Point<D> &p, std::uint64_t k) {
    Found<D> found;
    Nearest<D>(reader).find(p, k, [&](const std::uint64_t *record) {
        found.emplace_back(record_id(record), record_point<D>(record));
    });
    return found;
}

/// Vertices, middles of pairs, arbitrary places, and places far away.
template <int D> std::vector<Point<D>> places(const std::vector<Point<D>> &points, Random &random) {
    std::vector<Point<D>> result;
    for (int i = 0; i < (sanitized ? 2 : 5); ++i) {
        const Point<D> &a = points[random() % points.size()], &b = points[random() % points.size()];
        Point<D> middle, beside, far;
        for (int k = 0; k < D; ++k) {
            middle[k] = a[k] * 0.5 + b[k] * 0.5;
            beside[k] = middle[k] * (1 + 0.1 * unit(random));
            far[k] = (a[k] - b[k]) * 3;
            if (!std::isfinite(beside[k])) beside[k] = a[k];
            if (!std::isfinite(far[k])) far[k] = b[k];
        }
        result.insert(result.end(), {a, middle, beside, far});
    }
    return result;
}

template <int D>
void expect_nearest(MeshOf<D> &mesh, const std::vector<Point<D>> &points, Random &random) {
    const Host host = mesh.host.host();
    std::set<Point<D>> all(points.begin(), points.end());
    for (const std::size_t bytes : {ample, little}) {
        Reader<D> reader(host, mesh.header, bytes);
        for (const Point<D> &p : places<D>(points, random)) {
            const std::uint64_t k = random() % 3 == 0 ? 1 : random() % (all.size() + 3);
            const auto found = nearest<D>(reader, p, k);
            ASSERT_EQ(found.size(), std::min<std::uint64_t>(k, all.size()));
            std::set<Point<D>> others = all;
            for (std::size_t i = 0; i < found.size(); ++i) {
                ASSERT_EQ(others.erase(found[i].second), 1u) << i << " of " << k;
                if (i > 0) {
                    ASSERT_TRUE(comes_nearer<D>(p, found[i - 1].second, found[i].second));
                }
            }
            for (const Point<D> &other : others)
                ASSERT_TRUE(found.empty() || comes_nearer<D>(p, found.back().second, other));
            ASSERT_EQ(reader.cache().check_invariants(), nullptr);
        }
    }
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
    EXPECT_EQ(mesh.host.bytes, 0u);
}

template <int D> void expect_nearest_of_sets() {
    Random random(1);
    for (const PointSet<D> &set : point_sets<D>()) {
        SCOPED_TRACE(set.name);
        auto points = set.points(random);
        constexpr std::size_t most = D == 2 ? 100 : 40; // far apart, they need exact arithmetic
        if (points.size() > most) points.resize(most);
        for (Point<D> &p : points)
            for (double &x : p) x += 0.0;
        MeshOf<D> mesh(0);
        ASSERT_EQ(mesh.stage(number<D>(points)), ABACUS_OK);
        ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.message;
        if (mesh.header.facts.census.simplices > 0) expect_nearest<D>(mesh, points, random);
    }
}

TEST(Nearest, EqualsBruteForceInThePlane) { expect_nearest_of_sets<2>(); }
TEST(Nearest, EqualsBruteForceInSpace) { expect_nearest_of_sets<3>(); }

/// Points of a grid within a shell, with flips, so that no walk and no edge leads everywhere.
template <int D> void expect_nearest_of_loaded() {
    Random random(2);
    std::vector<Point<D>> grid;
    const int n = D == 2 ? 25 : 7;
    for (int i = 0; i < (D == 2 ? n * n : n * n * n); ++i) {
        Point<D> p{};
        for (int k = 0, rest = i; k < D; ++k, rest /= n) p[k] = rest % n;
        grid.push_back(p);
    }
    auto t = keeping<D>(delaunay<D>(grid), [&](const Point<D> &c) {
        double square = 0;
        for (const double x : c) square += (x - n / 2.0) * (x - n / 2.0);
        return static_cast<int>(std::sqrt(square)) % 3 != 0;
    });
    flip(t, 200, 3);
    MeshOf<D> mesh(0);
    ASSERT_EQ(mesh.load(t.vertices, t.simplices), ABACUS_OK) << mesh.error.message;
    ASSERT_NE(mesh.header.facts.standing, 0u);
    std::vector<Point<D>> points;
    for (const auto &v : t.vertices) points.push_back(v.point);
    expect_nearest<D>(mesh, points, random);
}

TEST(Nearest, OfMeshesThatAreNotDelaunay) {
    expect_nearest_of_loaded<2>();
    expect_nearest_of_loaded<3>();
}

// With fixed edges neighbours need not be near; some of these have none flipped.
TEST(Nearest, OfConstrainedMeshes) {
    Random random(6);
    for (const PointSet<2> &set : point_sets<2>()) {
        SCOPED_TRACE(set.name);
        auto points = set.points(random);
        if (points.size() > 200) points.resize(200);
        for (Point<2> &p : points)
            for (double &x : p) x += 0.0;
        for (const int draws : {0, 2000}) {
            Mesh mesh(0);
            ASSERT_EQ(mesh.stage(number(points)), ABACUS_OK);
            ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.message;
            if (mesh.header.facts.census.simplices == 0) continue;
            flip_edges(mesh, draws, 7);
            call_constrained(mesh);
            expect_nearest<2>(mesh, points, random);
        }
    }
}

TEST(Nearest, ReadsFewPagesOfConstrainedMeshes) {
    Mesh mesh(0, ample);
    ASSERT_EQ(mesh.stage(number(unit_square_points(100000, 4))), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    call_constrained(mesh);
    const Host host = mesh.host.host();
    Random random(5);
    for (int i = 0; i < 20; ++i) {
        Reader<2> reader(host, mesh.header.facts, ample);
        ASSERT_EQ(nearest<2>(reader, {unit(random), unit(random)}, 50).size(), 50u);
        EXPECT_LE(reader.pages_read(), 12u) << "of " << mesh.host.pages.size();
        Reader<2> from_far(host, mesh.header.facts, ample);
        ASSERT_EQ(nearest<2>(from_far, {3 + unit(random), 9 * unit(random) - 4}, 5).size(), 5u);
        EXPECT_LE(from_far.pages_read(), 60u) << "of " << mesh.host.pages.size();
    }
}

TEST(Nearest, HasIdsAndAttributes) {
    Mesh mesh(2);
    ASSERT_EQ(mesh.stage({{7, {0, 0}, {1, 2}}, {8, {4, 0}, {3, 4}}, {9, {0, 4}, {5, 6}}}),
              ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    const Host host = mesh.host.host();
    Reader<2> reader(host, mesh.header, ample);
    std::vector<std::vector<double>> found;
    Nearest<2>(reader).find({3, -1}, 2, [&](const std::uint64_t *record) {
        const double *attributes = record_attributes<2>(record);
        found.push_back({static_cast<double>(record_id(record)), attributes[0], attributes[1]});
    });
    EXPECT_EQ(found, (std::vector<std::vector<double>>{{8, 3, 4}, {7, 1, 2}}));
    EXPECT_TRUE(nearest<2>(reader, {0, 0}, 0).empty());
}

TEST(Nearest, ReadsFewPages) {
    Mesh mesh(0, ample);
    ASSERT_EQ(mesh.stage(number(unit_square_points(100000, 4))), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    const Host host = mesh.host.host();
    Random random(5);
    for (int i = 0; i < 20; ++i) {
        Reader<2> reader(host, mesh.header, ample);
        ASSERT_EQ(nearest<2>(reader, {unit(random), unit(random)}, 50).size(), 50u);
        EXPECT_LE(reader.pages_read(), 12u) << "of " << mesh.host.pages.size();
    }
}

} // namespace
} // namespace abacus::test
