// Profiles and lines of sight: compared with brute force in rational numbers, and identities.
#include "geometry/distance.hpp"
#include "query/lines/profile.hpp"
#include "query/lines/sight.hpp"
#include "support/point_sets.hpp"
#include "support/triangulations.hpp"

#include <CGAL/Exact_rational.h>

#include <gtest/gtest.h>

#include <map>

namespace abacus::test {
namespace {

using Rational = CGAL::Exact_rational;
constexpr std::size_t ample = 64 << 20;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

template <int D> struct Row {
    double distance;
    Point<D> place;
    double value;
};

template <int D> std::vector<Row<D>> profile(Reader<D> &reader, const std::vector<Point<D>> &path) {
    std::vector<Row<D>> rows;
    Profile<D>(reader, 0, [&](double distance, const Point<D> &place, double value) {
        rows.push_back({distance, place, value});
    }).along(path.size(), [&](std::size_t i) { return path[i]; });
    return rows;
}

template <int D> double linear(const Point<D> &p) {
    double sum = 1;
    for (int i = 0; i < D; ++i) sum += (i + 2) * p[i];
    return sum;
}

template <int D> std::vector<InputOf<D>> with_heights(const std::vector<Point<D>> &points) {
    std::vector<InputOf<D>> input;
    for (std::size_t i = 0; i < points.size(); ++i)
        input.push_back({static_cast<std::int64_t>(i), points[i], {linear<D>(points[i])}});
    return input;
}

template <int D> void expect_linear_profile() {
    Random random(1);
    std::vector<Point<D>> points(D == 2 ? 2000 : 600);
    for (auto &p : points)
        for (double &x : p) x = unit(random);
    MeshOf<D> mesh(1);
    ASSERT_EQ(mesh.insert(with_heights<D>(points)), ABACUS_OK);
    const Host host = mesh.host.host();
    Reader<D> reader(host, mesh.header, ample);
    std::size_t inside = 0;
    for (int round = 0; round < 50; ++round) {
        std::vector<Point<D>> path(4);
        for (auto &p : path)
            for (double &x : p) x = 1.4 * unit(random) - 0.2;
        path[1] = points[static_cast<std::size_t>(round)];
        path[2] = path[1]; // skipped
        double before = 0;
        for (const Row<D> &row : profile<D>(reader, path)) {
            ASSERT_LE(before, row.distance);
            before = row.distance;
            if (std::isnan(row.value)) continue;
            ++inside;
            ASSERT_NEAR(row.value, linear<D>(row.place), 1e-11);
        }
        double length =
            abacus::distance<D>(path[0], path[1]) + abacus::distance<D>(path[2], path[3]);
        ASSERT_NEAR(before, length, 1e-12);
    }
    EXPECT_GT(inside, 1000u);
}

TEST(Profile, ReproducesLinearFunctions) {
    expect_linear_profile<2>();
    expect_linear_profile<3>();
}

std::vector<Point<2>> grid(int n) {
    std::vector<Point<2>> points;
    for (int i = 0; i < n * n; ++i)
        points.push_back({static_cast<double>(i % n), static_cast<double>(i / n)});
    return points;
}

struct Rows {
    std::vector<double> distances, values; // nan as -1
};
Rows rows_of(Reader<2> &reader, const std::vector<Point<2>> &path) {
    Rows rows;
    for (const Row<2> &row : profile<2>(reader, path)) {
        rows.distances.push_back(row.distance);
        rows.values.push_back(std::isnan(row.value) ? -1 : row.value);
    }
    return rows;
}

TEST(Profile, HasARowAtEachVertexAlongAnEdge) {
    Mesh mesh(1);
    ASSERT_EQ(mesh.insert(with_heights<2>(grid(5))), ABACUS_OK);
    const Host host = mesh.host.host();
    Reader<2> reader(host, mesh.header, ample);
    for (const double y : {0.0, 2.0, 4.0}) { // also the border
        const Rows rows = rows_of(reader, {{-1, y}, {5, y}});
        EXPECT_EQ(rows.distances, (std::vector<double>{0, 1, 1, 2, 3, 4, 5, 5, 6}));
        EXPECT_EQ(rows.values, (std::vector<double>{-1, -1, 1 + 3 * y, 3 + 3 * y, 5 + 3 * y,
                                                    7 + 3 * y, 9 + 3 * y, -1, -1}));
    }
}

TEST(Profile, HasGapsWhereTheMeshHas) {
    auto t = keeping<2>(delaunay<2>(grid(7)), [](const Point<2> &c) { // a ring
        return std::max(std::abs(c[0] - 3), std::abs(c[1] - 3)) > 1;
    });
    for (auto &v : t.vertices) v.attributes = {linear<2>(v.point)};
    Mesh mesh(1);
    ASSERT_EQ(mesh.load(t.vertices, t.simplices), ABACUS_OK) << mesh.error.message;
    const Host host = mesh.host.host();
    Reader<2> reader(host, mesh.header, ample);
    const Rows rows = rows_of(reader, {{0, 3}, {6, 3}});
    EXPECT_EQ(rows.distances, (std::vector<double>{0, 1, 2, 2, 4, 4, 5, 6}));
    EXPECT_EQ(rows.values, (std::vector<double>{10, 12, 14, -1, -1, 18, 20, 22}));
    // Along the corners of the path, in the hole and out of the mesh.
    const Rows bent = rows_of(reader, {{0, 3}, {3, 3}, {3, 8}});
    EXPECT_EQ(bent.distances, (std::vector<double>{0, 1, 2, 2, 3, 4, 4, 5, 6, 6, 8}));
    EXPECT_EQ(bent.values, (std::vector<double>{10, 12, 14, -1, -1, -1, 19, 22, 25, -1, -1}));
}

// ---- Lines of sight --------------------------------------------------------------------

struct Terrain {
    explicit Terrain(const std::vector<Point<2>> &points, const std::vector<double> &heights)
        : mesh(1) {
        std::vector<Input> input;
        for (std::size_t i = 0; i < points.size(); ++i)
            input.push_back({static_cast<std::int64_t>(i), points[i], {heights[i]}});
        EXPECT_EQ(mesh.insert(input), ABACUS_OK);
        for (std::size_t i = 0; i < points.size(); ++i) height[points[i]] = heights[i];
        all = mesh.simplices(false);
    }
    Mesh mesh;
    std::map<Point<2>, double> height;
    std::vector<abacus_simplex> all;
};

Rational cross(const std::array<Rational, 2> &a, const std::array<Rational, 2> &b) {
    return a[0] * b[1] - a[1] * b[0];
}
std::array<Rational, 2> between(const Point<2> &a, const Point<2> &b) {
    return {Rational(b[0]) - Rational(a[0]), Rational(b[1]) - Rational(a[1])};
}

/// The exact ground, searched in all triangles.
std::optional<Rational> ground(const Terrain &terrain, const Point<2> &p) {
    for (const abacus_simplex &s : terrain.all) {
        Rational sum = 0, whole = 0;
        bool is_inside = true;
        for (int i = 0; i < 3; ++i) {
            const Point<2> a{s.corner[(i + 1) % 3][0], s.corner[(i + 1) % 3][1]},
                b{s.corner[(i + 2) % 3][0], s.corner[(i + 2) % 3][1]};
            const Rational weight = cross(between(p, a), between(p, b));
            is_inside = is_inside && weight >= 0;
            sum += weight * Rational(terrain.height.at({s.corner[i][0], s.corner[i][1]}));
            whole += weight;
        }
        if (is_inside) return sum / whole;
    }
    return std::nullopt;
}

/// Whether the ground is nowhere above the line: at its ends, and where it crosses an edge.
bool is_free(const Terrain &terrain, const Point<2> &a, const Rational &za, const Point<2> &b,
             const Rational &zb) {
    if (const auto here = ground(terrain, a); here && *here > za) return false;
    if (const auto here = ground(terrain, b); here && *here > zb) return false;
    const auto d = between(a, b);
    for (const abacus_simplex &s : terrain.all)
        for (int i = 0; i < 3; ++i) {
            const Point<2> p{s.corner[i][0], s.corner[i][1]},
                q{s.corner[(i + 1) % 3][0], s.corner[(i + 1) % 3][1]};
            const Rational at_p = cross(d, between(a, p)), at_q = cross(d, between(a, q));
            const auto check = [&](const Rational &w) { // at p + w (q - p)
                const Rational hp = terrain.height.at(p), hq = terrain.height.at(q);
                const int k = abs(d[0]) > abs(d[1]) ? 0 : 1;
                const Rational along = (between(a, p)[k] + w * between(p, q)[k]) / d[k];
                return along <= 0 || along >= 1 || hp + w * (hq - hp) <= za + along * (zb - za);
            };
            if (at_p == 0 && !check(0)) return false;
            if (at_q == 0 && !check(1)) return false;
            if (CGAL::sign(at_p) * CGAL::sign(at_q) < 0 && !check(at_p / (at_p - at_q)))
                return false;
        }
    return true;
}

TEST(Sight, EqualsBruteForce) {
    Random random(3);
    for (const bool is_grid : {true, false}) {
        std::vector<Point<2>> points = grid(8);
        std::vector<double> heights;
        for (Point<2> &p : points) {
            if (!is_grid) p = {8 * unit(random), 8 * unit(random)};
            // On the lattice many lines touch the ground.
            heights.push_back(is_grid ? static_cast<double>(random() % 3) : unit(random));
        }
        Terrain terrain(points, heights);
        const Host host = terrain.mesh.host.host();
        Reader<2> reader(host, terrain.mesh.header, ample);
        int counts[3] = {};
        for (int round = 0; round < 400; ++round) {
            abacus_sight_end ends[2];
            for (auto &end : ends) {
                for (double &x : end.place) {
                    x = 7 * unit(random);
                    if (round % 3 != 0) x = std::round(2 * x) / 2;
                    if (round % 10 == 0) x = 12 * x - 4;
                }
                end.stands = random() % 2 == 0;
                end.height = static_cast<double>(random() % 3) / (round % 2 == 0 ? 2 : 3);
            }
            const abacus_sight sight = look(reader, 0, ends[0], ends[1]);
            ++counts[sight.kind];
            std::optional<Rational> z[2];
            Point<2> at[2];
            for (int i = 0; i < 2; ++i) {
                at[i] = {ends[i].place[0], ends[i].place[1]};
                z[i] = Rational(ends[i].height);
                if (!ends[i].stands) continue;
                const auto here = ground(terrain, at[i]);
                z[i] = here ? std::optional<Rational>(*here + *z[i]) : std::nullopt;
            }
            if (!z[0] || !z[1]) {
                ASSERT_EQ(sight.kind, ABACUS_SIGHT_UNKNOWN);
                continue;
            }
            if (at[0] == at[1]) continue;
            ASSERT_EQ(sight.kind == ABACUS_SIGHT_FREE, is_free(terrain, at[0], *z[0], at[1], *z[1]))
                << round;
            if (sight.kind == ABACUS_SIGHT_FREE) continue;
            // Up to the place where it is blocked, it is free.
            const Point<2> to{sight.place[0], sight.place[1]};
            const double part = abacus::distance<2>(at[0], to) / abacus::distance<2>(at[0], at[1]);
            if (part < 1e-9) continue;
            const double shorter = part * (1 - 1e-9);
            const Point<2> before{at[0][0] + shorter * (at[1][0] - at[0][0]),
                                  at[0][1] + shorter * (at[1][1] - at[0][1])};
            const Rational z_before = *z[0] + Rational(shorter) * (*z[1] - *z[0]);
            ASSERT_TRUE(
                is_free(terrain, at[0], *z[0] + Rational(1e-9), before, z_before + Rational(1e-9)))
                << round;
        }
        EXPECT_GT(counts[ABACUS_SIGHT_FREE], 30);
        EXPECT_GT(counts[ABACUS_SIGHT_BLOCKED], 30);
    }
}

TEST(Sight, AlongASlopeTouchesIt) {
    std::vector<Point<2>> points;
    std::vector<double> heights;
    Random random(4);
    for (int i = 0; i < 300; ++i) {
        const double x = static_cast<double>(random() % 1000) / 8,
                     y = static_cast<double>(random() % 1000) / 8;
        points.push_back({x, y});
        heights.push_back(3 * x - y / 2); // exact
    }
    Terrain terrain(points, heights);
    const Host host = terrain.mesh.host.host();
    Reader<2> reader(host, terrain.mesh.header, ample);
    for (int i = 0; i < 200; ++i) {
        abacus_sight_end a{{20 + 80 * unit(random), 20 + 80 * unit(random)}, 1, 0}, b = a;
        b.place[0] = 20 + 80 * unit(random);
        EXPECT_EQ(look(reader, 0, a, b).kind, ABACUS_SIGHT_FREE);
        b.height = -1e-9;
        EXPECT_EQ(look(reader, 0, a, b).kind, ABACUS_SIGHT_BLOCKED);
    }
}

/// Heights are compared exactly, however small or great they are.
TEST(Sight, AtTheLimitsOfDoubles) {
    constexpr double least = std::numeric_limits<double>::denorm_min();
    for (const double unit : {least, 0x1p-1060, 0x1p-1022, 1.0, 0x1p1021}) {
        Terrain terrain({{0, 0}, {2, 0}, {0, 2}, {2, 2}}, {3 * unit, 3 * unit, 0, unit});
        const Host host = terrain.mesh.host.host();
        Reader<2> reader(host, terrain.mesh.header, ample);
        abacus_sight_end a{{1, 2}, 1, 0}, b{{1, 0.5}, 1, 0};
        EXPECT_EQ(look(reader, 0, a, b).kind, ABACUS_SIGHT_FREE) << unit;
        EXPECT_EQ(look(reader, 0, b, a).kind, ABACUS_SIGHT_FREE) << unit;
        b.height = -unit;
        EXPECT_EQ(look(reader, 0, a, b).kind, ABACUS_SIGHT_BLOCKED) << unit;
    }
}

TEST(Sight, WithoutGroundNothingBlocks) {
    Terrain terrain({{0, 0}, {4, 0}, {0, 4}, {4, 4}, {2, 2}}, {0, 0, 0, 0, nan});
    const Host host = terrain.mesh.host.host();
    Reader<2> reader(host, terrain.mesh.header, ample);
    const auto kind = [&](abacus_sight_end a, abacus_sight_end b) {
        return look(reader, 0, a, b).kind;
    };
    EXPECT_EQ(kind({{1, 2}, 1, 0}, {{3, 2}, 0, -5}), ABACUS_SIGHT_UNKNOWN);
    EXPECT_EQ(kind({{1, 2}, 0, -5}, {{3, 2}, 0, -5}), ABACUS_SIGHT_FREE);
    EXPECT_EQ(kind({{-1, 2}, 0, 5}, {{5, 2}, 0, 5}), ABACUS_SIGHT_FREE);
    EXPECT_EQ(kind({{-1, 2}, 0, -5}, {{5, 2}, 0, -5}), ABACUS_SIGHT_BLOCKED);
    EXPECT_EQ(kind({{-1, -1}, 0, -5}, {{-1, 5}, 0, -5}), ABACUS_SIGHT_FREE);
    EXPECT_EQ(kind({{2, 0}, 0, 5}, {{2, 0}, 0, 1}), ABACUS_SIGHT_FREE); // straight down
    EXPECT_EQ(kind({{2, 0}, 0, 5}, {{2, 0}, 0, -1}), ABACUS_SIGHT_BLOCKED);
    EXPECT_EQ(kind({{2, 0}, 0, -1}, {{2, 0}, 0, 5}), ABACUS_SIGHT_BLOCKED);
}

} // namespace
} // namespace abacus::test
