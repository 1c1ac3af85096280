// Pictures: what they show; and nothing that a mesh can contain breaks them.
#include "draw/canvas.hpp"
#include "support/image.hpp"
#include "support/staged_points.hpp"

#include <cstring>
#include <limits>
#include <vector>

namespace abacus {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

abacus_drawing square_drawing(std::int32_t pixels) {
    abacus_drawing drawing{};
    drawing.upper[0] = drawing.upper[1] = 1;
    drawing.width = drawing.height = pixels;
    drawing.attribute = 0;
    return drawing;
}

// A square of n by n cells over the unit square, heights by a function.
template <class Height> std::vector<Patch> grid(int n, Height &&height) {
    std::vector<Patch> triangles;
    const auto at = [&](int i) { return static_cast<double>(i) / n; };
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const double a = at(x), b = at(y), c = at(x + 1), d = at(y + 1);
            triangles.push_back(
                {{{a, b}, {c, b}, {c, d}}, {height(a, b), height(c, b), height(c, d)}});
            triangles.push_back(
                {{{a, b}, {c, d}, {a, d}}, {height(a, b), height(c, d), height(a, d)}});
        }
    return triangles;
}

class Draw : public ::testing::Test {
protected:
    Png png(const abacus_drawing &drawing, const std::vector<Patch> &triangles) {
        Extent extent(drawing);
        for (const Patch &t : triangles) extent.add(t);
        Canvas canvas(host, extent.drawing(), extent.low(), extent.high());
        for (const Patch &t : triangles) canvas.add(t);
        return canvas.png(Palette::terrain());
    }
    Image draw(const abacus_drawing &drawing, const std::vector<Patch> &triangles) {
        return decode(png(drawing, triangles));
    }
    void TearDown() override {
        EXPECT_EQ(memory.bytes, 0u);
        EXPECT_TRUE(memory.violations.empty());
    }

    MemoryHost memory;
    Host host{memory.host()};
    const Encoder encode;
    const std::uint32_t ground = 0xf4f1ea;
};

TEST_F(Draw, HasTheSizeAskedFor) {
    abacus_drawing drawing = square_drawing(7);
    drawing.height = 5;
    const Image image = draw(drawing, grid(2, [](double x, double) { return x; }));
    EXPECT_EQ(image.width, 7);
    EXPECT_EQ(image.height, 5);
}

TEST_F(Draw, TakesTheHeightFromTheWindow) {
    abacus_drawing drawing = square_drawing(40);
    drawing.height = 0;
    drawing.upper[1] = 0.5;
    EXPECT_EQ(draw(drawing, {}).height, 20);
    // A long or narrow window is stretched.
    drawing.upper[1] = 1e-9;
    EXPECT_EQ(draw(drawing, {}).height, 5);
    drawing.upper[1] = 1e9;
    EXPECT_EQ(Extent(drawing).drawing().height, 320);
    drawing.width = 3;
    EXPECT_EQ(Extent(drawing).drawing().height, 24);
    drawing.upper[1] = 1e-9;
    EXPECT_EQ(Extent(drawing).drawing().height, 1);
    drawing.upper[1] = 1e9;
    drawing.width = max_side;
    EXPECT_EQ(Extent(drawing).drawing().height, max_pixels / max_side);
}

TEST_F(Draw, FindsTheWindowOfTheMesh) {
    abacus_drawing drawing = square_drawing(10);
    drawing.lower[0] = 1; // empty
    drawing.height = 0;
    EXPECT_TRUE(Extent::is_needed(drawing));
    Extent extent(drawing);
    extent.add({{{-3, 2}, {1, 2}, {0, 10}}, {4, -1, 2}});
    extent.add({{{-3, 2}, {1, 2}, {0, 1}}, {NAN, 100, 2}});
    const abacus_drawing whole = extent.drawing();
    EXPECT_EQ(whole.lower[0], -3);
    EXPECT_EQ(whole.upper[0], 1);
    EXPECT_EQ(whole.lower[1], 1);
    EXPECT_EQ(whole.upper[1], 10);
    EXPECT_EQ(whole.height, 23);
    EXPECT_EQ(extent.low(), -1);
    EXPECT_EQ(extent.high(), 4);
}

