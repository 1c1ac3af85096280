// Plane sections of tetrahedral meshes: that they tile the plane wherever it cuts, and
// what their pictures show.
#include "draw/canvas.hpp"
#include "draw/section.hpp"
#include "support/image.hpp"
#include "support/staged_points.hpp"

#include <abacus/read.h>

#include <functional>

namespace abacus {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

using Field = std::function<double(const Point<3> &)>;

double one(const Point<3> &) { return 1; }

std::vector<Point<3>> cube(int n, double step = 1) {
    std::vector<Point<3>> result;
    for (int x = 0; x <= n; ++x)
        for (int y = 0; y <= n; ++y)
            for (int z = 0; z <= n; ++z) result.push_back({x * step, y * step, z * step});
    return result;
}

// Random points of the unit cube, and its corners.
std::vector<Point<3>> full_cube(std::size_t n) {
    std::vector<Point<3>> result = points<3>(Kind::uniform, n);
    for (const Point<3> &corner : cube(1)) result.push_back(corner);
    return result;
}

// The corners of octants, refined towards a corner of the cube of side 16: 1 below 4, 2
// below 8, else 4.
std::vector<Point<3>> octree() {
    std::vector<Point<3>> result;
    for (const Point<3> &p : cube(16)) {
        const double far = std::max({p[0], p[1], p[2]});
        const double step = far <= 4 ? 1 : far <= 8 ? 2 : 4;
        if (std::all_of(p.begin(), p.end(), [&](double x) { return std::fmod(x, step) == 0; }))
            result.push_back(p);
    }
    return result;
}

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

struct Order : abacus_section {
    Order(Point<3> through, Point<3> normal, double exaggeration = 1) : abacus_section{} {
        std::copy_n(through.begin(), 3, this->through);
        std::copy_n(normal.begin(), 3, this->normal);
        this->exaggeration = exaggeration;
    }
};

class Section : public ::testing::Test {
protected:
    void build(const std::vector<Point<3>> &points, const Field &field = one) {
        Input<3> input = with_ids<3>(points);
        for (auto &staged : input)
            staged.attributes = {std::bit_cast<std::uint64_t>(field(staged.point))};
        host.pages.clear();
        host.staged_pages.clear();
        host.repeated_pages.clear();
        header = empty_header<3>(1);
        EXPECT_EQ(stage<3>(host, header, input, ample, error), ABACUS_OK);
        abacus_build *build = nullptr;
        EXPECT_EQ(abacus_build_open(host.table(), &header, ample, &build, &error), ABACUS_OK);
        EXPECT_EQ(abacus_build_run(build, 0, &header, &error), ABACUS_OK) << error.detail;
        abacus_build_close(build);
    }
    static abacus_drawing drawing(int width, int attribute = 0) {
        abacus_drawing result{};
        result.width = width;
        result.attribute = attribute;
        return result;
    }
    static abacus_drawing boxed(abacus_drawing drawing, Point<3> lower, Point<3> upper) {
        std::copy_n(lower.begin(), 3, drawing.lower);
        std::copy_n(upper.begin(), 3, drawing.upper);
        return drawing;
    }
    abacus_status try_draw(const abacus_section &section, const abacus_drawing &drawing) {
        unsigned char *png = nullptr;
        std::size_t size = 0;
        error = {};
        const abacus_status status =
            abacus_draw_section(host.table(), &header, &section, &drawing, &png, &size, &error);
        if (status == ABACUS_OK) {
            image = decode(png, size);
            host.host().release(png);
        }
        return status;
    }
    Image draw(const abacus_section &section, const abacus_drawing &drawing) {
        EXPECT_EQ(try_draw(section, drawing), ABACUS_OK) << error.message;
        return image;
    }
    /// The areas of all sections together, which is that of the cut if they overlap
    /// nowhere; adds their corners to `corners`.
    double area(const abacus_section &section, std::vector<Point<2>> *corners = nullptr) {
        const Plane plane(section);
        double sum = 0;
        abacus_scan *scan = nullptr;
        EXPECT_EQ(abacus_scan_open(host.table(), &header, 1, &scan, &error), ABACUS_OK);
        for (abacus_simplex s; abacus_scan_next(scan, &s, &error) == ABACUS_OK;) {
            Cut cut[4] = {};
            for (int i = 0; i < 4 - s.ghost; ++i)
                cut[i] = {plane.place(std::to_array(s.corner[i])), 0};
            const Cut facet[3] = {cut[0], cut[1], cut[2]};
            Patch patch{};
            if (s.ghost ? !cut_ghost(facet, patch) : !cut_tetrahedron(cut, patch)) continue;
            sum += std::fabs(patch.turn(0, 1, 2)) / 2;
            if (patch.corners == 4) sum += std::fabs(patch.turn(0, 2, 3)) / 2;
            for (int i = 0; corners != nullptr && i < patch.corners; ++i)
                corners->push_back(
                    {patch.corner[i][0] / Plane::scale, patch.corner[i][1] / Plane::scale});
        }
        abacus_scan_close(scan);
        return sum / (Plane::scale * Plane::scale);
    }
    /// Every pixel has the colour of a field of one value: nothing is blank, and
    /// nothing is half covered.
    void expect_full(const Image &image) {
        for (const std::uint32_t pixel : image.pixels) ASSERT_EQ(pixel, full);
    }
    void TearDown() override {
        EXPECT_EQ(host.bytes, 0u);
        EXPECT_TRUE(host.violations.empty());
    }

