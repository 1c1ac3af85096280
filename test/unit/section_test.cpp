// Plane sections of tetrahedral meshes: they tile the plane wherever it cuts, and have the right
// places and values.
#include "support/sections.hpp"

namespace abacus {
namespace {

// Area of the convex hull of points in the plane.
double hull_area(std::vector<Point<2>> points) {
    std::sort(points.begin(), points.end());
    double sum = 0;
    for (const int side : {1, -1}) { // lower chain, upper chain
        std::vector<Point<2>> chain;
        for (const Point<2> &p : points) {
            const auto turns_back = [&] {
                const Point<2> &a = chain[chain.size() - 2], &b = chain.back();
                return side * ((b[0] - a[0]) * (p[1] - a[1]) - (p[0] - a[0]) * (b[1] - a[1])) <= 0;
            };
            while (chain.size() > 1 && turns_back()) chain.pop_back();
            chain.push_back(p);
        }
        for (std::size_t i = 1; i < chain.size(); ++i)
            sum -= side * (chain[i][0] - chain[i - 1][0]) * (chain[i][1] + chain[i - 1][1]) / 2;
    }
    return sum;
}

TEST_F(Section, FillsTheHullOfRandomPoints) {
    build(full_cube(2500));
    ASSERT_GT(host.pages.size(), 20u);
    for (int axis = 0; axis < 3; ++axis) {
        Point<3> normal{0, 0, 0};
        for (const double at : {0.001, 0.37, 0.5, 0.93})
            for (const double sign : {-2.0, 1e-3}) {
                normal[axis] = sign;
                const Image image = draw(Order({at, at, at}, normal), drawing(61));
                EXPECT_EQ(image.height, 61);
                expect_full(image);
            }
    }
}

TEST_F(Section, FillsLayersOfAGrid) {
    // Through every layer of points, the faces of the hull included, and between them.
    for (const double step : {1.0, 0.1}) {
        build(cube(6, step));
        for (int axis = 0; axis < 3; ++axis)
            for (int layer = 0; layer <= 12; ++layer)
                for (const double sign : {-1.0, 1.0}) {
                    Point<3> normal{0, 0, 0}, through{0, 0, 0};
                    normal[axis] = sign;
                    // Not always numbers of a grid of 0.1: 0.3 is not 3 * 0.1.
                    through[axis] = step == 1 ? layer * 0.5 : layer / 20.0;
                    for (const double exaggeration : {-1.0, 1.0}) {
                        const Image image = draw(Order(through, normal, exaggeration), drawing(60));
                        EXPECT_EQ(image.height, 60);
                        expect_full(image);
                        EXPECT_NEAR(area(Order(through, normal, exaggeration)), 36 * step * step,
                                    1e-9);
                    }
                }
    }
}

TEST_F(Section, FillsDiagonalsOfAGrid) {
    build(cube(6));
    // Through rows of points, with edges and faces of cells and of their halves.
    for (const double sign : {-1.0, 1.0}) {
        const Image image = draw(Order({3, 3, 0}, {sign, sign, 0}), drawing(60));
        EXPECT_EQ(image.height, 42); // 60 / sqrt 2
        expect_full(image);
    }
    expect_full(draw(Order({2, 0, 2}, {1, 0, 1}), drawing(60)));
    expect_full(draw(Order({0, 2, 4}, {0, 1, -1}), drawing(60)));
    expect_full(draw(Order({0, 2, 4}, {0, 1, -2}), drawing(60)));
}

TEST_F(Section, FillsAnOctree) {
    build(octree());
    for (int axis = 0; axis < 3; ++axis)
        for (int layer = 0; layer <= 32; ++layer) {
            Point<3> normal{0, 0, 0};
            normal[axis] = 1;
            const Order order({layer / 2.0, layer / 2.0, layer / 2.0}, normal);
            expect_full(draw(order, drawing(64)));
            EXPECT_NEAR(area(order), 256, 1e-9);
        }
    expect_full(draw(Order({8, 8, 8}, {1, -1, 0}), drawing(64)));
}

TEST_F(Section, TilesTheHullOfAnyPoints) {
    std::mt19937_64 random(3);
    std::uniform_int_distribution<int> small(-3, 3);
    std::vector<Point<3>> blurred = cube(4); // nearly flat layers
    for (Point<3> &p : blurred)
        for (double &x : p) x += 1e-12 * small(random);
    for (const auto &input : {points<3>(Kind::uniform, 400), points<3>(Kind::grid, 400),
                              points<3>(Kind::heavy, 400), cube(5), octree(), blurred}) {
        build(input);
        double total = 0;
        for (int round = 0; round < 100; ++round) {
            // Through points, in directions that meet other points in a grid.
            const Point<3> normal{double(small(random)), double(small(random)),
                                  double(small(random))};
            if (normal == Point<3>{0, 0, 0}) continue;
            std::vector<Point<2>> corners;
            const double sum = area(Order(input[random() % input.size()], normal), &corners);
            const double hull = hull_area(corners);
            ASSERT_NEAR(sum, hull, 1e-9 * (1 + hull)) << round;
            total += hull;
        }
        EXPECT_GT(total, 20);
    }
}

TEST_F(Section, HasTheAreaOfTheCut) {
    // A hexagon through the middle of the cube, and through many points of the grid.
    build(cube(8));
    const Image image = draw(Order({4, 4, 4}, {1, 1, 1}), drawing(300));
    const auto covered = std::count(image.pixels.begin(), image.pixels.end(), full);
    const auto blank = std::count(image.pixels.begin(), image.pixels.end(), ground);
    const auto border = static_cast<double>(image.pixels.size()) - covered - blank;
    // A quarter of the rectangle around a regular hexagon is blank.
    EXPECT_NEAR((covered + border / 2) / image.pixels.size(), 0.75, 0.01);
    EXPECT_LT(border, 3 * 300);
    EXPECT_NEAR(area(Order({4, 4, 4}, {1, 1, 1})), 0.75 * std::sqrt(3) * 64, 1e-9);
}

TEST_F(Section, InterpolatesInsideTetrahedra) {
    const Palette palette = Palette::strata();
    for (const auto &points : {full_cube(300), cube(1)}) {
        build(points, [](const Point<3> &p) { return p[0]; });
        const Image across = draw(Order({0.5, 0.3, 0.5}, {0, 1, 0}), drawing(64));
        build(points, [](const Point<3> &p) { return p[2]; });
        const Image upwards = draw(Order({0.5, 0.3, 0.5}, {0, 1, 0}), drawing(64));
        for (int i = 0; i < 64; ++i)
            for (int j = 0; j < 64; ++j) {
                const std::uint32_t wanted = encode(palette((i + 0.5f) / 64));
                ASSERT_LE(difference(across(i, j), wanted), 2);
                ASSERT_LE(difference(upwards(j, 63 - i), wanted), 2);
            }
    }
}

TEST_F(Section, LacksAValueWhereAVertexOfTheEdgeLacksIt) {
    const Plane plane(Order({0, 0, 0.5}, {0, 0, 1}));
    for (const int missing : {0, 1}) { // below the plane, above it
        Cut cut[4] = {{plane.place({0, 0, 0}), 5},
                      {plane.place({1, 0, 1}), 5},
                      {plane.place({0, 1, 1}), 5},
                      {plane.place({0, 0, 1}), 5}};
        cut[missing].value = std::numeric_limits<double>::quiet_NaN();
        Patch patch{};
        ASSERT_TRUE(cut_tetrahedron(cut, patch));
        ASSERT_EQ(patch.corners, 3);
        int lacking = 0;
        for (int i = 0; i < 3; ++i) lacking += std::isnan(patch.value[i]);
        EXPECT_EQ(lacking, missing == 0 ? 3 : 1);
    }
}

// Which of x, y and z grows along the picture's axes.
TEST_F(Section, LiesAsAMapOrASectionDoes) {
    struct Case {
        Point<3> normal;
        int right;   // axis
        int up;      // axis
        double rise; // of the picture, without exaggeration
    };
    const double root = std::sqrt(2.0);
    for (const Case &c : std::initializer_list<Case>{{{0, 0, 1}, 0, 1, 1},
                                                     {{0, 0, -1}, 0, 1, 1},
                                                     {{0, 1, 0}, 0, 2, 1},
                                                     {{0, -1, 0}, 0, 2, 1},
                                                     {{1, 0, 0}, 1, 2, 1},
                                                     {{-1, 0, 0}, 1, 2, 1},
                                                     {{1, 1, 0}, 0, 2, 1 / root},
                                                     {{1, -1, 0}, 0, 2, 1 / root},
                                                     {{0, 1, 1}, 0, 2, root},
                                                     {{0, 1, -1}, 0, 2, root},
                                                     {{0, 0.1, 1}, 0, 1, std::sqrt(1.01)}})
        for (const double exaggeration : {1.0, 3.0, -1.0, -0.5}) {
            const Order order({0.5, 0.5, 0.5}, c.normal, exaggeration);
            build(cube(4, 0.25), [&](const Point<3> &p) { return p[c.right]; });
            const Image right = draw(order, drawing(100));
            EXPECT_NEAR(right.height, 100 * c.rise * std::fabs(exaggeration), 1);
            const int middle = right.height / 2;
            EXPECT_EQ(right(1, middle), right(1, middle / 2));
            const std::uint32_t low = encode(Palette::strata()(1.5f / 100));
            EXPECT_LE(difference(right(1, middle), low), 2);
            build(cube(4, 0.25), [&](const Point<3> &p) { return p[c.up]; });
            const Image up = draw(order, drawing(100));
            const int bottom = exaggeration > 0 ? up.height - 1 : 0;
            EXPECT_LE(difference(up(50, bottom), encode(Palette::strata()(0.5f / up.height))), 2);
        }
}

} // namespace
} // namespace abacus