TEST_F(Draw, TakesTheRangeFromTheWindow) {
    Extent extent(square_drawing(10));
    extent.add({{{2, 0}, {3, 0}, {2, 1}}, {7, 7, 7}});
    EXPECT_TRUE(std::isnan(extent.low()));
    EXPECT_TRUE(std::isnan(extent.high()));
    extent.add({{{0.5, 0}, {3, 0}, {2, 1}}, {1, 2, 3}});
    EXPECT_EQ(extent.low(), 1);
    EXPECT_EQ(extent.high(), 3);
}

TEST_F(Draw, TakesTheRangeOfWhatIsSeen) {
    // The box of this triangle meets the window, its corner reaches it, but no part is inside.
    Extent extent(square_drawing(10));
    extent.add({{{2, 0}, {2, 2}, {0, 2}}, {7, 7, 7}});
    EXPECT_TRUE(std::isnan(extent.low()));
    extent.add({{{2, -0.5}, {2, 2}, {-0.5, 2}}, {1, 2, 3}});
    EXPECT_EQ(extent.high(), 3);
}

TEST_F(Draw, GivesAPlaceOneColourInAllWindowsOfARange) {
    const auto triangles = grid(7, [](double x, double y) { return 100 * x * y * y; });
    abacus_drawing whole = square_drawing(64);
    whole.range[0] = 20;
    whole.range[1] = 70;
    EXPECT_FALSE(Extent::is_needed(whole));
    const Image all = draw(whole, triangles);
    for (const int right : {0, 1}) {
        abacus_drawing tile = whole;
        tile.width = 32;
        tile.lower[0] = 0.5 * right;
        tile.upper[0] = 0.5 + 0.5 * right;
        const Image part = draw(tile, triangles);
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 32; ++x) ASSERT_EQ(part(x, y), all(x + 32 * right, y));
    }
    // Everything beyond has the last colour, however far.
    const Palette palette = Palette::terrain();
    EXPECT_EQ(all(0, 60), encode(palette(0)));
    const double most = std::numeric_limits<double>::max();
    const Image far = draw(whole, grid(7, [&](double x, double) { return x > 0 ? most : -most; }));
    EXPECT_EQ(far(63, 30), encode(palette(1)));
    EXPECT_EQ(far(0, 63), encode(palette(0)));
}

TEST_F(Draw, KnowsWhetherAnythingIsSeen) {
    abacus_drawing drawing = square_drawing(10);
    Canvas canvas(host, drawing, NAN, NAN);
    EXPECT_TRUE(canvas.is_blank());
    canvas.add({{{2, 0}, {2, 2}, {1.2, 2}}, {7, 7, 7}});
    EXPECT_TRUE(canvas.is_blank());
    canvas.add({{{0.5, 0.5}, {0.51, 0.5}, {0.5, 0.51}}, {7, 7, 7}});
    EXPECT_FALSE(canvas.is_blank());
}

TEST_F(Draw, TintsByHeightWithNorthUp) {
    const Palette palette = Palette::terrain();
    const Image image = draw(square_drawing(64), grid(4, [](double, double y) { return y; }));
    EXPECT_LE(difference(image(0, 63), encode(palette(0.5f / 64))), 1);
    EXPECT_LE(difference(image(63, 0), encode(palette(63.5f / 64))), 1);
    EXPECT_LE(difference(image(30, 32), encode(palette(31.5f / 64))), 1);
    EXPECT_EQ(image(0, 20), image(63, 20));
}

TEST_F(Draw, LeavesTheGroundWhereThereIsNoTriangle) {
    const Image image = draw(square_drawing(20), {{{{0, 0}, {1, 0}, {0, 1}}, {0, 0, 0}}});
    EXPECT_EQ(image(19, 0), ground);
    EXPECT_EQ(image(19, 10), ground);
    EXPECT_EQ(image(0, 18), encode(Palette::terrain()(0.5f)));
    // The pixel on the edge is covered by half.
    EXPECT_NE(image(10, 10), ground);
    EXPECT_NE(image(10, 10), image(0, 18));
}

TEST_F(Draw, HasNoSeams) {
    const std::vector<Patch> odd = {{{{0, 0}, {1, 0}, {0.37, 0.71}}, {1, 1, 1}},
                                    {{{1, 0}, {1, 1}, {0.37, 0.71}}, {1, 1, 1}},
                                    {{{0.37, 0.71}, {0, 1}, {1, 1}}, {1, 1, 1}},
                                    {{{0, 0}, {0.37, 0.71}, {0, 1}}, {1, 1, 1}}};
    const Image image = draw(square_drawing(51), odd);
    for (const std::uint32_t pixel : image.pixels) ASSERT_EQ(pixel, image(0, 0));
}

