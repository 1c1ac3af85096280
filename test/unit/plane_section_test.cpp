// Sections of a mesh by a plane: sides compared with rational numbers, polygons with their convex
// hull.
#include "geometry/cutting_plane.hpp"
#include "query/lines/plane_section.hpp"
#include "support/large_mesh.hpp"
#include "support/point_sets.hpp"
#include "support/triangulations.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/convex_hull_2.h>

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace abacus::test {
namespace {

using Rational = CGAL::Exact_rational;

int rational_side(const Point<3> &through, const Point<3> &normal, const Point<3> &p) {
    Rational sum = 0;
    for (int i = 0; i < 3; ++i)
        sum += Rational(normal[i]) * (Rational(p[i]) - Rational(through[i]));
    return sum > 0 ? 1 : sum < 0 ? -1 : 0;
}

TEST(CuttingPlane, SidesAreThoseOfRationalNumbers) {
    Random random(3);
    for (const double size : {1.0, 0.1, 1e300, 1e-300, 5e-324}) {
        for (const double length : {1.0, 0.1, 1e300, 1e-300, 5e-324}) {
            int on = 0;
            for (int round = 0; round < 2000; ++round) {
                Point<3> through, normal, p;
                for (int i = 0; i < 3; ++i) {
                    through[i] = static_cast<double>(random() % 5) * size;
                    p[i] = static_cast<double>(random() % 5) * size;
                    normal[i] = (static_cast<double>(random() % 5) - 2) * length;
                }
                if (normal == Point<3>{}) continue;
                if (round % 3 == 0) p[round % 2] = std::nextafter(p[round % 2], 1e308);
                if (round % 7 == 0) normal[0] *= 1e-200; // small compared with the others
                if (round % 11 == 0) p[1] = 1e308;
                if (normal == Point<3>{}) continue;
                const CuttingPlane plane(through, normal);
                ASSERT_EQ(plane.side(p), rational_side(through, normal, p))
                    << testing::PrintToString(through) << testing::PrintToString(normal)
                    << testing::PrintToString(p);
                ASSERT_TRUE(std::isfinite(plane.height(p)));
                on += plane.side(p) == 0;
            }
            EXPECT_GT(on, 50) << size << ' ' << length;
        }
    }
}

abacus_section_query plane(const Point<3> &through, const Point<3> &normal) {
    abacus_section_query query{};
    std::copy_n(through.begin(), 3, query.through);
    std::copy_n(normal.begin(), 3, query.normal);
    query.attribute = -1;
    return query;
}

std::vector<abacus_polygon> section(MeshOf<3> &mesh, const abacus_section_query &query) {
    std::vector<abacus_polygon> polygons;
    abacus_sections *sections = nullptr;
    EXPECT_EQ(
        abacus_sections_open(mesh.host.table(), &mesh.header.facts, &query, &sections, &mesh.error),
        ABACUS_OK)
        << mesh.error.detail;
    abacus_polygon polygon;
    while (abacus_sections_next(sections, &polygon, &mesh.error) == ABACUS_OK)
        polygons.push_back(polygon);
    abacus_sections_close(sections);
    return polygons;
}

Point<3> corner(const abacus_polygon &p, int i) {
    return {p.point[i][0], p.point[i][1], p.point[i][2]};
}

/// A polygon in units of `size`, so that areas are neither too large nor too small for doubles.
abacus_polygon in_units(abacus_polygon p, double size) {
    for (auto &point : p.point)
        for (double &x : point) x /= size;
    return p;
}

double dot(const Point<3> &a, const Point<3> &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point<3> cross(const Point<3> &a, const Point<3> &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Point<3> minus(const Point<3> &a, const Point<3> &b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Point<3> unit_vector(const Point<3> &a) {
    const double length = std::hypot(a[0], a[1], a[2]);
    return {a[0] / length, a[1] / length, a[2] / length};
}

/// The area as seen from the direction of the normal: negative if the polygon is turned.
double area_of(const abacus_polygon &p, const Point<3> &normal) {
    double sum = 0;
    for (int i = 1; i + 1 < p.corners; ++i)
        sum += dot(normal,
                   cross(minus(corner(p, i), corner(p, 0)), minus(corner(p, i + 1), corner(p, 0))));
    return sum / 2;
}

/// The area of the convex hull of all corners.
double hull_area(const std::vector<abacus_polygon> &polygons, const Point<3> &normal) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    const Point<3> right = unit_vector(
        cross(normal, std::fabs(normal[0]) < 0.9 ? Point<3>{1, 0, 0} : Point<3>{0, 1, 0}));
    const Point<3> up = cross(normal, right);
    std::vector<Kernel::Point_2> flat, hull;
    for (const abacus_polygon &p : polygons)
        for (int i = 0; i < p.corners; ++i)
            flat.emplace_back(dot(corner(p, i), right), dot(corner(p, i), up));
    CGAL::convex_hull_2(flat.begin(), flat.end(), std::back_inserter(hull));
    double sum = 0;
    for (std::size_t i = 0; i < hull.size(); ++i) {
        const auto &a = hull[i], &b = hull[(i + 1) % hull.size()];
        sum += a.x() * b.y() - a.y() * b.x();
    }
    return sum / 2;
}

/// Sides of polygons that no other polygon has in the opposite direction.
std::map<std::pair<Point<3>, Point<3>>, int> rims(const std::vector<abacus_polygon> &polygons) {
    std::map<std::pair<Point<3>, Point<3>>, int> sides;
    for (const abacus_polygon &p : polygons)
        for (int i = 0; i < p.corners; ++i) {
            const Point<3> a = corner(p, i), b = corner(p, (i + 1) % p.corners);
            if (const auto back = sides.find({b, a}); back != sides.end())
                sides.erase(back);
            else
                ++sides[{a, b}];
        }
    return sides;
}

void build(MeshOf<3> &mesh, const std::vector<Point<3>> &points) {
    ASSERT_EQ(mesh.insert(number<3>(points)), ABACUS_OK) << mesh.error.detail;
}

class SectionOfPoints : public testing::TestWithParam<PointSet<3>> {};

TEST_P(SectionOfPoints, TilesItsHull) {
    Random random(2);
    std::vector<Point<3>> points = GetParam().points(random);
    if (points.size() > 2000) points.resize(2000);
    double size = 0;
    for (const Point<3> &p : points)
        for (const double x : p) size = std::max(size, std::fabs(x));
    MeshOf<3> mesh;
    build(mesh, points);
    if (mesh.header.facts.census.simplices == 0) return;
    for (int round = 0; round < 12; ++round) {
        Point<3> through = points[random() % points.size()];
        Point<3> normal{0, 0, 0};
        normal[round % 3] = round % 2 == 0 ? 3 : -0.1;
        if (round >= 3) normal[(round + 1) % 3] = 2; // across the diagonals of a grid
        if (round >= 6)
            for (double &x : normal) x = unit(random) - 0.5;
        auto polygons = section(mesh, plane(through, normal));
        // Unshared sides lie on the border of a convex set: one in each direction.
        for (const auto &[side, n] : rims(polygons)) EXPECT_EQ(n, 1);
        for (abacus_polygon &p : polygons) {
            for (int i = 0; i < p.corners; ++i) EXPECT_LE(corner(p, 0), corner(p, i));
            p = in_units(p, size);
        }
        for (double &x : through) x /= size;
        const Point<3> up = unit_vector(normal);
        const double rounding = 1e-12 + 1e-321 / size;
        double area = 0;
        for (const abacus_polygon &p : polygons) {
            const double part = area_of(p, up);
            EXPECT_GE(part, -rounding);
            area += part;
            for (int i = 0; i < p.corners; ++i) {
                EXPECT_NEAR(dot(up, minus(corner(p, i), through)), 0, rounding);
            }
        }
        EXPECT_NEAR(area, hull_area(polygons, up), 1e3 * rounding) << round;
    }
}

INSTANTIATE_TEST_SUITE_P(All, SectionOfPoints, testing::ValuesIn(point_sets<3>()),
                         [](const auto &info) { return std::string(info.param.name); });

std::vector<Point<3>> grid(int n) {
    std::vector<Point<3>> points;
    for (int i = 0; i < n * n * n; ++i)
        points.push_back({i % n + 0.0, i / n % n + 0.0, i / n / n + 0.0});
    return points;
}

TEST(PlaneSection, OfFacetsInThePlane) {
    MeshOf<3> mesh;
    build(mesh, grid(6));
    // Inside, at the bottom and at the top, from both sides: the whole square.
    for (const double z : {0.0, 2.0, 5.0})
        for (const double up : {1.0, -2.5}) {
            const Point<3> normal{0, 0, up > 0 ? 1.0 : -1.0};
            const auto polygons = section(mesh, plane({100, -7, z}, {0, 0, up}));
            double area = 0;
            for (const abacus_polygon &p : polygons) {
                EXPECT_EQ(p.corners, 3);
                area += area_of(p, normal);
                EXPECT_NEAR(area_of(p, normal), 0.5, 1e-12);
            }
            EXPECT_NEAR(area, 25, 1e-9) << z << ' ' << up;
        }
    for (const double z : {-0.1, 5.1})
        EXPECT_TRUE(section(mesh, plane({0, 0, z}, {0, 0, 1})).empty());
    // Along an edge of the cube: only that edge.
    EXPECT_TRUE(section(mesh, plane({0, 0, 0}, {1, 1, 0})).empty());
    EXPECT_TRUE(section(mesh, plane({5, 5, 5}, {1, 1, 1})).empty());
}

TEST(PlaneSection, ReadsThePagesOfThePlane) {
    Large<3> mesh(30000);
    const std::uint64_t before =
        mesh.host.calls.find + mesh.host.calls.next + mesh.host.calls.fetch;
    const auto polygons = section(mesh, plane({1e6, -1e6, 0.4}, {0, 0, 1}));
    const std::uint64_t read =
        mesh.host.calls.find + mesh.host.calls.next + mesh.host.calls.fetch - before;
    EXPECT_GT(polygons.size(), 1000u);
    EXPECT_LT(read, mesh.host.pages.size() / 2);
    EXPECT_NEAR(hull_area(polygons, {0, 0, 1}), 1, 0.02);
}

TEST(PlaneSection, OfALoadedMeshWithAHole) {
    Random random(9);
    std::vector<Point<3>> points;
    for (int i = 0; i < 1500; ++i) points.push_back({unit(random), unit(random), unit(random)});
    const Triangulation<3> ring = keeping<3>(delaunay<3>(points), [](const Point<3> &c) {
        return std::hypot(c[0] - 0.5, c[1] - 0.5) > 0.25;
    });
    MeshOf<3> mesh;
    ASSERT_EQ(mesh.load(ring.vertices, ring.simplices), ABACUS_OK) << mesh.error.detail;
    const auto polygons = section(mesh, plane({0.5, 0.5, 0.5}, {0.1, 0.2, 1}));
    std::size_t expected = 0;
    for (const abacus_simplex &s : mesh.simplices(false)) {
        int below = 0;
        for (const auto &c : s.corner)
            below += rational_side({0.5, 0.5, 0.5}, {0.1, 0.2, 1}, {c[0], c[1], c[2]}) < 0;
        expected += below > 0 && below < 4;
    }
    EXPECT_EQ(polygons.size(), expected);
    EXPECT_GT(polygons.size(), 100u);
}

TEST(PlaneSection, CarriesAnAttribute) {
    MeshOf<3> mesh(2);
    std::vector<InputOf<3>> input;
    for (const Point<3> &p : grid(4)) {
        const auto id = static_cast<std::int64_t>(input.size());
        input.push_back({id, p, {7, p[0] == 3 ? NAN : p[0] - 2 * p[2]}});
    }
    ASSERT_EQ(mesh.insert(input), ABACUS_OK);
    auto query = plane({1, 1.25, 1}, {1, 3, 0.5});
    query.attribute = 1;
    int missing = 0;
    for (const abacus_polygon &p : section(mesh, query))
        for (int i = 0; i < p.corners; ++i) {
            if (std::isnan(p.value[i]))
                ++missing;
            else
                EXPECT_NEAR(p.value[i], p.point[i][0] - 2 * p.point[i][2], 1e-12);
        }
    EXPECT_GT(missing, 0);
    query.attribute = -1;
    for (const abacus_polygon &p : section(mesh, query)) EXPECT_TRUE(std::isnan(p.value[0]));
    query.extent.max_edge = 1.1; // the sides of the grid's cells, and no diagonal
    EXPECT_TRUE(section(mesh, query).empty());
}

} // namespace
} // namespace abacus::test
