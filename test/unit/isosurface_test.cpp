// Isosurfaces, compared with brute force over all tetrahedra; and the properties of a surface:
// numbers, coordinates, closed, two triangles at an edge, one fan around a corner, one side.
#include "geometry/ball.hpp"
#include "support/large_mesh.hpp"
#include "support/oracle.hpp"
#include "support/point_sets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

namespace abacus::test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

using Field = std::function<double(const Point<3> &)>;
using Edge = std::pair<Point<3>, Point<3>>; // the lesser end first

struct Triangle {
    std::array<std::int64_t, 3> corner;
    std::array<Point<3>, 3> point;
    std::array<double, 3> value;
    bool operator<(const Triangle &other) const { return corner < other.corner; }
};

/// A mesh whose first attribute is a field, and the second a slope.
struct Solid : MeshOf<3> {
    Solid(const std::vector<Point<3>> &points, const Field &field) : MeshOf<3>(2) {
        std::vector<InputOf<3>> input;
        for (const Point<3> &p : points) {
            const auto id = static_cast<std::int64_t>(input.size());
            input.push_back({id, p, {field(p), carried(p)}});
            at.emplace(p, field(p));
        }
        EXPECT_EQ(insert(input), ABACUS_OK) << error.detail;
    }
    static double carried(const Point<3> &p) { return p[0] / 8 + p[1] / 4 + p[2] / 2; }

    abacus_isosurface_query query(double value) const {
        abacus_isosurface_query query{};
        query.value = value;
        query.carried = 1;
        return query;
    }
    std::vector<Triangle> surface(const abacus_isosurface_query &query,
                                  std::size_t memory = std::size_t{64} << 20) {
        std::vector<Triangle> triangles;
        const auto report = [](void *context, const abacus_surface_triangle *t) {
            Triangle triangle;
            for (int i = 0; i < 3; ++i) {
                triangle.corner[i] = t->corner[i];
                std::copy_n(t->point[i], 3, triangle.point[i].begin());
                triangle.value[i] = t->value[i];
            }
            static_cast<std::vector<Triangle> *>(context)->push_back(triangle);
            return ABACUS_HOST_OK;
        };
        EXPECT_EQ(abacus_isosurface(host.table(), &header.facts, &query, memory, report, &triangles,
                                    &error),
                  ABACUS_OK)
            << error.message;
        EXPECT_TRUE(host.spools.empty());
        return triangles;
    }

    std::map<Point<3>, double> at;
};

/// The expected triangles, by the edges of their corners, and the places of these.
struct Expected {
    std::map<Edge, std::int64_t> rank;
    std::multiset<std::set<Edge>> corners; // of each tetrahedron

    Expected(Solid &solid, const abacus_isosurface_query &query) {
        for (const abacus_simplex &s : solid.simplices(false)) {
            std::vector<Point<3>> below, above;
            bool is_wanted = true;
            for (const auto &corner : s.corner) {
                const Point<3> p{corner[0], corner[1], corner[2]};
                const double value = solid.at[p];
                is_wanted = is_wanted && std::isfinite(value);
                (value < query.value ? below : above).push_back(p);
                for (const auto &other : s.corner)
                    if (query.extent.max_edge > 0)
                        is_wanted = is_wanted && is_within<3>(query.extent.max_edge, p,
                                                              {other[0], other[1], other[2]});
            }
            if (!is_wanted || below.empty() || above.empty()) continue;
            std::set<Edge> edges;
            for (const Point<3> &b : below)
                for (const Point<3> &a : above) edges.insert(std::minmax(a, b));
            for (const Edge &edge : edges) rank[edge] = 0;
            corners.insert(edges);
        }
        std::int64_t number = 0;
        for (auto &[edge, n] : rank) n = number++;
    }
};

double size_of(const Point<3> &p) {
    return std::max({std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2])});
}

