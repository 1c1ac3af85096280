// Pictures of plane sections: windows, edges, blank parts; refusals; memory and failures.
#include "support/sections.hpp"

namespace abacus {
namespace {

TEST_F(Section, ShowsTheWindow) {
    build(full_cube(500), [](const Point<3> &p) { return p[0] + p[2]; });
    const Order order({0.5, 0.5, 0.5}, {0, 1, 0});
    const Image part = draw(order, boxed(drawing(40), {0.5, 0, 0.25}, {0.75, 1, 0.75}));
    EXPECT_EQ(part.height, 80);
    const auto at = [&](int x, int y) { return 0.5 + (x + y + 1) / 160.0; };
    // The colours belong to the values in the window; some of the corners lie outside.
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

// The pages of a small window are found in another way than those of a large one. The picture is
// the same: inside the mesh, across its hull and beside it.
TEST_F(Section, HasInAWindowWhatIsThereInALargerOne) {
    build(full_cube(4000), [](const Point<3> &p) { return p[0] + 2 * p[1] + 3 * p[2]; });
    ASSERT_GT(host.pages.size(), 30u);
    for (const Order &order : {Order({0.4, 0.5, 0.3}, {0, 0, 1}), Order({0, 0.7, 0}, {0, 1, 0}),
                               Order({9, 0, 0.6}, {0, 0, 1})}) {
        const bool is_map = order.normal[2] != 0;
        abacus_drawing d = boxed(drawing(256), {-0.5, -0.5, -0.5}, {1.5, 1.5, 1.5});
        d.range[1] = 6;
        const Image all = draw(order, d);
        ASSERT_EQ(all.height, 256);
        d.width = 32;
        int blank = 0;
        for (int i = 0; i < 8; ++i)
            for (int j = 0; j < 8; ++j) {
                d.lower[0] = -0.5 + 0.25 * i;
                d.upper[0] = d.lower[0] + 0.25;
                const int up = is_map ? 1 : 2;
                d.lower[up] = -0.5 + 0.25 * j;
                d.upper[up] = d.lower[up] + 0.25;
                const Image part = draw(order, d);
                blank += is_blank;
                for (int y = 0; y < 32; ++y)
                    for (int x = 0; x < 32; ++x)
                        ASSERT_LE(difference(part(x, y), all(32 * i + x, 32 * (7 - j) + y)), 1);
            }
        EXPECT_EQ(blank, 48);
    }
}

TEST_F(Section, IsBlankWhereThePlaneMisses) {
    build(cube(2));
    for (const int attribute : {-1, 0}) {
        const Image image = draw(Order({0, 0, 2.25}, {0, 0, 1}), drawing(30, attribute));
        EXPECT_EQ(image.height, 30);
        for (const std::uint32_t pixel : image.pixels) ASSERT_EQ(pixel, image(0, 0));
        EXPECT_TRUE(is_blank);
    }
    EXPECT_EQ(draw(Order({-1, 0, 0}, {1, 0, 0}), drawing(3))(1, 1), ground);
    // Nothing more is visible where it touches a corner or an edge.
    EXPECT_EQ(draw(Order({0, 0, 0}, {1, 1, 1}), drawing(3))(1, 1), ground);
    EXPECT_EQ(draw(Order({0, 0, 0}, {1, 1, 0}), drawing(3))(1, 1), ground);
}

TEST_F(Section, DrawsMeshesWithoutTetrahedra) {
    for (const std::size_t n : {0, 3, 9}) { // 9 points in each layer
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
        drawing.extent.max_edge = 2;
        const Image image = draw(Order({0, 0, z}, {0, 0, 1}), drawing);
        EXPECT_EQ(image(10, 10), full);
        EXPECT_EQ(image(50, 10), ground);
        EXPECT_EQ(image(90, 10), full);
        drawing.extent.max_edge = 0;
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
        EXPECT_TRUE(refused([&](O &, D &d) { d.extent.max_edge = -bad; }) || bad < 0);
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
    // Each kind of mesh has its own kind of picture.
    abacus_picture picture{};
    const D flat = drawing(10);
    EXPECT_EQ(abacus_draw(host.table(), &header.facts, &flat, &picture, &error), ABACUS_ERROR);
    header.facts.form.dimension = 2;
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
    build(full_cube(2000));
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
    // A damaged page that the plane meets is reported.
    std::prev(host.pages.end())->second.bytes()[0] ^= 1;
    EXPECT_EQ(try_draw(order, drawing), ABACUS_ERROR);
    EXPECT_EQ(error.kind, ABACUS_ERROR_CORRUPTED);
}

} // namespace
} // namespace abacus
