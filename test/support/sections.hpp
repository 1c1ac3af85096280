// A tetrahedral mesh over a host of its own, the plane sections through it, and their pictures.
#pragma once

#include "draw/canvas.hpp"
#include "draw/section.hpp"
#include "support/image.hpp"
#include "support/staged_points.hpp"

#include <abacus/build.h>
#include <abacus/scan.h>

#include <functional>

namespace abacus {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

using Field = std::function<double(const Point<3> &)>;

inline double one(const Point<3> &) { return 1; }

inline std::vector<Point<3>> cube(int n, double step = 1) {
    std::vector<Point<3>> result;
    for (int x = 0; x <= n; ++x)
        for (int y = 0; y <= n; ++y)
            for (int z = 0; z <= n; ++z) result.push_back({x * step, y * step, z * step});
    return result;
}

// Random points of the unit cube, and its corners.
inline std::vector<Point<3>> full_cube(std::size_t n) {
    std::vector<Point<3>> result = points<3>(Kind::uniform, n);
    for (const Point<3> &corner : cube(1)) result.push_back(corner);
    return result;
}

// The corners of octants that are refined towards a corner of the cube of side 16: 1 below 4, 2
// below 8, otherwise 4.
inline std::vector<Point<3>> octree() {
    std::vector<Point<3>> result;
    for (const Point<3> &p : cube(16)) {
        const double far = std::max({p[0], p[1], p[2]});
        const double step = far <= 4 ? 1 : far <= 8 ? 2 : 4;
        if (std::all_of(p.begin(), p.end(), [&](double x) { return std::fmod(x, step) == 0; }))
            result.push_back(p);
    }
    return result;
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
        host.attribute_pages.clear();
        header = empty_header<3>(1);
        EXPECT_EQ(stage<3>(host, header, input, ample, error), ABACUS_OK);
        abacus_build *build = nullptr;
        EXPECT_EQ(abacus_build_open(host.table(), &header.facts, ample, &build, &error), ABACUS_OK);
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
        abacus_picture picture{};
        error = {};
        const abacus_status status =
            abacus_draw_section(host.table(), &header.facts, &section, &drawing, &picture, &error);
        if (status == ABACUS_OK) {
            image = decode(picture.png, picture.size);
            host.host().release(picture.png);
            is_blank = picture.is_blank != 0;
        }
        return status;
    }
    Image draw(const abacus_section &section, const abacus_drawing &drawing) {
        EXPECT_EQ(try_draw(section, drawing), ABACUS_OK) << error.message;
        return image;
    }
    /// The area of all sections together, which is that of the cut if they do not overlap; adds
    /// their corners to `corners`.
    double area(const abacus_section &section, std::vector<Point<2>> *corners = nullptr) {
        const Plane plane(section);
        double sum = 0;
        abacus_scan *scan = nullptr;
        EXPECT_EQ(abacus_scan_open(host.table(), &header.facts, 1, &scan, &error), ABACUS_OK);
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
    /// Every pixel has the colour of a field with one value: nothing is blank or half covered.
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
    bool is_blank = false;
    const Encoder encode;
    const std::uint32_t ground = 0xf4f1ea;
    const std::uint32_t full = encode(Palette::strata()(0.5f));
};

} // namespace abacus