/// Compares with brute force: every corner, every tetrahedron.
void expect_all(Solid &solid, const abacus_isosurface_query &query,
                const std::vector<Triangle> &triangles) {
    const Expected expected(solid, query);
    std::vector<const Edge *> edge_of;
    for (const auto &[edge, number] : expected.rank) edge_of.push_back(&edge);
    std::size_t count = 0;
    for (const auto &edges : expected.corners) count += edges.size() == 4 ? 2 : 1;
    ASSERT_EQ(triangles.size(), count);
    std::map<std::int64_t, Point<3>> places;
    for (const Triangle &t : triangles) {
        EXPECT_LT(t.corner[0], std::min(t.corner[1], t.corner[2]));
        for (int i = 0; i < 3; ++i) {
            ASSERT_LT(t.corner[i], static_cast<std::int64_t>(edge_of.size()));
            ASSERT_EQ(places.emplace(t.corner[i], t.point[i]).first->second, t.point[i]);
            const auto &[a, b] = *edge_of[t.corner[i]];
            using Wide = long double; // no overflow or underflow
            const Wide share =
                (Wide(query.value) - solid.at[a]) / (Wide(solid.at[b]) - solid.at[a]);
            const Point<3> &p = t.point[i];
            for (int axis = 0; axis < 3; ++axis) {
                const Wide expected = a[axis] + share * (Wide(b[axis]) - a[axis]);
                const Wide size = std::fabs(Wide(a[axis])) + std::fabs(Wide(b[axis]));
                ASSERT_LE(std::fabs(p[axis] - expected), 1e-12 * size + 1e-323);
            }
            if (solid.at[a] == query.value) {
                ASSERT_EQ(t.point[i], a);
            }
            if (solid.at[b] == query.value) {
                ASSERT_EQ(t.point[i], b);
            }
            const double carried = Solid::carried(p);
            ASSERT_TRUE(std::fabs(t.value[i] - carried) <=
                        1e-11 * std::fabs(carried) + size_of(p) * 1e-11 + 1e-322);
        }
    }
    EXPECT_EQ(places.size(), expected.rank.size());
}

using Side = std::pair<std::int64_t, std::int64_t>;

/// How often each side occurs. Fails if one occurs twice in the same direction.
std::map<Side, int> sides(const std::vector<Triangle> &triangles) {
    std::map<Side, int> sides;
    for (const Triangle &t : triangles)
        for (int i = 0; i < 3; ++i) {
            const int seen = ++sides[{t.corner[i], t.corner[(i + 1) % 3]}];
            EXPECT_EQ(seen, 1);
        }
    return sides;
}

/// Counts the sides that belong to only one triangle.
std::size_t rims(const std::vector<Triangle> &triangles) {
    const auto all = sides(triangles);
    std::size_t rims = 0;
    for (const auto &[side, n] : all) rims += !all.contains({side.second, side.first});
    return rims;
}

/// Whether the triangles around each corner hang together across their sides.
bool is_manifold(const std::vector<Triangle> &triangles) {
    std::map<std::int64_t, std::map<std::int64_t, std::int64_t>> fans; // opposite sides
    for (const Triangle &t : triangles)
        for (int i = 0; i < 3; ++i)
            if (!fans[t.corner[i]].emplace(t.corner[(i + 1) % 3], t.corner[(i + 2) % 3]).second)
                return false;
    for (auto &[corner, fan] : fans) {
        // The path from the triangle that no other leads to; a cycle if there is none.
        std::set<std::int64_t> ends;
        for (const auto &[from, to] : fan) ends.insert(to);
        auto begin = fan.begin();
        for (auto it = fan.begin(); it != fan.end(); ++it)
            if (!ends.contains(it->first)) begin = it;
        std::size_t length = 0;
        for (auto it = begin; it != fan.end() && length < fan.size(); it = fan.find(it->second))
            ++length;
        if (length != fan.size()) return false;
    }
    return true;
}

double area_of(const Triangle &t) {
    Point<3> u, v;
    for (int i = 0; i < 3; ++i) {
        u[i] = t.point[1][i] - t.point[0][i];
        v[i] = t.point[2][i] - t.point[0][i];
    }
    return 0.5 * std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                            u[0] * v[1] - u[1] * v[0]);
}