TEST_F(Draw, ManySmallTrianglesLookLikeAFewLargeOnes) {
    const auto height = [](double x, double y) { return x + 2 * y; };
    const Image coarse = draw(square_drawing(23), grid(1, height));
    const Image fine = draw(square_drawing(23), grid(300, height));
    for (std::size_t i = 0; i < coarse.pixels.size(); ++i)
        ASSERT_LE(difference(coarse.pixels[i], fine.pixels[i]), 1);
}

TEST_F(Draw, DoesNotDependOnOrderOrOrientation) {
    abacus_drawing drawing = square_drawing(64);
    drawing.edges = 1;
    drawing.exaggeration = 1;
    std::vector<Patch> triangles = grid(40, [](double x, double y) { return x * x - y; });
    const Image image = draw(drawing, triangles);
    for (Patch &t : triangles) {
        std::swap(t.corner[0], t.corner[1]);
        std::swap(t.value[0], t.value[1]);
    }
    std::reverse(triangles.begin(), triangles.end());
    const Image turned = draw(drawing, triangles);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        ASSERT_LE(difference(image.pixels[i], turned.pixels[i]), 1);
}

TEST_F(Draw, IsDeterministic) {
    for (const int attribute : {-1, 0}) {
        abacus_drawing drawing = square_drawing(50);
        drawing.attribute = attribute;
        drawing.edges = 1;
        drawing.exaggeration = 0.3;
        const auto triangles = grid(30, [](double x, double y) { return std::sin(9 * x) * y; });
        const Png once = png(drawing, triangles);
        const Png again = png(drawing, triangles);
        ASSERT_EQ(once.size(), again.size());
        EXPECT_EQ(std::memcmp(once.data(), again.data(), once.size()), 0);
    }
}

TEST_F(Draw, ClipsToTheWindow) {
    // One picture, and the same part of a larger one.
    const auto height = [](double x, double y) { return x * y; };
    abacus_drawing whole = square_drawing(60);
    whole.height = 45; // no edge at 45 degrees, where rounding chooses the pixels
    whole.edges = 1;
    abacus_drawing part = whole;
    part.lower[0] = part.lower[1] = 1.0 / 3;
    part.upper[0] = part.upper[1] = 2.0 / 3;
    part.width = 20;
    part.height = 15;
    const auto triangles = grid(7, height);
    Canvas large(host, whole, 0, 1), small(host, part, 0, 1);
    for (const Patch &t : triangles) {
        large.add(t);
        small.add(t);
    }
    const Image a = decode(large.png(Palette::terrain())),
                b = decode(small.png(Palette::terrain()));
    // Lines of outside triangles may touch the outermost pixels.
    for (int y = 1; y < 14; ++y)
        for (int x = 1; x < 19; ++x) ASSERT_LE(difference(a(x + 20, y + 15), b(x, y)), 1);
}

TEST_F(Draw, SurvivesTheRangeOfDoubles) {
    const double top = std::numeric_limits<double>::max();
    const double tiny = std::numeric_limits<double>::denorm_min();
    std::vector<Patch> triangles = {
        {{{-top, -top}, {top, -top}, {0, top}}, {-top, top, 0}},
        {{{0, 0}, {tiny, 0}, {0, tiny}}, {0, 0, 0}},
        {{{-1e300, 0.2}, {1e300, 0.3}, {1e-300, 0.9}}, {1e-300, -0.0, 1}},
    };
    for (const double exaggeration : {0.0, 1.0, 1e300})
        for (const int attribute : {-1, 0}) {
            abacus_drawing drawing = square_drawing(16);
            drawing.attribute = attribute;
            drawing.edges = 1;
            drawing.exaggeration = exaggeration;
            EXPECT_NE(draw(drawing, triangles)(8, 15), ground);
            drawing.lower[0] = drawing.upper[0]; // whole mesh
            draw(drawing, triangles);
            draw(drawing, {triangles[1]});
            drawing.height = 0; // from its shape
            draw(drawing, {triangles[1]});
        }
}

TEST_F(Draw, CoversAWindowInsideOneTriangle) {
    const Patch wide{{{-1e6, -1e6}, {1e6, -1e6}, {0, 3e6}}, {5, 5, 5}};
    const Image image = draw(square_drawing(9), {wide});
    for (const std::uint32_t pixel : image.pixels)
        ASSERT_EQ(pixel, encode(Palette::terrain()(0.5f)));
}

