// Octrees against a model in memory: growth, balance, places, windows, neighbours, edits.
#include "octree/octree_edit.hpp"
#include "octree/octree_load.hpp"
#include "octree/octree_scan.hpp"
#include "support/octrees.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace abacus::test {
namespace {

template <class T> class Octrees : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Octrees, Dimensions);

TYPED_TEST(Octrees, octants_are_arithmetic) {
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

TYPED_TEST(Octrees, are_grown_to_levels) {
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
            ASSERT_EQ(octree.header.leaves, model.leaves.size());
            expect_sound(octree);
        }
    }
}

TYPED_TEST(Octrees, are_balanced_as_little_as_can_be) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(3);
    for (int across = 1; across <= D; ++across)
        for (const int kind : {0, 1, 2, 3}) {
            StoredOctree<D> octree;
            OctreeModel<D> model;
            auto cells = random_cells<D>(random, kind == 0 ? 30 : 2, kind == 0 ? 7 : 12);
            // One deep corner: by the middle of the domain, and by a corner of it.
            if (kind == 2) cells = {{domain_cells<D> / 2 - 1, finest_level<D>}};
            if (kind == 3) cells = {{0, finest_level<D>}, {domain_cells<D> - 1, 9}};
            octree.split_to(cells);
            for (const auto &[cell, level] : cells) model.split_to(cell, level);
            octree.balance(across);
            model.balance(across);
            ASSERT_EQ(octree.list(), model.list()) << across << ' ' << kind;
            ASSERT_EQ(octree.header.leaves, model.leaves.size());
            expect_sound(octree);
        }
}

