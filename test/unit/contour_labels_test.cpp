// Values on contours: where they are, that they do not overlap, and what is left of the lines.
#include "draw/canvas.hpp"
#include "draw/captions.hpp"
#include "draw/contour_labels.hpp"
#include "support/image.hpp"
#include "support/memory_host.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <set>
#include <vector>

namespace abacus::test {
namespace {

constexpr std::int32_t width = 640, height = 480;

using Path = std::vector<Point<2>>;
using Pixels = std::map<std::pair<std::int32_t, std::int32_t>, double>;

Path line(const Point<2> &from, const Point<2> &to, int pieces = 100) {
    Path path;
    for (int i = 0; i <= pieces; ++i)
        path.push_back({std::lerp(from[0], to[0], i / static_cast<double>(pieces)),
                        std::lerp(from[1], to[1], i / static_cast<double>(pieces))});
    return path;
}

Path circle(const Point<2> &middle, double radius, double turns = 1) {
    Path path;
    for (int i = 0; i <= 400; ++i) {
        const double angle = 2 * std::numbers::pi * turns * i / 400;
        path.push_back(
            {middle[0] + radius * std::cos(angle), middle[1] + radius * std::sin(angle)});
    }
    return path;
}

/// The pixels that the values of lines take, and how much of each; `free` boxes are kept free.
Pixels taken(const std::vector<std::pair<double, Path>> &lines, std::int32_t margin = 0,
             const std::vector<Box<2>> &free = {}) {
    MemoryHost memory;
    const Host host = memory.host();
    Raster raster(host, width, height);
    ContourLabels labels(host, width, height, margin, 10);
    for (const Box<2> &box : free) labels.keep_free(box);
    for (const auto &[value, path] : lines) labels.add(value, path);
    Pixels pixels;
    labels.each_pixel(raster, [&](std::int32_t x, std::int32_t y, double covered) {
        pixels[{x, y}] += covered;
    });
    return pixels;
}

TEST(ContourLabels, AreOnTheLine) {
    const Pixels pixels = taken({{150, line({20, 200}, {620, 200})}});
    ASSERT_FALSE(pixels.empty());
    std::set<std::int32_t> columns;
    for (const auto &[at, covered] : pixels) {
        EXPECT_LE(std::abs(at.second + 0.5 - 200), 9);
        EXPECT_GE(at.first, 20);
        EXPECT_LE(at.first, 620);
        columns.insert(at.first);
    }
    EXPECT_LT(columns.size(), 200u); // most of the line is left
    EXPECT_TRUE(taken({{150, line({20, 200}, {50, 200})}}).empty()) << "too short";
}

TEST(ContourLabels, DoNotDependOnTheDirectionOfTheLine) {
    for (const auto &[from, to] : {std::pair<Point<2>, Point<2>>{{20, 200}, {620, 200}},
                                   {{300, 20}, {300, 470}},
                                   {{30, 30}, {600, 400}}}) {
        const Pixels there = taken({{1e5, line(from, to)}}), back = taken({{1e5, line(to, from)}});
        EXPECT_FALSE(there.empty());
        EXPECT_NEAR(static_cast<double>(there.size()), static_cast<double>(back.size()), 40);
    }
}

TEST(ContourLabels, DoNotOverlap) {
    std::vector<std::pair<double, Path>> lines;
    for (int i = 0; i < 60; ++i) {
        lines.emplace_back(100 + i, line({5, 20.0 + 7 * i}, {635, 30.0 + 7 * i}));
        lines.emplace_back(200 + i, line({20.0 + 10 * i, 5}, {15.0 + 10 * i, 475}));
    }
    const Pixels pixels = taken(lines);
    EXPECT_GT(pixels.size(), 3000u);
    for (const auto &[at, covered] : pixels) EXPECT_LE(covered, 1 + 1e-6);
}

TEST(ContourLabels, NeedAStraightPieceOfLine) {
    EXPECT_TRUE(taken({{1000, circle({300, 200}, 15, 10)}}).empty());
    EXPECT_FALSE(taken({{1000, circle({300, 240}, 200)}}).empty());
    Path zigzag;
    for (int i = 0; i < 300; ++i) zigzag.push_back({20.0 + 2 * i, i % 2 == 0 ? 150.0 : 162.0});
    EXPECT_TRUE(taken({{1000, zigzag}}).empty());
}

TEST(ContourLabels, AreWithinThePictureWithoutItsMargin) {
    for (const std::int32_t margin : {0, 96}) {
        std::vector<std::pair<double, Path>> lines;
        for (int i = 0; i < 48; ++i) lines.emplace_back(i, line({-50, 10.0 * i}, {700, 10.0 * i}));
        for (const auto &[at, covered] : taken(lines, margin)) {
            EXPECT_GE(at.first, margin);
            EXPECT_LT(at.first, width - margin);
            EXPECT_GE(at.second, margin);
            EXPECT_LT(at.second, height - margin);
        }
    }
    EXPECT_TRUE(taken({{5, {}}, {5, {{1, 1}}}, {5, {{1, 1}, {1, 1}}}}).empty());
}

TEST(ContourLabels, LeaveBoxesFree) {
    const Box<2> free{{300, 100}, {700, 300}}; // in the picture without its margin, and beyond it
    std::vector<std::pair<double, Path>> lines;
    for (int i = 0; i < 48; ++i) lines.emplace_back(i, line({-50, 10.0 * i}, {700, 10.0 * i}));
    for (const std::int32_t margin : {0, 32}) {
        const auto inside = [&](const Pixels &pixels) {
            return std::count_if(pixels.begin(), pixels.end(), [&](const auto &pixel) {
                const auto [x, y] = pixel.first;
                return x - margin >= 300 && y - margin >= 100 && y - margin < 300;
            });
        };
        EXPECT_GT(inside(taken(lines, margin)), 1000);
        EXPECT_EQ(inside(taken(lines, margin, {free})), 0);
        EXPECT_FALSE(taken(lines, margin, {free}).empty());
    }
}

TEST(ContourLabels, HaveTheDigitsThatTheyNeed) {
    EXPECT_EQ(contour_text(150, 50), "150");
    EXPECT_EQ(contour_text(-0.0, 50), "0");
    EXPECT_EQ(contour_text(0.1 + 0.2, 0.1), "0.3");
    EXPECT_EQ(contour_text(-2.5, 0.5), "-2.5");
    EXPECT_EQ(contour_text(1e6, 1e6), "1000000");
    EXPECT_EQ(contour_text(2400000000000.5, 0.5), "2400000000000.5");
    EXPECT_EQ(contour_text(2400000000000.1, 0.1), "2400000000000.1");
    EXPECT_EQ(contour_text(123456789012345, 5), "123456789012345");
    EXPECT_EQ(contour_text(1e300, 1e300), "1e+300");
    EXPECT_EQ(contour_text(3e-9, 1e-9), "3e-09");
}

abacus_drawing drawing(bool with_labels) {
    abacus_drawing d{};
    d.width = width;
    d.height = height;
    d.upper[0] = width;
    d.upper[1] = height;
    d.attribute = 0;
    d.contour_interval = 10;
    d.contour_labels = with_labels;
    return d;
}

/// A slope that rises to the north, in a canvas; `label`: its contour of 100.
Image slope(bool with_labels, bool label) {
    MemoryHost memory;
    const Host host = memory.host();
    Canvas canvas(host, drawing(with_labels), 0, 200);
    canvas.add({{{0, 0}, {width, 0}, {width, height}}, {0, 0, 200}});
    canvas.add({{{0, 0}, {width, height}, {0, height}}, {0, 200, 200}});
    if (label)
        for (const double level : canvas.labelled_levels())
            canvas.label(level, line({0, level * height / 200}, {width, level * height / 200}));
    return decode(canvas.png(Palette::grey()));
}

TEST(ContourLabels, EachFifthLevelHasThem) {
    MemoryHost memory;
    const Host host = memory.host();
    const auto levels = [&](double low, double high, double interval, bool with_labels) {
        abacus_drawing d = drawing(with_labels);
        d.contour_interval = interval;
        const Arena<double> found = Canvas(host, d, low, high).labelled_levels();
        return std::vector<double>(found.begin(), found.end());
    };
    EXPECT_EQ(levels(0, 200, 10, true), (std::vector<double>{0, 50, 100, 150, 200}));
    EXPECT_EQ(levels(-60, 60, 10, true), (std::vector<double>{-50, 0, 50}));
    EXPECT_EQ(levels(1, 4, 1, true), std::vector<double>());
    EXPECT_EQ(levels(0, 200, 10, false), std::vector<double>());
    EXPECT_EQ(levels(NAN, NAN, 10, true), std::vector<double>());
}

TEST(ContourLabels, AreNotUnderCaptions) {
    abacus_drawing with = drawing(true);
    with.legend = "height";
    with.scale_bar = "m";
    const Box<2> legend = legend_box(width, height, 0, 200, "height"),
                 bar = scale_bar_box(width, height, "m");
    const auto picture = [&](bool label) {
        MemoryHost memory;
        const Host host = memory.host();
        Canvas canvas(host, with, 0, 200);
        canvas.add({{{0, 0}, {width, 0}, {width, height}}, {0, 0, 200}});
        canvas.add({{{0, 0}, {width, height}, {0, height}}, {0, 200, 200}});
        if (label)
            for (double y = 2; y < height; y += 10) canvas.label(50, line({0, y}, {width, y}));
        return decode(canvas.png(Palette::grey()));
    };
    const Image plain = picture(false), labelled = picture(true);
    int under = 0, beside = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const bool is_under =
                legend.contains({x + 0.5, y + 0.5}) || bar.contains({x + 0.5, y + 0.5});
            (is_under ? under : beside) += plain(x, y) != labelled(x, y);
        }
    EXPECT_EQ(under, 0);
    EXPECT_GT(beside, 1000);
}

TEST(ContourLabels, LinesEndWhereTheyBegin) {
    const Image plain = slope(false, false), wide = slope(true, false),
                labelled = slope(true, true);
    const auto dark = [](const Image &image, int x, int y) { return sum(image(x, y)); };
    const int row = height / 2, other = height / 2 + 24; // the contours of 100 and of 90
    EXPECT_LT(dark(wide, 50, row) + dark(wide, 50, row - 1),
              dark(plain, 50, row) + dark(plain, 50, row - 1))
        << "wider";
    int changed = 0, changed_other = 0;
    for (int x = 0; x < width; ++x) {
        changed += wide(x, row) != labelled(x, row);
        changed_other += wide(x, other) != labelled(x, other);
    }
    EXPECT_GT(changed, 10);
    EXPECT_LT(changed, 150);
    EXPECT_EQ(changed_other, 0);
}

} // namespace
} // namespace abacus::test
