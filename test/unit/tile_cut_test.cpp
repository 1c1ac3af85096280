// Triangles cut at the borders of tiles: the parts cover the triangle, and what two boxes have on a
// border of both is the same to the last bit, also where triangles touch borders or their
// crossings.
#include "tiles/tile_cut.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>
#include <vector>

namespace abacus::test {
namespace {

using Triangle = std::array<Point<3>, 3>;

double height_at(double x, double y) { return 100 + 3 * x - 2 * y; }

Triangle triangle_of(Point<2> a, Point<2> b, Point<2> c) {
    if ((b[0] - a[0]) * (c[1] - a[1]) < (b[1] - a[1]) * (c[0] - a[0])) std::swap(b, c);
    Triangle triangle;
    const Point<2> corners[] = {a, b, c};
    for (int i = 0; i < 3; ++i)
        triangle[i] = {corners[i][0], corners[i][1], height_at(corners[i][0], corners[i][1])};
    return triangle;
}

template <class Corners> double area_of(const Corners &corners) {
    double twice = 0;
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        twice += (corners[i][0] - corners[0][0]) * (corners[i + 1][1] - corners[0][1]) -
                 (corners[i][1] - corners[0][1]) * (corners[i + 1][0] - corners[0][0]);
    return twice / 2;
}

std::vector<CutCorner> part_of(const Triangle &triangle, const Box<2> &box) {
    TileCut cut(box);
    const auto part = cut.cut(triangle);
    return {part.begin(), part.end()};
}

double area_of_part(const std::vector<CutCorner> &part) {
    std::vector<Point<2>> corners;
    for (const CutCorner &corner : part) corners.push_back(corner.at);
    return area_of(corners);
}

/// The places and heights of a part on one border.
std::set<std::array<double, 3>> on(const std::vector<CutCorner> &part, TileBorder border) {
    std::set<std::array<double, 3>> found;
    for (const CutCorner &corner : part)
        if ((corner.borders & border) != 0)
            found.insert({corner.at[0], corner.at[1], corner.height});
    return found;
}

constexpr int tiles = 4; // along each axis; the triangle's coordinates are from 0 to `tiles`

void check_cuts(const Triangle &triangle) {
    std::map<std::pair<int, int>, std::vector<CutCorner>> parts;
    double sum = 0;
    for (int x = 0; x < tiles; ++x)
        for (int y = 0; y < tiles; ++y) {
            const Box<2> box{{x + 0.0, y + 0.0}, {x + 1.0, y + 1.0}};
            const auto part = part_of(triangle, box);
            for (const CutCorner &corner : part) {
                EXPECT_TRUE(box.contains(corner.at));
                EXPECT_EQ((corner.borders & west_border) != 0 && corner.at[0] != box.lower[0], 0);
                EXPECT_EQ((corner.borders & east_border) != 0 && corner.at[0] != box.upper[0], 0);
                EXPECT_EQ((corner.borders & south_border) != 0 && corner.at[1] != box.lower[1], 0);
                EXPECT_EQ((corner.borders & north_border) != 0 && corner.at[1] != box.upper[1], 0);
                EXPECT_NEAR(corner.height, height_at(corner.at[0], corner.at[1]), 1e-12);
            }
            EXPECT_GE(area_of_part(part), -1e-15);
            sum += area_of_part(part);
            parts[{x, y}] = part;
        }
    std::vector<Point<2>> whole;
    for (const Point<3> &corner : triangle) whole.push_back({corner[0], corner[1]});
    EXPECT_NEAR(sum, area_of(whole), 1e-13);
    for (int x = 0; x < tiles; ++x)
        for (int y = 0; y < tiles; ++y) {
            // A part may be a single place, where another box has nothing else either.
            if (x + 1 < tiles) {
                EXPECT_EQ(on(parts[{x, y}], east_border), on(parts[{x + 1, y}], west_border));
            }
            if (y + 1 < tiles) {
                EXPECT_EQ(on(parts[{x, y}], north_border), on(parts[{x, y + 1}], south_border));
            }
        }
}

TEST(TileCut, PartsOfRandomTrianglesFit) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> place(0, tiles);
    const auto point = [&] { return Point<2>{place(random), place(random)}; };
    for (int round = 0; round < 2000; ++round) check_cuts(triangle_of(point(), point(), point()));
}

TEST(TileCut, PartsOfTrianglesOnBordersFit) {
    std::mt19937_64 random(2);
    std::uniform_int_distribution<int> place(0, 2 * tiles); // halves: corners, borders, diagonals
    const auto point = [&] { return Point<2>{place(random) / 2.0, place(random) / 2.0}; };
    for (int round = 0; round < 5000; ++round) {
        const Point<2> a = point(), b = point(), c = point();
        if ((b[0] - a[0]) * (c[1] - a[1]) == (b[1] - a[1]) * (c[0] - a[0])) continue;
        check_cuts(triangle_of(a, b, c));
    }
}

TEST(TileCut, PartsOfSliversThroughCrossingsFit) {
    std::mt19937_64 random(3);
    std::uniform_int_distribution<int> step(-3, 3);
    for (int round = 0; round < 2000; ++round) {
        // Edges that pass a crossing of borders within a few steps of the last bit
        const auto near = [&](double x) {
            const int steps = step(random);
            for (int i = 0; i < std::abs(steps); ++i)
                x = std::nextafter(x, steps < 0 ? -INFINITY : INFINITY);
            return x;
        };
        const Point<2> a{near(0.5), near(0.5)}, b{near(3.5), near(3.5)}, c{0.25, 3.75};
        check_cuts(triangle_of(a, b, c));
    }
}

TEST(TileCut, TheFirstCornerDoesNotMatter) {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> place(0, 3);
    for (int round = 0; round < 500; ++round) {
        const auto point = [&] { return Point<2>{place(random), place(random)}; };
        Triangle triangle = triangle_of(point(), point(), point());
        const Box<2> box{{1, 1}, {2, 2}};
        const auto places = [&] {
            std::set<std::array<double, 3>> found;
            for (const CutCorner &corner : part_of(triangle, box))
                found.insert({corner.at[0], corner.at[1], corner.height});
            return found;
        };
        const auto first = places();
        for (int turn = 0; turn < 2; ++turn) {
            std::rotate(triangle.begin(), triangle.begin() + 1, triangle.end());
            EXPECT_EQ(places(), first);
        }
    }
}

TEST(TileCut, CoordinatesMayBeAsLargeAsDoubles) {
    const double vast = 1.7e308;
    const Triangle triangle{{{-vast, -vast, 0}, {vast, -vast, 10}, {-vast, vast, 20}}};
    const auto part = part_of(triangle, {{-8, -8}, {-4, -4}});
    ASSERT_EQ(part.size(), 4u);
    EXPECT_EQ(area_of_part(part), 16);
    for (const CutCorner &corner : part) EXPECT_NEAR(corner.height, 15, 1e-12);
}

TEST(TileCut, AFlatBoxIsABorder) {
    const Triangle triangle = triangle_of({0, 0}, {4, 0}, {0, 4});
    const auto line = part_of(triangle, {{1, 0}, {1, 4}});
    std::set<double> ends;
    for (const CutCorner &corner : line) {
        EXPECT_EQ(corner.at[0], 1);
        ends.insert(corner.at[1]);
    }
    EXPECT_EQ(ends, (std::set<double>{0, 3}));
    EXPECT_TRUE(part_of(triangle, {{5, 5}, {6, 6}}).size() < 3);
}

} // namespace
} // namespace abacus::test
