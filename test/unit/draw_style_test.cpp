// How pictures are drawn: colours, light, contours, captions, nothing in the background; and
// adjacent windows fit together.
#include "draw/canvas.hpp"
#include "draw/captions.hpp"
#include "support/image.hpp"
#include "support/large_mesh.hpp"

#include <cmath>

namespace abacus::test {
namespace {

abacus_drawing square(std::int32_t pixels) {
    abacus_drawing drawing{};
    drawing.upper[0] = drawing.upper[1] = 1;
    drawing.width = drawing.height = pixels;
    drawing.range[1] = 1;
    return drawing;
}

/// Two triangles over the unit square, or its left half, with heights that are linear.
Image draw(const abacus_drawing &drawing, double (*height)(double, double), double right = 1) {
    MemoryHost memory;
    Image image;
    {
        const Host host = memory.host();
        Canvas canvas(host, drawing, drawing.range[0], drawing.range[1]);
        const double h[4] = {height(0, 0), height(right, 0), height(right, 1), height(0, 1)};
        canvas.add({{{0, 0}, {right, 0}, {right, 1}}, {h[0], h[1], h[2]}});
        canvas.add({{{0, 0}, {right, 1}, {0, 1}}, {h[0], h[2], h[3]}});
        image = decode(canvas.png(Palette::of(drawing.ramp, ABACUS_RAMP_TERRAIN)));
    }
    EXPECT_EQ(memory.bytes, 0u);
    return image;
}

double east(double x, double) { return x; }
double north(double, double y) { return y; }
double middle(double, double) { return 0.5; }

/// The perceived brightness (CIE L*, from 0 to 100).
double brightness(const Color &c) {
    const double y = 0.2126 * c.red + 0.7152 * c.green + 0.0722 * c.blue;
    return y > 216.0 / 24389 ? 116 * std::cbrt(y) - 16 : y * 24389 / 27;
}

TEST(Ramp, GrowsBrighterEvenly) {
    for (const abacus_ramp ramp :
         {ABACUS_RAMP_VIRIDIS, ABACUS_RAMP_MAGMA, ABACUS_RAMP_CIVIDIS, ABACUS_RAMP_GREY}) {
        const Palette palette = Palette::of(ramp, ABACUS_RAMP_TERRAIN);
        const double all = brightness(palette(1)) - brightness(palette(0));
        EXPECT_GT(all, 70) << ramp;
        for (int i = 0; i < 32; ++i) {
            const double step =
                brightness(palette((i + 1) / 32.0f)) - brightness(palette(i / 32.0f));
            EXPECT_GT(step, all / 32 * 0.15) << ramp << " " << i;
            EXPECT_LT(step, all / 32 * 2) << ramp << " " << i;
        }
    }
}

TEST(Ramp, DivergesFromABrightMiddle) {
    const Palette palette = Palette::of(ABACUS_RAMP_DIVERGING, ABACUS_RAMP_TERRAIN);
    EXPECT_NEAR(brightness(palette(0)), brightness(palette(1)), 6);
    EXPECT_GT(brightness(palette(0.5f)), 95);
    for (int i = 0; i < 16; ++i) {
        EXPECT_LT(brightness(palette(i / 32.0f)), brightness(palette((i + 1) / 32.0f)));
        EXPECT_GT(brightness(palette(1 - (i + 1) / 32.0f)), brightness(palette(1 - i / 32.0f)));
    }
}

TEST(Ramp, IsTheUsualOneUnlessNamed) {
    const Encoder encode;
    for (const float t : {0.0f, 0.4f, 1.0f}) {
        EXPECT_EQ(encode(Palette::of(ABACUS_RAMP_USUAL, ABACUS_RAMP_STRATA)(t)),
                  encode(Palette::strata()(t)));
        EXPECT_EQ(encode(Palette::of(ABACUS_RAMP_TERRAIN, ABACUS_RAMP_STRATA)(t)),
                  encode(Palette::terrain()(t)));
    }
    abacus_drawing drawing = square(9);
    drawing.ramp = ABACUS_RAMP_MAGMA;
    EXPECT_EQ(draw(drawing, middle)(4, 4), encode(Palette::magma()(0.5f)));
}

/// The unit square in two regions, told apart at its diagonal, which is fixed, as is the lower
/// side.
Image draw_regions(const abacus_drawing &drawing, Patch::Edge kind = Patch::Edge::hard) {
    MemoryHost memory;
    Image image;
    {
        const Host host = memory.host();
        Canvas canvas(host, drawing, drawing.range[0], drawing.range[1]);
        Patch lower{{{0, 0}, {1, 0}, {1, 1}}, {0.5, 0.5, 0.5}},
            upper{{{0, 0}, {1, 1}, {0, 1}}, {0.5, 0.5, 0.5}};
        lower.region = 1;
        upper.region = 2;
        lower.edge[1] = lower.edge[0] = upper.edge[1] = kind;
        canvas.add(lower);
        canvas.add(upper);
        image = decode(canvas.png(Palette::of(drawing.ramp, ABACUS_RAMP_TERRAIN)));
    }
    EXPECT_EQ(memory.bytes, 0u);
    return image;
}

TEST(Overlay, TintsRegions) {
    abacus_drawing drawing = square(40);
    const Image plain = draw(drawing, middle);
    EXPECT_EQ(draw_regions(drawing)(30, 30), plain(30, 30));
    drawing.regions = 1;
    const Image tinted = draw_regions(drawing);
    EXPECT_GT(difference(tinted(30, 30), plain(30, 30)), 20);
    EXPECT_GT(difference(tinted(10, 10), plain(10, 10)), 20);
    EXPECT_GT(difference(tinted(30, 30), tinted(10, 10)), 20);
    EXPECT_EQ(tinted(30, 30), tinted(20, 35)); // evenly
    // the border is in the colour of the region itself
    EXPECT_GT(difference(tinted(20, 39), tinted(20, 30)), 20);
    EXPECT_EQ(tinted(39, 20), tinted(30, 30)); // that side is free
}

TEST(Overlay, DrawsFixedEdges) {
    abacus_drawing drawing = square(40);
    drawing.lines = 1;
    const Image plain = draw(square(40), middle), hard = draw_regions(drawing);
    const Image soft = draw_regions(drawing, Patch::Edge::soft);
    const auto change = [&](const Image &image) {
        int sum = 0;
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 40; ++x) sum += difference(image(x, y), plain(x, y));
        return sum;
    };
    EXPECT_EQ(change(draw_regions(drawing, Patch::Edge::free)), 0);
    const int whole = difference(hard(20, 39), plain(20, 39));
    EXPECT_GT(whole, 60);
    EXPECT_GT(change(soft), 70 * whole); // the diagonal and a side
    EXPECT_GT(change(hard), change(soft) * 1.2);
    EXPECT_LT(change(hard), 200 * whole);
    EXPECT_EQ(hard(20, 39), hard(15, 39)); // a line at the border of the mesh is a whole one
    EXPECT_EQ(hard(30, 30), plain(30, 30));
}

TEST(Light, ComesFromWhereItIsSaid) {
    abacus_drawing drawing = square(64);
    drawing.exaggeration = 1;
    const auto lit = [&](double azimuth, double altitude, double (*height)(double, double)) {
        drawing.light[0] = azimuth;
        drawing.light[1] = altitude;
        return sum(draw(drawing, height)(32, 32));
    };
    // A slope that rises to the east faces west.
    EXPECT_GT(lit(270, 30, east), lit(180, 30, east) + 30);
    EXPECT_GT(lit(180, 30, east), lit(90, 30, east) + 30);
    EXPECT_GT(lit(180, 30, north), lit(0, 30, north) + 60);
    EXPECT_EQ(lit(-90, 30, east), lit(270, 30, east));
    EXPECT_EQ(lit(0, 90, east), lit(123, 90, east));
    const int usual = lit(0, 0, east);
    EXPECT_EQ(usual, lit(315, 45, east));
}

TEST(Light, DoesNotDependOnTheRangeOfTheColours) {
    abacus_drawing drawing = square(64);
    drawing.light[0] = 90; // the slope is in the shade
    drawing.light[1] = 30;
    const auto with = [&](double low, double high, double exaggeration) {
        drawing.range[0] = low;
        drawing.range[1] = high;
        drawing.exaggeration = exaggeration;
        return draw(drawing, east);
    };
    // All values are beyond the range, and get the colour of its end.
    const Image flat = with(2, 3, 0), hills = with(2, 3, 1);
    EXPECT_GT(difference(flat(32, 32), hills(32, 32)), 20);
    for (const double low : {5.0, 1e9, 1e250}) {
        const Image other = with(low, low * 2, 1);
        for (int x = 0; x < 64; ++x) EXPECT_EQ(other(x, 32), hills(x, 32)) << low << " " << x;
    }
    // ... in a range so wide that they have one colour, and beyond it at both ends.
    EXPECT_GT(difference(with(-1e12, 1e12, 0)(32, 32), with(-1e12, 1e12, 1)(32, 32)), 20);
    for (const double half : {1e-3, 1e-12}) {
        const Image ends = with(0.5 - half, 0.5 + half, 1), bare = with(0.5 - half, 0.5 + half, 0);
        EXPECT_GT(difference(ends(10, 32), bare(10, 32)), 20) << half;
        EXPECT_GT(difference(ends(54, 32), bare(54, 32)), 20) << half;
    }
}

TEST(Contours, AreWhereTheValueIs) {
    abacus_drawing drawing = square(100);
    drawing.range[1] = 2; // no part of the mesh has values above 1
    const Image plain = draw(drawing, east);
    drawing.contour_interval = 0.25;
    const Image lines = draw(drawing, east);
    for (int x = 0; x < 100; ++x) {
        const bool is_near = (x + 1) % 25 <= 1 && x > 2 && x < 97;
        const int change = difference(plain(x, 40), lines(x, 40));
        if (is_near) {
            EXPECT_GT(change, 20) << x;
        } else if (x > 2 && x < 97) {
            EXPECT_EQ(change, 0) << x;
        }
    }
}

TEST(Contours, OfFineTrianglesAreTheSameLines) {
    abacus_drawing drawing = square(100);
    drawing.contour_interval = 0.25;
    const Image lines = draw(drawing, east);
    MemoryHost memory;
    const Host host = memory.host();
    Canvas canvas(host, drawing, 0, 1);
    const int n = 333; // several to a pixel
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const double a = x / (n + 0.0), b = y / (n + 0.0), c = (x + 1.0) / n, d = (y + 1.0) / n;
            canvas.add({{{a, b}, {c, b}, {c, d}}, {a, c, c}});
            canvas.add({{{a, b}, {c, d}, {a, d}}, {a, c, a}});
        }
    const Image fine = decode(canvas.png(Palette::terrain()));
    for (int x = 3; x < 97; ++x) EXPECT_LE(difference(lines(x, 50), fine(x, 50)), 8) << x;
}

