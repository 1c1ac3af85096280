// Reading octrees, compared with a model or brute force: places, windows, neighbours.
#include "octree/octree_scan.hpp"
#include "support/octrees.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace abacus::test {
namespace {

template <class T> class OctreesRead : public testing::Test {};
TYPED_TEST_SUITE(OctreesRead, Dimensions);

TYPED_TEST(OctreesRead, octants_are_arithmetic) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(1);
    for (int i = 0; i < 10000; ++i) {
        const std::uint64_t cell = random() % domain_cells<D>, other = random() % domain_cells<D>;
        const int level = static_cast<int>(random() % finest_level<D>);
        const auto octant = Octant<D>{cell, finest_level<D>}.ancestor(level);
        ASSERT_EQ(morton<D>(octant.cell()), octant.code);
        ASSERT_TRUE(octant.contains(cell) && octant.is_aligned());
        const int child = static_cast<int>(random() % Octant<D>::children);
        ASSERT_EQ(octant.child(child).parent(), octant);
        ASSERT_EQ(octant.child(child).number(), child);
        int common = 0;
        while (common < finest_level<D> &&
               Octant<D>{cell, finest_level<D>}.ancestor(common + 1).contains(other))
            ++common;
        ASSERT_EQ(nearest_common<D>(cell, other).level, common);
    }
}

TYPED_TEST(OctreesRead, locate_and_keep_attributes) {
    constexpr int D = TypeParam::value;
    Coded<D> octree;
    const Host h = octree.host->host();
    for (const std::size_t budget : {std::size_t{1}, std::size_t{1} << 22}) {
        OctreeReader<D> reader(h, octree.header, budget);
        for (int i = 0; i < 2000; ++i) {
            const std::uint64_t cell = octree.random() % domain_cells<D>;
            const Handle found = reader.locate(octree.place(cell));
            const Octant<D> leaf = reader.cache().octant(found);
            ASSERT_EQ(leaf, octree.model.find(cell));
            ASSERT_EQ(reader.cache().values(found)[0], static_cast<double>(leaf.code >> 12));
            ASSERT_EQ(reader.cache().values(found)[1], leaf.level + 0.1);
        }
        Point<D> outside{};
        outside[D - 1] = 1.5;
        EXPECT_EQ(reader.locate(outside), no_handle);
        outside[D - 1] = 1;
        EXPECT_NE(reader.locate(outside), no_handle) << "the upper end belongs to the last leaf";
    }
    expect_sound(octree);
}

TYPED_TEST(OctreesRead, give_all_leaves_and_those_of_a_window) {
    constexpr int D = TypeParam::value;
    Coded<D> octree;
    const Host h = octree.host->host();
    const Grid<D> grid(octree.header.facts.form);
    for (int round = 0; round < 60; ++round) {
        Point<D> lower, upper;
        for (int i = 0; i < D; ++i) {
            lower[i] = static_cast<double>(octree.random() % 1000) / 900 - 0.05;
            upper[i] = lower[i] + static_cast<double>(octree.random() % 1000) / 3000;
            if (round % 3 == 0) lower[i] = upper[i] = std::round(lower[i] * 8) / 8;
        }
        std::vector<Octant<D>> expected, found;
        for (const Octant<D> &leaf : octree.model.list()) {
            const auto [a, b] = grid.box(leaf);
            bool meets = true;
            for (int i = 0; i < D; ++i)
                meets =
                    meets && a[i] <= upper[i] && (lower[i] < b[i] || (lower[i] == 1 && b[i] == 1));
            if (meets) expected.push_back(leaf);
        }
        OctreeScan<D> scan(h, octree.header, Box<D>(lower, upper), std::size_t{1} << 20);
        Octant<D> leaf;
        for (const double *values; scan.next(leaf, values);) {
            found.push_back(leaf);
            ASSERT_EQ(values[1], leaf.level + 0.1);
        }
        ASSERT_EQ(found, expected) << round;
    }
    std::vector<Octant<D>> found;
    OctreeScan<D> all(h, octree.header);
    Octant<D> leaf;
    for (const double *values; all.next(leaf, values);) {
        found.push_back(leaf);
        ASSERT_EQ(values[1], leaf.level + 0.1);
    }
    EXPECT_EQ(found, octree.model.list());
}

/// Whether a leaf comes near a place; a leaf has its upper sides where the domain ends. Exact here.
template <int D> bool comes_near(const Octant<D> &leaf, const Point<D> &center, double radius) {
    const Cell<D> at = leaf.cell();
    double square = 0;
    bool is_reached = true;
    for (int i = 0; i < D; ++i) {
        const double unit = std::ldexp(1.0, -code_bits<D>);
        const double lower = at[i] * unit;
        const double upper = static_cast<double>(at[i] + leaf.edge()) * unit;
        const double x = std::min(std::max(center[i], lower), upper);
        if (center[i] >= upper && upper < 1) is_reached = false;
        square += (x - center[i]) * (x - center[i]);
    }
    return is_reached ? square <= radius * radius : square < radius * radius;
}

TYPED_TEST(OctreesRead, give_the_leaves_of_a_ball) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(1);
    const AskedOctree<D> octree(1);
    const Host h = octree.host->host();
    const auto leaves = octree.list();
    std::size_t found = 0, touched = 0;
    for (int n = 0; n < 300; ++n) {
        const Point<D> center = random_place<D>(random);
        const double radius = n % 5 == 0 ? 0 : std::ldexp(static_cast<double>(random() % 33), -6);
        std::vector<Octant<D>> expected, scanned;
        for (const Octant<D> &leaf : leaves)
            if (comes_near<D>(leaf, center, radius)) expected.push_back(leaf);
        OctreeScan<D> scan(h, octree.header, Ball<D>{center, radius}, 0);
        Octant<D> leaf;
        for (const double *values; scan.next(leaf, values);) scanned.push_back(leaf);
        ASSERT_EQ(scanned, expected) << n;
        found += expected.size();
        touched += radius == 0 && expected.size() == 1;
    }
    EXPECT_GT(found, 1000u);
    EXPECT_GT(touched, 20u); // a place is in one leaf
}

TYPED_TEST(OctreesRead, know_the_neighbours_of_a_leaf) {
    constexpr int D = TypeParam::value;
    Coded<D> octree;
    const Host h = octree.host->host();
    OctreeReader<D> reader(h, octree.header, std::size_t{1} << 20);
    const auto leaves = octree.model.list();
    for (int round = 0; round < 40; ++round) {
        const Octant<D> leaf = octree.model.find(octree.random() % domain_cells<D>);
        std::set<std::tuple<int, int, std::uint64_t>> expected, found;
        for (const Octant<D> &other : leaves) {
            // Boxes that overlap on all axes but one; there one ends where the other begins.
            const Cell<D> a = leaf.cell(), b = other.cell();
            int axis = -1, side = 0, meets = 0;
            for (int i = 0; i < D; ++i)
                if (a[i] + leaf.edge() == b[i] || b[i] + other.edge() == a[i])
                    axis = i, side = a[i] < b[i] ? 1 : -1;
                else
                    meets += a[i] < b[i] + other.edge() && b[i] < a[i] + leaf.edge();
            if (axis >= 0 && meets == D - 1) expected.insert({axis, side, other.code});
        }
        reader.neighbours(leaf.code, [&](int axis, int side, Handle other) {
            EXPECT_TRUE(found.insert({axis, side, reader.cache().octant(other).code}).second);
        });
        ASSERT_EQ(found, expected);
    }
}

} // namespace
} // namespace abacus::test
