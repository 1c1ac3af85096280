// Pictures of octrees: each place has the colour of its leaf, without gap or overlap.
#include "octree/octree_edit.hpp"
#include "octree/octree_portrait.hpp"
#include "support/image.hpp"
#include "support/octree_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace abacus::test {
namespace {

Image image(const Portrait &portrait) { return decode(portrait.png.data(), portrait.png.size()); }

/// A balanced octree whose leaves have their level as a value, or all the same value.
template <int D> class Pictured : public StoredOctree<D> {
public:
    explicit Pictured(bool by_level) : StoredOctree<D>(1) {
        std::mt19937_64 random(31);
        this->split_to(random_cells<D>(random, 30, D == 2 ? 6 : 4));
        const Host h = this->host->host();
        OctreeEdit<D> edit(h, this->header, this->memory, this->memory);
        for (const Octant<D> &leaf : this->list()) {
            const double value = by_level ? leaf.level : 1;
            edit.set_at(leaf.code, &value);
        }
        edit.set(this->header);
    }
};

abacus_drawing drawing(int width, int height) {
    abacus_drawing drawing{};
    drawing.width = width;
    drawing.height = height;
    drawing.range[1] = 8;
    return drawing;
}

TEST(OctreePortrait, has_the_colour_of_the_leaf_at_each_place) {
    const Pictured<2> octree(true);
    const Host h = octree.host->host();
    // Pixels have the size of the smallest leaves.
    const Image all = image(draw_octree(h, octree.header, drawing(64, 64)));
    const auto leaves = octree.list();
    std::map<int, std::uint32_t> colours;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const Cell<2> cell{static_cast<std::uint32_t>(axis_cells<2> / 64) * x,
                               static_cast<std::uint32_t>(axis_cells<2> / 64) * (63 - y)};
            const auto leaf = std::find_if(leaves.begin(), leaves.end(), [&](const auto &octant) {
                return octant.contains(morton<2>(cell));
            });
            const auto known = colours.emplace(leaf->level, all(x, y)).first;
            ASSERT_LE(difference(known->second, all(x, y)), 1) << x << ' ' << y;
        }
    EXPECT_GE(colours.size(), 4u);
    // A window shows a part of it.
    abacus_drawing part = drawing(16, 16);
    part.lower[0] = 0.25;
    part.lower[1] = 0.5;
    part.upper[0] = 0.5;
    part.upper[1] = 0.75;
    const Image window = image(draw_octree(h, octree.header, part));
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) ASSERT_LE(difference(window(x, y), all(16 + x, 16 + y)), 1);
}

TEST(OctreePortrait, leaves_out_what_is_long_or_beside_the_window) {
    const Pictured<2> octree(false);
    const Host h = octree.host->host();
    abacus_drawing d = drawing(32, 32);
    EXPECT_FALSE(draw_octree(h, octree.header, d).is_blank);
    d.extent.max_edge = 1e-3;
    EXPECT_TRUE(draw_octree(h, octree.header, d).is_blank);
    d = drawing(32, 32);
    d.lower[0] = d.lower[1] = 2;
    d.upper[0] = d.upper[1] = 3;
    EXPECT_TRUE(draw_octree(h, octree.header, d).is_blank);
    d.attribute = 1;
    EXPECT_THROW(draw_octree(h, octree.header, d), Error);
}

// Sections of leaves tile the plane: with one value everywhere the picture has one colour.
TEST(OctreePortrait, has_sections_without_gap_or_overlap) {
    const Pictured<3> octree(false);
    const Host h = octree.host->host();
    int n = 0;
    for (const Point<3> &normal : {Point<3>{1, 0, 0}, Point<3>{0, 1, 0}, Point<3>{0, 0, 1},
                                   Point<3>{1, 1, 1}, Point<3>{1, -2, 3}, Point<3>{0, 1, 1}})
        for (const double at : {0.5, 0.375, 0.3, 0.71}) {
            abacus_section section{{at, at, at}, {normal[0], normal[1], normal[2]}, 1};
            abacus_drawing d = drawing(48, 48);
            for (int i = 0; i < 3; ++i) {
                d.lower[i] = at - 0.05;
                d.upper[i] = at + 0.05;
            }
            const Image picture = image(draw_octree_section(h, octree.header, section, d));
            for (const std::uint32_t pixel : picture.pixels)
                ASSERT_LE(difference(pixel, picture(24, 24)), 1) << n;
            ++n;
        }
    // The sides of the domain are visible, and nothing beyond.
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {0.0, 1.0, -0.001, 1.001}) {
            abacus_section section{{0.5, 0.5, 0.5}, {}, 1};
            section.through[axis] = side;
            section.normal[axis] = 1;
            const Portrait portrait =
                draw_octree_section(h, octree.header, section, drawing(20, 20));
            const bool is_inside = side == 0 || side == 1;
            ASSERT_EQ(portrait.is_blank, !is_inside);
            const Image picture = image(portrait);
            for (const std::uint32_t pixel : picture.pixels) ASSERT_EQ(pixel, picture(10, 10));
        }
}

} // namespace
} // namespace abacus::test