    MemoryHost host;
    abacus_header header{};
    abacus_error error{};
    Image image;
    const Encoder encode;
    const std::uint32_t ground = 0xf4f1ea;
    const std::uint32_t full = encode(Palette::strata()(0.5f));
};

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
                    // Not always what a grid of 0.1 has: 0.3 is not 3 * 0.1.
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
    std::vector<Point<3>> blurred = cube(4); // layers that are not quite flat
    for (Point<3> &p : blurred)
        for (double &x : p) x += 1e-12 * small(random);
    for (const auto &input : {points<3>(Kind::uniform, 400), points<3>(Kind::grid, 400),
                              points<3>(Kind::heavy, 400), cube(5), octree(), blurred}) {
        build(input);
        double total = 0;
        for (int round = 0; round < 100; ++round) {
            // Through points, in directions that meet others in a grid.
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
    // Of the rectangle around a regular hexagon, a quarter is blank.
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

// x, y or z: which of them grows along the picture's axes.
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

TEST_F(Section, ShowsTheWindow) {
    build(full_cube(500), [](const Point<3> &p) { return p[0] + p[2]; });
    const Order order({0.5, 0.5, 0.5}, {0, 1, 0});
    const Image part = draw(order, boxed(drawing(40), {0.5, 0, 0.25}, {0.75, 1, 0.75}));
    EXPECT_EQ(part.height, 80);
    const auto at = [&](int x, int y) { return 0.5 + (x + y + 1) / 160.0; };
    // The colours belong to the values in the window, of which some corners lie outside.
    EXPECT_LT(sum(part(39, 0)), sum(part(0, 79)));
    EXPECT_LT(at(0, 0), at(39, 79));
    // A window larger than the mesh has a border of ground.
    const Image wide = draw(order, boxed(drawing(40), {-1, 0, -1}, {2, 1, 2}));
    EXPECT_EQ(wide.height, 40);
    EXPECT_EQ(wide(2, 20), ground);
    EXPECT_EQ(wide(20, 2), ground);
    EXPECT_NE(wide(20, 20), ground);
    // An oblique plane leaves the box at its edges.
    const Image slanted =
        draw(Order({0.5, 0.5, 0.5}, {1, 1, 0}), boxed(drawing(100), {0.25, 0.25, 0}, {1, 0.75, 1}));
    EXPECT_EQ(slanted.height, 141); // 1 by half the root of 2
}

TEST_F(Section, IsBlankWhereThePlaneMisses) {
    build(cube(2));
    for (const int attribute : {-1, 0}) {
        const Image image = draw(Order({0, 0, 2.25}, {0, 0, 1}), drawing(30, attribute));
        EXPECT_EQ(image.height, 30);
        for (const std::uint32_t pixel : image.pixels) ASSERT_EQ(pixel, image(0, 0));
    }
    EXPECT_EQ(draw(Order({-1, 0, 0}, {1, 0, 0}), drawing(3))(1, 1), ground);
    // Nor is there more to see where it touches a corner or an edge.
    EXPECT_EQ(draw(Order({0, 0, 0}, {1, 1, 1}), drawing(3))(1, 1), ground);
    EXPECT_EQ(draw(Order({0, 0, 0}, {1, 1, 0}), drawing(3))(1, 1), ground);
}

TEST_F(Section, DrawsMeshesWithoutTetrahedra) {
    for (const std::size_t n : {0, 3, 9}) { // 9 points of a layer
        std::vector<Point<3>> points = cube(2);
        points.resize(n);
        build(points);
        for (const int attribute : {-1, 0})
            EXPECT_EQ(draw(Order({0, 0, 0}, {1, 0, 0}), drawing(5, attribute)).height, 5);
    }
}

TEST_F(Section, FineTetrahedraShineInTheDark) {
    build(octree());
    const Image image = draw(Order({1, 1, 1}, {0, 0, 1}), drawing(64, -1));
    EXPECT_GT(sum(image(7, 58)), 3 * sum(image(50, 10)));
    // The small corners that a plane cuts off a grid's cells do not.
    build(cube(4));
    const Image even = draw(Order({0, 0, 2.01}, {0.001, 0.02, 1}), drawing(64, -1));
    for (const std::uint32_t pixel : even.pixels) ASSERT_LE(difference(pixel, even(0, 0)), 40);
}

TEST_F(Section, DrawsEdges) {
    build(cube(4));
    abacus_drawing lines = drawing(128);
    lines.edges = 1;
    const Image image = draw(Order({0, 0, 2}, {0, 0, 1}), lines);
    for (const int at : {32, 64, 96}) { // the faces of the cells
        EXPECT_GT(difference(image(at, 20), full), 12);
        EXPECT_GT(difference(image(20, at), full), 12);
    }
    EXPECT_LE(difference(image(10, 24), full), 1);
}

TEST_F(Section, LeavesOutLongTetrahedra) {
    // Two cubes apart; what joins them is long.
    std::vector<Point<3>> pair = cube(2);
    for (Point<3> p : cube(2)) pair.push_back({p[0] + 8, p[1], p[2]});
    build(pair);
    abacus_drawing drawing = this->drawing(100);
    for (const double z : {0.0, 0.7, 1.0, 2.0}) {
        drawing.max_edge = 2;
        const Image image = draw(Order({0, 0, z}, {0, 0, 1}), drawing);
        EXPECT_EQ(image(10, 10), full);
        EXPECT_EQ(image(50, 10), ground);
        EXPECT_EQ(image(90, 10), full);
        drawing.max_edge = 0;
        expect_full(draw(Order({0, 0, z}, {0, 0, 1}), drawing));
    }
}

TEST_F(Section, ShowsMissingValuesInGrey) {
    for (const double missing : {double{NAN}, infinity, -infinity}) {
        build(cube(4), [&](const Point<3> &p) { return p[0] > 2.5 ? missing : p[0]; });
        const Image image = draw(Order({0, 0.5, 0}, {0, 1, 0}), drawing(64));
        EXPECT_GT(red(image(8, 30)) - blue(image(8, 30)), 12);
        EXPECT_LT(std::abs(red(image(60, 30)) - blue(image(60, 30))), 12);
        EXPECT_NE(image(60, 30), ground);
    }
}

TEST_F(Section, DoesNotDependOnTheOrderOfInsertion) {
    abacus_drawing lines = drawing(100);
    lines.edges = 1;
    const auto field = [](const Point<3> &p) { return std::sin(7 * p[0] * p[2]) + p[1]; };
    std::vector<Point<3>> points = full_cube(700);
    build(points, field);
    const Order order({0.4, 0.5, 0.5}, {1, 2, 0.5});
    const Image once = draw(order, lines);
    std::reverse(points.begin(), points.end());
    build(points, field);
    const Image again = draw(order, lines);
    for (std::size_t i = 0; i < once.pixels.size(); ++i)
        ASSERT_LE(difference(once.pixels[i], again.pixels[i]), 1);
}

TEST_F(Section, SurvivesEveryKindOfPoints) {
    for (const Kind kind : all_kinds) {
        SCOPED_TRACE(static_cast<int>(kind));
        const auto input = points<3>(kind, 300);
        build(input, [](const Point<3> &p) { return p[1]; });
        for (const Point<3> &normal :
             {Point<3>{0, 0, 1}, {1e300, -1e300, 3e299}, {5e-324, 0, 5e-324}, {1, 1e-200, 0}})
            for (const double exaggeration : {1.0, -1e308, 1e-308})
                for (const int attribute : {-1, 0}) {
                    abacus_drawing lines = drawing(8, attribute);
                    lines.height = 8;
                    lines.edges = 1;
                    draw(Order(input[17], normal, exaggeration), lines);
                    const double far = std::numeric_limits<double>::max();
                    draw(Order(input[17], normal, exaggeration),
                         boxed(lines, {-far, -far, -far}, {far, far, far}));
                    Point<3> next = input[17];
                    for (double &x : next) x = std::nextafter(x, far);
                    try_draw(Order(input[17], normal, exaggeration), boxed(lines, input[17], next));
                }
    }
}

TEST_F(Section, RefusesWhatCannotBeDrawn) {
    build(cube(1));
    const auto refused = [&](auto change) {
        Order order({0.5, 0.5, 0.5}, {0, 0, 1});
        abacus_drawing drawing = this->drawing(10);
        change(order, drawing);
        return try_draw(order, drawing) == ABACUS_ERROR && error.kind == ABACUS_ERROR_ARGUMENT;
    };
    using O = Order;
    using D = abacus_drawing;
    EXPECT_FALSE(refused([](O &, D &) {}));
    for (const double bad : {double{NAN}, infinity, -infinity}) {
        EXPECT_TRUE(refused([&](O &o, D &) { o.through[1] = bad; }));
        EXPECT_TRUE(refused([&](O &o, D &) { o.normal[0] = bad; }));
        EXPECT_TRUE(refused([&](O &o, D &) { o.exaggeration = bad; }));
        EXPECT_TRUE(refused([&](O &, D &d) { d.max_edge = -bad; }) || bad < 0);
    }
    EXPECT_TRUE(refused([](O &o, D &) { o.normal[2] = 0; }));
    EXPECT_TRUE(refused([](O &o, D &) { o.exaggeration = 0; }));
    EXPECT_TRUE(refused([](O &, D &d) { d.width = 0; }));
    EXPECT_TRUE(refused([](O &, D &d) { d.height = max_side + 1; }));
    EXPECT_TRUE(refused([](O &, D &d) { d.attribute = 1; }));
    // A box that the plane misses, or only touches.
    EXPECT_TRUE(refused([](O &, D &d) { d = boxed(d, {0, 0, 0}, {1, 1, 0.25}); }));
    EXPECT_TRUE(refused([](O &o, D &d) {
        o = Order({0, 0, 0}, {1, 1, 1});
        d = boxed(d, {0, 0, 0}, {1, 1, 1});
    }));
    EXPECT_FALSE(refused([](O &, D &d) { d = boxed(d, {0, 0, 0}, {1, 1, 0.5}); }));
    EXPECT_TRUE(refused([](O &, D &d) { d = boxed(d, {-infinity, 0, 0}, {1, 1, 1}); }));
    // Each mesh has its own kind of picture.
    unsigned char *png = nullptr;
    std::size_t size = 0;
    const D flat = drawing(10);
    EXPECT_EQ(abacus_draw(host.table(), &header, &flat, &png, &size, &error), ABACUS_ERROR);
    header.dimension = 2;
    EXPECT_TRUE(refused([](O &, D &) {}));
}

TEST_F(Section, MemoryDependsOnThePictureAlone) {
    build(full_cube(3000));
    host.peak_bytes = host.bytes;
    abacus_drawing lines = drawing(100);
    lines.edges = 1;
    draw(Order({0.5, 0.5, 0.5}, {1, 2, 3}), lines);
    EXPECT_LE(host.peak_bytes, 32u * image.pixels.size() + 100000);
}

TEST_F(Section, EveryWayOutIsClean) {
    build(full_cube(1000));
    const Order order({0.5, 0.5, 0.5}, {0, 1, 0});
    const abacus_drawing drawing = this->drawing(100);
    int failures = 0;
    for (abacus_status status = ABACUS_ERROR; status != ABACUS_OK; ++failures) {
        host.fail_resize_at(failures + 1);
        status = try_draw(order, drawing);
        EXPECT_TRUE(status == ABACUS_OK || error.kind == ABACUS_ERROR_MEMORY);
        EXPECT_EQ(host.bytes, 0u);
        host.recover();
    }
    EXPECT_GT(failures, 3);
    failures = 0;
    for (abacus_status status = ABACUS_ERROR; status != ABACUS_OK; ++failures) {
        host.fail_at(failures + 1);
        status = try_draw(order, drawing);
        EXPECT_TRUE(status == ABACUS_OK || status == ABACUS_HOST_ERROR);
        EXPECT_EQ(host.bytes, 0u);
        host.recover();
    }
    EXPECT_GT(failures, 20);
    host.cancel();
    EXPECT_EQ(try_draw(order, drawing), ABACUS_HOST_ERROR);
    host.recover();
    // A damaged page is reported, whether or not the plane meets it.
    std::prev(host.pages.end())->second.bytes()[0] ^= 1;
    EXPECT_EQ(try_draw(order, drawing), ABACUS_ERROR);
    EXPECT_EQ(error.kind, ABACUS_ERROR_CORRUPTED);
}

} // namespace
} // namespace abacus