TEST(Contours, AlongAnEdgeAreDrawnOnce) {
    abacus_drawing drawing = square(64);
    drawing.contour_interval = 0.5;
    MemoryHost memory;
    const Host host = memory.host();
    Canvas canvas(host, drawing, 0, 1);
    for (int y = 0; y < 2; ++y) { // the level lies along the edges at y = 1/2
        const double b = y / 2.0, d = b + 0.5;
        canvas.add({{{0, b}, {1, b}, {1, d}}, {b, b, d}});
        canvas.add({{{0, b}, {1, d}, {0, d}}, {b, d, d}});
    }
    const Image split = decode(canvas.png(Palette::terrain()));
    const Image whole = draw(drawing, north);
    for (int y = 2; y < 62; ++y) EXPECT_LE(difference(split(20, y), whole(20, y)), 1) << y;
}

TEST(Contours, AreNotTooMany) {
    MemoryHost memory;
    const Host host = memory.host();
    abacus_drawing drawing = square(10);
    for (const double interval : {1e-9, -1.0, double(NAN), double(INFINITY), 5e-324}) {
        drawing.contour_interval = interval;
        EXPECT_THROW(Canvas(host, drawing, 0, 1), Error) << interval;
    }
    drawing.contour_interval = 1; // values so large that the next level is the same double
    Canvas canvas(host, drawing, 1e18, 1e18 + 512);
    canvas.add({{{0, 0}, {1, 0}, {1, 1}}, {1e18, 1e18 + 256, 1e18 + 512}});
    canvas.png(Palette::terrain());
}