TEST_F(Draw, ShowsMissingValuesInGrey) {
    const Patch left{{{0, 0}, {0.5, 0}, {0, 4}}, {0, 1, 0}};
    for (const double missing : {double{NAN}, infinity, -infinity}) {
        const Patch right{{{1, -3}, {1, 1}, {0.5, 1}}, {0, missing, 1}};
        const std::uint32_t pixel = draw(square_drawing(16), {left, right})(15, 8);
        EXPECT_NE(pixel, ground);
        EXPECT_LT(std::abs(red(pixel) - blue(pixel)), 12);
        // Nor does it matter if nothing has a value.
        EXPECT_EQ(draw(square_drawing(16), {right})(15, 8), pixel);
    }
}

TEST_F(Draw, TakesDegenerateTriangles) {
    const std::vector<Patch> triangles = {{{{0.5, 0.5}, {0.5, 0.5}, {0.5, 0.5}}, {1, 1, 1}},
                                          {{{0, 0}, {0.5, 0.5}, {1, 1}}, {0, 1, 2}},
                                          {{{0, 0.5}, {0.5, 0.5}, {1, 0.5}}, {0, 1, 2}},
                                          {{{1, 1}, {1, 1}, {0, 1}}, {0, 1, 2}},
                                          {{{1, 0}, {1, 0.5}, {1, 1}}, {0, 1, 2}}};
    for (const int edges : {0, 1})
        for (const int attribute : {-1, 0}) {
            abacus_drawing drawing = square_drawing(8);
            drawing.edges = edges;
            drawing.attribute = attribute;
            drawing.exaggeration = 1;
            const Image image = draw(drawing, triangles);
            for (const std::uint32_t pixel : image.pixels) ASSERT_EQ(pixel, image(0, 7));
        }
}

TEST_F(Draw, DrawsAnEmptyMesh) {
    abacus_drawing drawing{};
    drawing.width = 3;
    for (const int attribute : {-1, 0}) {
        drawing.attribute = attribute;
        const Image image = draw(drawing, {});
        EXPECT_EQ(image.width, 3);
        EXPECT_EQ(image.height, 3);
    }
}

TEST_F(Draw, DrawsASinglePixel) {
    abacus_drawing drawing = square_drawing(1);
    drawing.exaggeration = 1;
    drawing.edges = 1;
    for (const int attribute : {-1, 0}) {
        drawing.attribute = attribute;
        const Image image = draw(drawing, grid(50, [](double x, double y) { return x + y; }));
        EXPECT_EQ(image.pixels.size(), 1u);
        EXPECT_NE(image(0, 0), ground);
    }
}

TEST_F(Draw, LeavesOutLongTriangles) {
    // Two squares apart; what joins them is long.
    const std::vector<Point<2>> corners = {{0, 0}, {2, 0},  {0, 2}, {2, 2},
                                           {8, 0}, {10, 0}, {8, 2}, {10, 2}};
    abacus_header header = empty_header<2>();
    abacus_error error{};
    ASSERT_EQ(stage<2>(memory, header, with_ids<2>(corners), ample, error), ABACUS_OK);
    abacus_build *build = nullptr;
    ASSERT_EQ(abacus_build_open(memory.table(), &header.facts, ample, &build, &error), ABACUS_OK);
    ASSERT_EQ(abacus_build_run(build, 0, &header, &error), ABACUS_OK);
    abacus_build_close(build);
    for (const double max_edge : {0.0, 3.0}) {
        abacus_drawing drawing{};
        drawing.width = 100;
        drawing.attribute = -1;
        drawing.extent.max_edge = max_edge;
        abacus_picture picture{};
        ASSERT_EQ(abacus_draw(memory.table(), &header.facts, &drawing, &picture, &error),
                  ABACUS_OK);
        const Image image = decode(picture.png, picture.size);
        host.release(picture.png);
        EXPECT_EQ(picture.is_blank, 0);
        EXPECT_EQ(image.height, 20);
        EXPECT_EQ(image(50, 10) == 0x03060f, max_edge > 0);
        EXPECT_NE(image(10, 10), 0x03060fu);
    }
}

