// Growth of octrees, compared with a model in memory: levels, balance, points, sizes.
#include "support/octrees.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace abacus::test {
namespace {

template <class T> class OctreesGrown : public testing::Test {};
TYPED_TEST_SUITE(OctreesGrown, Dimensions);

TYPED_TEST(OctreesGrown, are_grown_to_levels) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(2);
    for (const int n : {0, 1, 20, 500}) {
        StoredOctree<D> octree;
        OctreeModel<D> model;
        for (int round = 0; round < 3; ++round) {
            const auto cells = random_cells<D>(random, n, round == 2 ? finest_level<D> : 6);
            octree.split_to(cells);
            for (const auto &[cell, level] : cells) model.split_to(cell, level);
            ASSERT_EQ(octree.list(), model.list());
            ASSERT_EQ(octree.header.facts.census.leaves, model.leaves.size());
            expect_sound(octree);
        }
    }
}

TYPED_TEST(OctreesGrown, are_balanced_as_little_as_can_be) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(3);
    for (int across = 1; across <= D; ++across)
        for (const int kind : {0, 1, 2, 3}) {
            StoredOctree<D> octree;
            OctreeModel<D> model;
            auto cells = random_cells<D>(random, kind == 0 ? 30 : 2, kind == 0 ? 7 : 12);
            // One deep corner: at the middle of the domain, or at a corner of it.
            if (kind == 2) cells = {{domain_cells<D> / 2 - 1, finest_level<D>}};
            if (kind == 3) cells = {{0, finest_level<D>}, {domain_cells<D> - 1, 9}};
            octree.split_to(cells);
            for (const auto &[cell, level] : cells) model.split_to(cell, level);
            octree.balance(across);
            model.balance(across);
            ASSERT_EQ(octree.list(), model.list()) << across << ' ' << kind;
            ASSERT_EQ(octree.header.facts.census.leaves, model.leaves.size());
            expect_sound(octree);
        }
}

TYPED_TEST(OctreesGrown, hold_so_many_points_in_a_leaf) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(4);
    for (const std::uint64_t most : {1, 3, 40}) {
        StoredOctree<D> octree;
        octree.header.facts.form.levels = 12;
        OctreeModel<D> model;
        std::vector<std::uint64_t> cells;
        for (int i = 0; i < 2000; ++i)
            cells.push_back(random() % (domain_cells<D> >> (random() % 40)));
        cells.resize(2100, cells[0]); // the same place, again and again
        octree.split_to_points(cells, most);
        model.split_to_points(cells, most, 12);
        ASSERT_EQ(octree.list(), model.list());
        expect_sound(octree);
    }
}

TYPED_TEST(OctreesGrown, are_as_fine_as_a_function_tells) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(5);
    StoredOctree<D> octree;
    OctreeModel<D> model;
    const auto cells = random_cells<D>(random, 20, 4);
    octree.split_to(cells);
    for (const auto &[cell, level] : cells) model.split_to(cell, level);
    const Host h = octree.host->host();
    SizesAsked sizes;
    Growth<D>(h, octree.header, StoredOctree<D>::memory)
        .to_sizes(size_near_center<D>, &sizes, 1, octree.header);
    for (bool done = false; !done;) {
        done = true;
        for (const Octant<D> &leaf : model.list()) {
            const Point<D> center = Grid<D>(octree.header.facts.form).center(leaf);
            const double *centers[D];
            for (int i = 0; i < D; ++i) centers[i] = &center[i];
            double size;
            SizesAsked ignored;
            size_near_center<D>(&ignored, 1, centers, nullptr, &size);
            if (std::ldexp(1.0, -leaf.level) <= size) continue;
            model.split(leaf);
            done = false;
        }
    }
    ASSERT_EQ(octree.list(), model.list());
    EXPECT_GT(sizes.asked, model.leaves.size() / 2);
    expect_sound(octree);
}

// After merges across the borders of pages, a leaf ends beyond its page, and later pages are empty.
TYPED_TEST(OctreesGrown, are_grown_again_where_leaves_were_merged_across_pages) {
    constexpr int D = TypeParam::value;
    for (const int kind : {0, 1, 2, 3}) {
        Coded<D> octree;
        OctreeModel<D> &model = octree.model;
        for (int i = 0; i < Octant<D>::children; ++i) {
            const auto part = Octant<D>{}.child(i);
            EXPECT_EQ(octree.merge({part}), model.merge(part));
        }
        if (kind == 3) {
            octree.merge({{}});
            model.merge({});
            octree.spread_root(64);
        }
        expect_sound(octree);
        std::vector<std::uint64_t> cells;
        for (int i = 0; i < 300; ++i) cells.push_back(octree.random() % domain_cells<D>);
        if (kind == 0) {
            octree.split_to({{cells[0], 9}});
            model.split_to(cells[0], 9);
        } else if (kind == 1) {
            octree.split_to_points(cells, 2);
            model.split_to_points(cells, 2, finest_level<D>);
        } else {
            octree.split_to({{domain_cells<D> / 2 - 1, finest_level<D>}});
            model.split_to(domain_cells<D> / 2 - 1, finest_level<D>);
            octree.balance(D);
            model.balance(D);
        }
        ASSERT_EQ(octree.list(), model.list()) << kind;
        EXPECT_EQ(octree.header.facts.census.leaves, model.leaves.size());
        expect_sound(octree);
    }
}

TYPED_TEST(OctreesGrown, are_grown_in_place_at_few_places) {
    constexpr int D = TypeParam::value;
    Coded<D> octree;
    octree.host->calls = {};
    const auto pages = octree.host->pages.size();
    const auto cells = random_cells<D>(octree.random, 2, D == 2 ? 14 : 11);
    octree.split_to(cells);
    EXPECT_LE(octree.host->calls.find + octree.host->calls.next, 4u) << "of " << pages;
    for (const auto &[cell, level] : cells) octree.model.split_to(cell, level);
    EXPECT_EQ(octree.list(), octree.model.list());
    EXPECT_EQ(octree.header.facts.census.leaves, octree.model.leaves.size());
    expect_sound(octree);
}

} // namespace
} // namespace abacus::test