TEST(Transparency, IsWhereNothingIs) {
    abacus_drawing drawing = square(40);
    const Image opaque = draw(drawing, middle, 0.5125);
    drawing.transparent = 1;
    const Image image = draw(drawing, middle, 0.5125); // half of the pixels of column 20
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x) {
            const std::size_t at = y * 40 + x;
            EXPECT_EQ(opaque.alphas[at], 255);
            if (x == 20) {
                EXPECT_NEAR(image.alphas[at], 128, 1);
            } else {
                EXPECT_EQ(image.alphas[at], x < 20 ? 255 : 0);
                EXPECT_EQ(image(x, y), x < 20 ? opaque(x, y) : 0);
            }
        }
    drawing.attribute = -1; // the mesh itself
    const Image mesh = draw(drawing, middle, 0.5);
    EXPECT_EQ(mesh.alphas[40 * 20 + 10], 255);
    EXPECT_EQ(mesh.alphas[40 * 20 + 30], 0);
}

TEST(Captions, AreInTheirCorners) {
    abacus_drawing drawing = square(400);
    const Image plain = draw(drawing, east);
    drawing.legend = "height (m)";
    drawing.scale_bar = "km";
    const Image image = draw(drawing, east);
    int left = 0, right = 0, elsewhere = 0;
    for (int y = 0; y < 400; ++y)
        for (int x = 0; x < 400; ++x) {
            if (plain(x, y) == image(x, y)) continue;
            if (y > 330 && x < 200)
                ++left;
            else if (y > 150 && x > 250)
                ++right;
            else
                ++elsewhere;
        }
    EXPECT_GT(left, 1000);
    EXPECT_GT(right, 4000);
    EXPECT_EQ(elsewhere, 0);
    // The colours of the legend: those of the ends of the range, at its ends.
    const Encoder encode;
    const auto has = [&](std::uint32_t color) {
        for (int y = 150; y < 400; ++y)
            for (int x = 250; x < 400; ++x)
                if (difference(image(x, y), color) <= 1) return true;
        return false;
    };
    EXPECT_TRUE(has(encode(Palette::terrain()(0))));
    EXPECT_TRUE(has(encode(Palette::terrain()(1))));
}