TYPED_TEST(Octrees, hold_so_many_points_in_a_leaf) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(4);
    for (const std::uint64_t most : {1, 3, 40}) {
        StoredOctree<D> octree;
        octree.header.levels = 12;
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

TYPED_TEST(Octrees, are_as_fine_as_a_function_tells) {
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
        .to_sizes(size_near_center<D>, &sizes, octree.header);
    for (bool done = false; !done;) {
        done = true;
        for (const Octant<D> &leaf : model.list()) {
            const Point<D> center = Grid<D>(octree.header).center(leaf);
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

TYPED_TEST(Octrees, locate_and_keep_attributes) {
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

TYPED_TEST(Octrees, give_the_leaves_of_a_window) {
    constexpr int D = TypeParam::value;
    Coded<D> octree;
    const Host h = octree.host->host();
    const Grid<D> grid(octree.header);
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
}

TYPED_TEST(Octrees, know_the_neighbours_of_a_leaf) {
    constexpr int D = TypeParam::value;
    Coded<D> octree;
    const Host h = octree.host->host();
    OctreeReader<D> reader(h, octree.header, std::size_t{1} << 20);
    const auto leaves = octree.model.list();
    for (int round = 0; round < 40; ++round) {
        const Octant<D> leaf = octree.model.find(octree.random() % domain_cells<D>);
        std::set<std::tuple<int, int, std::uint64_t>> expected, found;
        for (const Octant<D> &other : leaves) {
            // Boxes that overlap on all axes but one, where one ends and the other begins.
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

TYPED_TEST(Octrees, are_split_and_merged_in_place) {
    constexpr int D = TypeParam::value;
    Coded<D> octree;
    const Host h = octree.host->host();
    OctreeModel<D> &model = octree.model;
    {
        OctreeCache<D> cache(h, octree.header, std::size_t{1} << 18);
        for (int round = 0; round < 600; ++round) {
            const std::uint64_t cell = octree.random() % domain_cells<D>;
            const Octant<D> leaf = model.find(cell);
            if (octree.random() % 2 == 0 && leaf.level < finest_level<D>) {
                cache.split(cache.find(cell));
                model.split(leaf);
            } else {
                const int level = static_cast<int>(octree.random() % 9) + (D == 2 ? 2 : 1);
                const auto merged = Octant<D>{cell, finest_level<D>}.ancestor(level);
                ASSERT_EQ(cache.merge(merged), model.merge(merged));
            }
            if (round % 50 == 0) {
                ASSERT_EQ(cache.check_invariants(), nullptr);
            }
        }
        cache.flush();
    }
    octree.header.leaves = model.leaves.size();
    ASSERT_EQ(octree.list(), model.list());
    expect_sound(octree);
    // And as a whole.
    OctreeEdit<D> edit(h, octree.header, octree.memory, std::size_t{1} << 18);
    edit.merge_at({}, 0);
    EXPECT_EQ(edit.merge(octree.header), model.leaves.size());
    EXPECT_EQ(octree.list(), std::vector<Octant<D>>(1));
    expect_sound(octree);
}

// Merged across the borders of pages, a leaf ends beyond its page, and pages behind it are empty.
TYPED_TEST(Octrees, are_grown_again_where_leaves_were_merged_across_pages) {
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
        EXPECT_EQ(octree.header.leaves, model.leaves.size());
        expect_sound(octree);
    }
}

TYPED_TEST(Octrees, are_what_a_model_is_after_changes_at_random) {
    constexpr int D = TypeParam::value;
    for (unsigned seed = 0; seed < 6; ++seed) {
        std::mt19937_64 random(seed);
        StoredOctree<D> octree(seed % 3);
        OctreeModel<D> model;
        octree.header.levels = D == 2 ? 11 : 7;
        for (int step = 0; step < 40; ++step) {
            const int n = 1 << random() % 10;
            const auto cells = random_cells<D>(random, n, static_cast<int>(octree.header.levels));
            switch (random() % 4) {
            case 0:
                octree.split_to(cells);
                for (const auto &[cell, level] : cells) model.split_to(cell, level);
                break;
            case 1: {
                std::vector<std::uint64_t> points;
                for (const auto &[cell, level] : cells) points.push_back(cell >> (3 * level));
                const std::uint64_t most = 1 + random() % 20;
                octree.split_to_points(points, most);
                model.split_to_points(points, most, static_cast<int>(octree.header.levels));
                break;
            }
            case 2: {
                const int across = 1 + static_cast<int>(random() % D);
                octree.balance(across);
                model.balance(across);
                break;
            }
            default: {
                std::vector<Octant<D>> octants;
                for (const auto &[cell, level] : cells)
                    octants.push_back(Octant<D>{cell, finest_level<D>}.ancestor(
                        std::max(level, step % 8 == 0 ? 0 : 3)));
                std::uint64_t merged = 0;
                std::sort(octants.begin(), octants.end(), [](const auto &a, const auto &b) {
                    return a.code != b.code ? a.code < b.code : a.level < b.level;
                });
                for (const Octant<D> &octant : octants) {
                    const std::uint64_t leaves = model.merge(octant);
                    if (leaves > 1) merged += leaves;
                }
                std::shuffle(octants.begin(), octants.end(), random);
                EXPECT_EQ(octree.merge(octants, random() % 2 ? 1 : octree.memory), merged);
            }
            }
            ASSERT_EQ(octree.header.leaves, model.leaves.size()) << seed << ' ' << step;
            ASSERT_EQ(octree.list(), model.list()) << seed << ' ' << step;
            expect_sound(octree);
        }
    }
}

TYPED_TEST(Octrees, keep_the_last_of_several_rows_of_a_leaf) {
    constexpr int D = TypeParam::value;
    StoredOctree<D> octree(1);
    octree.split_to({{0, 2}});
    const Octant<D> leaf = octree.list().back();
    const Host h = octree.host->host();
    OctreeEdit<D> edit(h, octree.header, octree.memory, octree.memory);
    double value = 0;
    for (const std::uint64_t at : {leaf.end() - 1, leaf.code, leaf.end() - 2, leaf.code + 1}) {
        ++value;
        edit.set_at(at, &value);
    }
    EXPECT_EQ(edit.set(octree.header), 1u);
    OctreeReader<D> reader(h, octree.header, octree.memory);
    EXPECT_EQ(reader.cache().values(reader.find(leaf.code))[0], 4);
}

TYPED_TEST(Octrees, are_grown_in_place_at_few_places) {
    constexpr int D = TypeParam::value;
    Coded<D> octree;
    octree.host->calls = {};
    const auto pages = octree.host->pages.size();
    const auto cells = random_cells<D>(octree.random, 2, D == 2 ? 14 : 11);
    octree.split_to(cells);
    EXPECT_LE(octree.host->calls.find + octree.host->calls.next, 4u) << "of " << pages;
    for (const auto &[cell, level] : cells) octree.model.split_to(cell, level);
    EXPECT_EQ(octree.list(), octree.model.list());
    EXPECT_EQ(octree.header.leaves, octree.model.leaves.size());
    expect_sound(octree);
}

TYPED_TEST(Octrees, are_loaded_leaf_by_leaf) {
    constexpr int D = TypeParam::value;
    Coded<D> octree;
    auto leaves = octree.model.list();
    std::uint64_t pages = 1;
    const auto load = [&](const std::vector<Octant<D>> &rows) {
        StoredOctree<D> loaded(1);
        if (pages > 1) loaded.spread_root(pages);
        const Host h = loaded.host->host();
        OctreeLoad<D> load(h, loaded.header, loaded.memory);
        for (const Octant<D> &row : rows) {
            const double value = row.level;
            load.add(row.code, row.level, &value);
        }
        load.write(loaded.header);
        expect_sound(loaded);
        LeafScan<D> scan(h, loaded.header);
        while (scan.next()) EXPECT_EQ(scan.values()[0], scan.leaf().level);
        return loaded.list();
    };
    std::vector<Octant<D>> shuffled = leaves;
    std::shuffle(shuffled.begin(), shuffled.end(), octree.random);
    EXPECT_EQ(load(shuffled), leaves);
    pages = 64; // those of leaves that were merged are given back
    EXPECT_EQ(load(shuffled), leaves);
    EXPECT_EQ(load({{}}), std::vector<Octant<D>>(1));

    const auto detail = [&](const std::vector<Octant<D>> &rows) -> std::string {
        try {
            load(rows);
        } catch (const Error &error) {
            EXPECT_EQ(error.kind, ABACUS_ERROR_ARGUMENT);
            return error.detail;
        }
        return "no error";
    };
    auto rows = leaves;
    rows.erase(rows.begin() + 3);
    EXPECT_EQ(detail(rows), "There is a gap before the octant of row 4, behind that of row 3.");
    rows = leaves;
    rows.push_back(leaves[7].parent());
    EXPECT_THAT(detail(rows), testing::HasSubstr("overlaps that of row"));
    rows = leaves;
    rows.pop_back();
    EXPECT_THAT(detail(rows), testing::HasSubstr("There is a gap behind the octant of row"));
    EXPECT_EQ(detail({}), "There are none.");
    EXPECT_EQ(detail({leaves.begin() + 1, leaves.end()}),
              "There is a gap before the octant of row 1.");
}

} // namespace
} // namespace abacus::test
