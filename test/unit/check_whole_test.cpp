// abacus_check on meshes that are sound across every facet, but overlap themselves. No insertion
// makes them, so they are built by hand.
#include "support/mesh_in_change.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

namespace abacus::test {
namespace {

template <int D> using Vertices = std::array<int, D + 1>;

/// The faults of a mesh of these simplices, given by points in positive order, with a ghost on
/// every facet that belongs to only one of them.
template <int D>
std::vector<std::string> faults(const std::vector<Point<D>> &points,
                                const std::vector<Vertices<D>> &simplices) {
    MeshInChange<D> mesh(box_around<D>(points), 64 << 20);
    std::vector<VertexIndex> vertices;
    for (const Point<D> &p : points)
        vertices.push_back(mesh.cache.create_vertex(p, std::int64_t(vertices.size()), nullptr));

    std::map<std::array<VertexIndex, D>, std::vector<Link>> facets;
    const auto create = [&](const std::array<VertexIndex, D + 1> &corners) {
        const Handle h = mesh.cache.create(corners);
        for (int i = 0; i <= D; ++i)
            facets[FacetVertices<D, VertexIndex>(corners, i).vertex].push_back(make_link(h, i));
    };
    mesh.cache.create_first_block();
    for (const Vertices<D> &s : simplices) {
        std::array<VertexIndex, D + 1> corners;
        for (int i = 0; i <= D; ++i) corners[i] = vertices[s[i]];
        create(corners);
    }
    std::vector<Link> hull;
    for (const auto &[facet, links] : facets)
        if (links.size() == 1) hull.push_back(links[0]);
    for (const Link link : hull)
        create(ghost_on(mesh.cache.simplex(link_simplex(link)).vertex,
                        static_cast<std::size_t>(link_facet(link)), infinite_vertex));
    for (const auto &[facet, links] : facets) {
        EXPECT_EQ(links.size(), 2u);
        mesh.cache.connect(links.at(0), links.at(1));
    }
    mesh.delaunay.count(std::int64_t(simplices.size()), std::int64_t(hull.size()));
    return mesh.check(points.size());
}

constexpr const char *in_pieces = "overlap: The mesh is in more than one piece.";
constexpr const char *two_stars = "overlap: A vertex has two separate stars.";
constexpr const char *wound = "overlap: Simplices wind around a vertex or an edge twice.";
using Faults = std::vector<std::string>;

/// Corner i of a regular pentagon.
Point<2> corner(int i) {
    const double angle = 0.1 + i * 2 * std::numbers::pi / 5;
    return {std::cos(angle), std::sin(angle)};
}

TEST(CheckWhole, FindsNothingInMeshesThatAreSound) {
    EXPECT_EQ(faults<2>({{0, 0}, {1, 0}, {0, 1}}, {{0, 1, 2}}), Faults{});
    EXPECT_EQ(faults<3>({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}), Faults{});
    std::vector<Point<2>> points{{0, 0}};
    std::vector<Vertices<2>> triangles;
    std::vector<Point<3>> spindle{{0, 0, -0.5}, {0, 0, 0.5}};
    std::vector<Vertices<3>> tetrahedra;
    for (int i = 0; i < 5; ++i) {
        points.push_back(corner(i));
        triangles.push_back({0, 1 + i, 1 + (i + 1) % 5});
        spindle.push_back({corner(i)[0], corner(i)[1], 0});
        tetrahedra.push_back({0, 1, 2 + i, 2 + (i + 1) % 5});
    }
    EXPECT_EQ(faults<2>(points, triangles), Faults{});
    EXPECT_EQ(faults<3>(spindle, tetrahedra), Faults{});
}

TEST(CheckWhole, FindsTrianglesThatWindTwiceAroundAVertex) {
    std::vector<Point<2>> points{{0, 0}};
    std::vector<Vertices<2>> triangles;
    for (int i = 0; i < 5; ++i) {
        points.push_back(corner(i));
        triangles.push_back({0, 1 + i, 1 + (i + 2) % 5});
    }
    EXPECT_EQ(faults<2>(points, triangles), Faults{wound});
}

TEST(CheckWhole, FindsTetrahedraThatWindTwiceAroundAnEdge) {
    std::vector<Point<3>> points{{0, 0, -0.5}, {0, 0, 0.5}};
    std::vector<Vertices<3>> tetrahedra;
    for (int i = 0; i < 5; ++i) {
        points.push_back({corner(i)[0], corner(i)[1], 0});
        tetrahedra.push_back({0, 1, 2 + i, 2 + (i + 2) % 5});
    }
    EXPECT_EQ(faults<3>(points, tetrahedra), Faults{wound});
}

TEST(CheckWhole, FindsAHullThatWindsMoreThanOnce) {
    // A fan of more than a full turn around a vertex, or edge, that lies on the hull.
    std::vector<Point<2>> points{{0, 0}};
    std::vector<Vertices<2>> triangles;
    std::vector<Point<3>> spindle{{0, 0, -0.5}, {0, 0, 0.5}};
    std::vector<Vertices<3>> tetrahedra;
    for (int i = 0; i < 7; ++i) {
        const Point<2> p = corner(i);
        const double further = 1 + 0.02 * i;
        points.push_back({p[0] * further, p[1] * further});
        spindle.push_back({p[0] * further, p[1] * further, 0});
        if (i == 6) break;
        triangles.push_back({0, i + 1, i + 2});
        tetrahedra.push_back({0, 1, i + 2, i + 3});
    }
    EXPECT_THAT(faults<2>(points, triangles), testing::Contains(wound));
    EXPECT_THAT(faults<3>(spindle, tetrahedra), testing::Contains(wound));
}

TEST(CheckWhole, LooksAlongAnyAxis) {
    // Edges along one axis are points in one of the projections, and in line in another.
    std::vector<Point<3>> grid;
    for (int i = 0; i < 64; ++i) grid.push_back({double(i % 4), double(i / 4 % 4), double(i / 16)});
    MeshInChange<3> mesh(box_around<3>(grid), 64 << 20);
    ASSERT_TRUE(mesh.build(grid));
    mesh.verify(grid);
    for (int axis = 0; axis < 3; ++axis)
        for (const int step : {1, 2}) {
            std::vector<Point<3>> spindle(2, Point<3>{});
            spindle[0][axis] = -0.5;
            spindle[1][axis] = 0.5;
            std::vector<Vertices<3>> tetrahedra;
            // Some corners lie straight above others, and above the ends.
            constexpr std::array<Point<2>, 5> star{
                {{1, 0}, {0.25, 1}, {-1, 0.5}, {-1, -0.5}, {0.25, -1}}};
            for (int i = 0; i < 5; ++i) {
                Point<3> p{};
                p[(axis + 1) % 3] = star[i][0];
                p[(axis + 2) % 3] = star[i][1];
                spindle.push_back(p);
                tetrahedra.push_back({0, 1, 2 + i, 2 + (i + step) % 5});
            }
            const Faults found = faults<3>(spindle, tetrahedra);
            if (step == 1)
                EXPECT_EQ(found, Faults{}) << axis;
            else
                EXPECT_THAT(found, testing::Contains(wound)) << axis;
        }
}

TEST(CheckWhole, FindsASecondPieceAroundTheSameVertexWhereEulersRelationHolds) {
    EXPECT_EQ(faults<2>({{0, 0}, {2, 0}, {-1, 2}, {-1, -2}, {-2, 0}, {1, -2}, {1, 2}},
                        {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {0, 4, 5}, {0, 5, 6}, {0, 6, 4}}),
              Faults{two_stars});
}

TEST(CheckWhole, FindsASecondPieceInSpace) {
    const std::vector<Point<3>> first{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const double distance : {0.25, 0.5, 3.0}) {
        std::vector<Point<3>> points = first;
        for (const Point<3> &p : first) points.push_back({p[0] + distance, p[1] - 0.1, p[2] + 0.1});
        EXPECT_EQ(faults<3>(points, {{0, 1, 2, 3}, {4, 5, 6, 7}}), Faults{in_pieces});
    }
    EXPECT_EQ(
        faults<3>({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
                  {{0, 1, 2, 3}, {0, 4, 6, 5}}),
        Faults{two_stars});
}

} // namespace
} // namespace abacus::test