TEST(Captions, TakeAnything) {
    for (const std::int32_t size : {1, 7, 40, 300})
        for (const char *text :
             {"", "\xc2\xb5g/m\xc2\xb3", "\xe6\xb0\xb4 \xf0\x9f\x8c\x8a", "\xff\xc2"}) {
            abacus_drawing drawing = square(size);
            drawing.legend = drawing.scale_bar = text;
            drawing.range[0] = -1e300;
            drawing.range[1] = 1e300;
            draw(drawing, east);
            drawing.range[0] = 0;
            drawing.range[1] = 5e-324;
            draw(drawing, east);
            drawing.upper[0] = 1e308;
            draw(drawing, east);
        }
}

TEST(Captions, CountInRoundSteps) {
    EXPECT_EQ(round_step(0.8), 1);
    EXPECT_EQ(round_step(1), 1);
    EXPECT_EQ(round_step(1.1), 2);
    EXPECT_EQ(round_step(230), 500);
    EXPECT_EQ(round_step(700), 1000);
    EXPECT_EQ(number_text(250, 50), "250");
    EXPECT_EQ(number_text(0.30000000000000004, 0.1), "0.3");
    EXPECT_EQ(number_text(-0.0, 1), "0");
    EXPECT_EQ(number_text(-0.25, 0.05), "-0.25");
    EXPECT_EQ(number_text(5e12, 1e12), "5e+12");
    EXPECT_EQ(number_text(2e-9, 1e-9), "2e-09");
}

// ---- Windows side by side ------------------------------------------------------------------

Image window_of(MeshOf<2> &mesh, const abacus_drawing &drawing) {
    abacus_picture picture{};
    EXPECT_EQ(abacus_draw(mesh.host.table(), &mesh.header.facts, &drawing, &picture, &mesh.error),
              ABACUS_OK)
        << mesh.error.message;
    const Image image = decode(picture.png, picture.size);
    mesh.host.host().release(picture.png);
    EXPECT_EQ(mesh.host.bytes, 0u);
    return image;
}

TEST(Windows, FitAtTheirSeams) {
    MeshOf<2> mesh(1);
    Random random(5);
    std::vector<Input> input;
    for (int i = 0; i < 6000; ++i) {
        Point<2> p = unit_point<2>(random);
        if (i % 2 == 0) p[0] = p[0] * p[0] * p[0]; // triangles of all sizes
        input.push_back({i, p, {std::sin(20 * p[0]) * std::cos(17 * p[1])}});
    }
    ASSERT_EQ(mesh.insert(input), ABACUS_OK) << mesh.error.message;
    abacus_drawing drawing{};
    drawing.range[0] = -1;
    drawing.range[1] = 1;
    drawing.edges = 1;
    for (const double exaggeration : {0.0, 0.2}) {
        drawing.exaggeration = exaggeration;
        drawing.contour_interval = 0.25;
        drawing.lower[0] = drawing.lower[1] = 0.125;
        drawing.upper[0] = drawing.upper[1] = 0.875;
        drawing.width = drawing.height = 384;
        const Image all = window_of(mesh, drawing);
        drawing.width = drawing.height = 192;
        for (const int right : {0, 1})
            for (const int top : {0, 1}) {
                drawing.lower[0] = 0.125 + right * 0.375;
                drawing.lower[1] = 0.125 + top * 0.375;
                for (int axis = 0; axis < 2; ++axis)
                    drawing.upper[axis] = drawing.lower[axis] + 0.375;
                const Image part = window_of(mesh, drawing);
                int worst = 0;
                for (int y = 0; y < 192; ++y)
                    for (int x = 0; x < 192; ++x)
                        worst = std::max(worst, difference(part(x, y), all(x + 192 * right,
                                                                           y + 192 * (1 - top))));
                EXPECT_LE(worst, 1) << exaggeration << right << top;
            }
    }
}

} // namespace
} // namespace abacus::test