/// Six times the volume inside; positive if normals point outwards.
double volume_of(const std::vector<Triangle> &triangles) {
    double sum = 0;
    for (const Triangle &t : triangles) {
        const auto &[a, b, c] = t.point;
        sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
               a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    return sum;
}

std::vector<Point<3>> some(const PointSet<3> &set, std::size_t most) {
    Random random(1);
    std::vector<Point<3>> points = set.points(random);
    if (points.size() > most) points.resize(most);
    return points;
}

class IsosurfaceOfPoints : public testing::TestWithParam<PointSet<3>> {};

TEST_P(IsosurfaceOfPoints, IsThatOfEveryTetrahedron) {
    const std::vector<Point<3>> points = some(GetParam(), 1500);
    // Only a few values, so that many vertices are on the surface.
    Random random(5);
    std::map<Point<3>, double> drawn;
    for (const Point<3> &p : points) drawn[p] = static_cast<double>(random() % 4);
    Solid solid(points, [&](const Point<3> &p) { return drawn[p]; });
    for (const double value : {1.0, 1.5}) {
        const std::vector<Triangle> triangles = solid.surface(solid.query(value));
        expect_all(solid, solid.query(value), triangles);
        sides(triangles);
        EXPECT_TRUE(is_manifold(triangles));
    }
}

INSTANTIATE_TEST_SUITE_P(All, IsosurfaceOfPoints, testing::ValuesIn(point_sets<3>()),
                         [](const auto &info) { return std::string(info.param.name); });

std::vector<Point<3>> in_a_cube(int n) {
    Random random(11);
    std::vector<Point<3>> points;
    for (int i = 0; i < n; ++i)
        points.push_back({2 * unit(random) - 1, 2 * unit(random) - 1, 2 * unit(random) - 1});
    for (int i = 0; i < 8; ++i)
        points.push_back({i & 1 ? 1. : -1., i & 2 ? 1. : -1., i & 4 ? 1. : -1.});
    return points;
}

double from_centre(const Point<3> &p) { return std::hypot(p[0], p[1], p[2]); }

TEST(Isosurface, OfASphereIsClosedAndNearlyIt) {
    Solid inside(in_a_cube(20000), [](const Point<3> &p) { return -from_centre(p); });
    const std::vector<Triangle> triangles = inside.surface(inside.query(-0.7));
    EXPECT_EQ(rims(triangles), 0u);
    EXPECT_TRUE(is_manifold(triangles));
    double area = 0;
    for (const Triangle &t : triangles) area += area_of(t);
    EXPECT_NEAR(area, 4 * M_PI * 0.49, 0.1);
    // Values are lower outside, so the surface is turned outwards.
    EXPECT_NEAR(volume_of(triangles) / 6, 4 / 3.0 * M_PI * 0.343, 0.02);
    Solid outside(in_a_cube(2000), from_centre);
    EXPECT_LT(volume_of(outside.surface(outside.query(0.7))), 0);
    // Euler's formula: corners - edges + triangles = 2.
    std::int64_t corners = 0;
    for (const Triangle &t : triangles)
        corners = std::max({corners, t.corner[1] + 1, t.corner[2] + 1});
    EXPECT_EQ(2 * corners - static_cast<std::int64_t>(triangles.size()), 4);
}

TEST(Isosurface, IsTheSameInLittleMemory) {
    Solid solid(in_a_cube(30000), from_centre);
    std::vector<Triangle> ample = solid.surface(solid.query(0.8));
    solid.host.peak_spools = 0;
    std::vector<Triangle> little = solid.surface(solid.query(0.8), 1);
    EXPECT_GT(solid.host.peak_spools, 6u); // some runs were merged
    std::sort(ample.begin(), ample.end());
    std::sort(little.begin(), little.end());
    ASSERT_EQ(ample.size(), little.size());
    for (std::size_t i = 0; i < ample.size(); ++i) {
        ASSERT_EQ(ample[i].corner, little[i].corner);
        ASSERT_EQ(ample[i].point, little[i].point);
        ASSERT_EQ(ample[i].value, little[i].value);
    }
}

TEST(Isosurface, DependsOnThePointsAlone) {
    std::vector<Point<3>> points = in_a_cube(3000);
    Solid one(points, from_centre);
    std::reverse(points.begin(), points.end());
    Solid other(points, from_centre);
    std::vector<Triangle> a = one.surface(one.query(0.6)), b = other.surface(other.query(0.6));
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].corner, b[i].corner);
        EXPECT_EQ(a[i].point, b[i].point);
    }
}