// A large window is read page by page; for a small one, the pages are searched.
TEST_F(Draw, HasInAWindowWhatIsThereInALargerOne) {
    Input<2> input = with_ids<2>(points<2>(Kind::uniform, 20000));
    for (auto &p : input) p.attributes = {std::bit_cast<std::uint64_t>(p.point[0] * p.point[1])};
    abacus_header header = empty_header<2>(1);
    abacus_error error{};
    ASSERT_EQ(stage<2>(memory, header, input, ample, error), ABACUS_OK);
    abacus_build *build = nullptr;
    ASSERT_EQ(abacus_build_open(memory.table(), &header.facts, ample, &build, &error), ABACUS_OK);
    ASSERT_EQ(abacus_build_run(build, 0, &header, &error), ABACUS_OK);
    abacus_build_close(build);
    const auto shown = [&](const abacus_drawing &drawing, bool &is_blank) {
        abacus_picture picture{};
        EXPECT_EQ(abacus_draw(memory.table(), &header.facts, &drawing, &picture, &error),
                  ABACUS_OK);
        const Image image = decode(picture.png, picture.size);
        host.release(picture.png);
        is_blank = picture.is_blank != 0;
        return image;
    };
    abacus_drawing drawing = square_drawing(256);
    std::fill_n(drawing.lower, 2, -0.5);
    std::fill_n(drawing.upper, 2, 1.5);
    drawing.range[1] = 1;
    bool is_blank;
    const Image all = shown(drawing, is_blank);
    EXPECT_FALSE(is_blank);
    drawing.width = drawing.height = 32;
    int blank = 0;
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 8; ++j) {
            drawing.lower[0] = -0.5 + 0.25 * i;
            drawing.lower[1] = -0.5 + 0.25 * j;
            for (int axis = 0; axis < 2; ++axis) drawing.upper[axis] = drawing.lower[axis] + 0.25;
            const Image part = shown(drawing, is_blank);
            blank += is_blank;
            for (int y = 0; y < 32; ++y)
                for (int x = 0; x < 32; ++x)
                    ASSERT_LE(difference(part(x, y), all(32 * i + x, 32 * (7 - j) + y)), 1);
        }
    EXPECT_EQ(blank, 48);
}

TEST_F(Draw, LightComesFromTheNorthWest) {
    abacus_drawing drawing = square_drawing(64);
    drawing.exaggeration = 0.5;
    // A pyramid; the four places tested have equal tints.
    const auto triangles = grid(
        64, [](double x, double y) { return std::min(std::min(x, 1 - x), std::min(y, 1 - y)); });
    const Image image = draw(drawing, triangles);
    const int west = sum(image(12, 32)), east = sum(image(51, 32));
    const int north = sum(image(32, 12)), south = sum(image(32, 51));
    EXPECT_GT(west, east + 60);
    EXPECT_GT(north, south + 60);
    drawing.exaggeration = -0.5;
    const Image hollow = draw(drawing, triangles);
    EXPECT_LT(sum(hollow(12, 32)), sum(hollow(51, 32)) - 60);
}

TEST_F(Draw, FlatGroundKeepsItsTint) {
    abacus_drawing drawing = square_drawing(8);
    Canvas plain(host, drawing, 0, 1);
    drawing.exaggeration = 100;
    Canvas shaded(host, drawing, 0, 1);
    for (const Patch &t : grid(3, [](double, double) { return 0.4; })) {
        plain.add(t);
        shaded.add(t);
    }
    const Image a = decode(plain.png(Palette::terrain())),
                b = decode(shaded.png(Palette::terrain()));
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        ASSERT_LE(difference(a.pixels[i], b.pixels[i]), 4);
}

TEST_F(Draw, EdgesShowAndNeverBlot) {
    abacus_drawing drawing = square_drawing(64);
    drawing.edges = 1;
    const auto flat = [](double, double) { return 1.0; };
    const std::uint32_t tint = encode(Palette::terrain()(0.5f));
    // A line is dark, the inside of a cell is clear.
    const Image coarse = draw(drawing, grid(2, flat));
    EXPECT_GT(difference(coarse(32, 20), tint), 20);
    EXPECT_LE(difference(coarse(10, 40), tint), 1);
    // A mesh far below the pixel is a light tone.
    const Image fine = draw(drawing, grid(400, flat));
    EXPECT_GT(difference(fine(20, 20), tint), 10);
    EXPECT_GT(sum(fine(20, 20)), sum(tint) * 0.6);
}