TEST(Isosurface, EndsWhereValuesAreMissing) {
    Solid solid(in_a_cube(3000), [](const Point<3> &p) { return p[2] > 0 ? from_centre(p) : nan; });
    const auto query = solid.query(0.6);
    const std::vector<Triangle> triangles = solid.surface(query);
    expect_all(solid, query, triangles);
    EXPECT_GT(rims(triangles), 10u);
    EXPECT_TRUE(is_manifold(triangles));
    Solid infinite(in_a_cube(100), [](const Point<3> &p) {
        return p[0] > 0 ? std::numeric_limits<double>::infinity() : p[0];
    });
    for (const Triangle &t : infinite.surface(infinite.query(-0.2)))
        for (const Point<3> &p : t.point) EXPECT_LT(p[0], 0);
}

TEST(Isosurface, LeavesOutLongEdgesAndWhatIsBesideAWindow) {
    Solid solid(in_a_cube(2000), from_centre);
    auto query = solid.query(0.9);
    const std::size_t all = solid.surface(query).size();
    query.extent.max_edge = 0.3;
    std::vector<Triangle> triangles = solid.surface(query);
    expect_all(solid, query, triangles);
    EXPECT_LT(triangles.size(), all);
    query.extent.max_edge = 0;
    query.window.kind = ABACUS_BOX_WINDOW;
    for (int i = 0; i < 3; ++i) {
        query.window.lower[i] = 0.4;
        query.window.upper[i] = 0.6;
    }
    const std::vector<Triangle> in_window = solid.surface(query);
    EXPECT_GT(in_window.size(), 10u);
    EXPECT_LT(in_window.size(), all / 10);
    EXPECT_TRUE(is_manifold(in_window));
    std::set<std::int64_t> numbers;
    for (const Triangle &t : in_window) numbers.insert(t.corner.begin(), t.corner.end());
    EXPECT_EQ(*numbers.rbegin(), static_cast<std::int64_t>(numbers.size()) - 1);
}

TEST(Isosurface, OfValuesOfAnyMagnitude) {
    for (const double unit : {1e308, 5e-324, 1e-310}) {
        Solid solid(in_a_cube(200), [&](const Point<3> &p) { return (p[0] > 0 ? 1 : -1) * unit; });
        auto query = solid.query(0);
        query.carried = 0;
        const auto triangles = solid.surface(query);
        EXPECT_GT(triangles.size(), 20u);
        for (const Triangle &t : triangles)
            for (int i = 0; i < 3; ++i) {
                EXPECT_LT(std::fabs(t.point[i][0]), 1);
                EXPECT_EQ(t.value[i], 0);
            }
    }
}

TEST(Isosurface, ReadsNoPageWithoutTheValue) {
    Solid solid(in_a_cube(30000), from_centre);
    EXPECT_TRUE(solid.surface(solid.query(50)).empty());
    EXPECT_TRUE(solid.surface(solid.query(-1)).empty());
    MeshOf<3> empty(1);
    abacus_isosurface_query query{};
    query.carried = -1;
    EXPECT_EQ(abacus_isosurface(empty.host.table(), &empty.header.facts, &query, 1, nullptr,
                                nullptr, &empty.error),
              ABACUS_OK);
    MeshOf<2> flat(1);
    EXPECT_EQ(abacus_isosurface(flat.host.table(), &flat.header.facts, &query, 1, nullptr, nullptr,
                                &flat.error),
              ABACUS_ERROR);
    EXPECT_EQ(flat.error.kind, ABACUS_ERROR_ARGUMENT);
}

} // namespace
} // namespace abacus::test