TEST_F(Draw, FineTrianglesShineInTheDark) {
    abacus_drawing drawing = square_drawing(64);
    drawing.attribute = -1;
    std::vector<Patch> triangles = grid(64, [](double, double) { return NAN; });
    for (Patch &t : triangles)
        for (int i = 0; i < 3; ++i) t.corner[i][0] *= 0.5;
    triangles.push_back({{{0.5, 0}, {1, 0}, {1, 1}}, {NAN, NAN, NAN}});
    triangles.push_back({{{0.5, 0}, {1, 1}, {0.5, 1}}, {NAN, NAN, NAN}});
    const Image image = draw(drawing, triangles);
    EXPECT_GT(sum(image(10, 30)), 4 * sum(image(50, 30)));
}

TEST_F(Draw, RefusesWhatCannotBeDrawn) {
    const auto refused = [&](auto change) {
        abacus_drawing drawing = square_drawing(10);
        change(drawing);
        try {
            Canvas canvas(host, drawing, 0, 1);
        } catch (const Error &error) {
            return error.kind == ABACUS_ERROR_ARGUMENT;
        }
        return false;
    };
    EXPECT_FALSE(refused([](abacus_drawing &) {}));
    EXPECT_TRUE(refused([](abacus_drawing &d) { d.width = 0; }));
    EXPECT_TRUE(refused([](abacus_drawing &d) { d.width = max_side + 1; }));
    EXPECT_TRUE(refused([](abacus_drawing &d) { d.width = INT32_MIN; }));
    EXPECT_TRUE(refused([](abacus_drawing &d) { d.height = -1; }));
    EXPECT_TRUE(refused([](abacus_drawing &d) { d.height = max_side + 1; }));
    EXPECT_TRUE(refused([](abacus_drawing &d) { d.width = d.height = max_side; }));
    EXPECT_TRUE(refused([](abacus_drawing &d) { d.lower[0] = NAN; }));
    EXPECT_TRUE(refused([](abacus_drawing &d) { d.upper[1] = infinity; }));
    EXPECT_TRUE(refused([](abacus_drawing &d) { d.exaggeration = NAN; }));
    EXPECT_TRUE(refused([](abacus_drawing &d) { d.extent.max_edge = NAN; }));
    EXPECT_TRUE(refused([](abacus_drawing &d) { d.extent.max_edge = -1; }));
}

TEST_F(Draw, MemoryDependsOnThePictureAlone) {
    abacus_drawing drawing = square_drawing(100);
    drawing.exaggeration = 1;
    drawing.edges = 1;
    Canvas canvas(host, drawing, 0, 1);
    const std::size_t bytes = memory.bytes;
    for (const Patch &t : grid(200, [](double x, double) { return x; })) canvas.add(t);
    EXPECT_EQ(memory.bytes, bytes);
    canvas.png(Palette::terrain());
    EXPECT_LE(memory.peak_bytes, 100u * 100 * 36 + 100000);
}

TEST_F(Draw, EveryWayOutReleasesItsMemory) {
    abacus_drawing drawing = square_drawing(200);
    drawing.exaggeration = 1;
    const auto triangles = grid(90, [](double x, double y) { return std::sin(99 * x * y); });
    // Each allocation in turn fails; TearDown checks for leaks.
    int failures = 0;
    for (bool done = false; !done; ++failures) {
        memory.fail_resize_at(failures + 1);
        try {
            png(drawing, triangles);
            done = true;
        } catch (const std::bad_alloc &) {
            EXPECT_EQ(memory.bytes, 0u);
        }
        memory.recover();
    }
    EXPECT_GT(failures, 5);
    // A cancel arrives while the picture is made.
    Canvas canvas(host, drawing, -1, 1);
    for (const Patch &t : triangles) canvas.add(t);
    memory.cancel();
    EXPECT_THROW(canvas.png(Palette::terrain()), HostFailure);
    memory.recover();
}

TEST_F(Draw, HandsItsBytesOver) {
    Png png = this->png(square_drawing(4), {});
    EXPECT_GT(memory.bytes, 0u);
    const std::size_t size = png.size();
    unsigned char *bytes = png.release();
    ASSERT_GT(size, 8u);
    EXPECT_EQ(std::memcmp(bytes, "\x89PNG\r\n\x1a\n", 8), 0);
    host.release(bytes);
}

} // namespace
} // namespace abacus
