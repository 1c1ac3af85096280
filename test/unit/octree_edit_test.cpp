// Changes of octrees, compared with a model in memory: leaves split and merged in place,
// attributes, loading.
#include "octree/octree_edit.hpp"
#include "octree/octree_load.hpp"
#include "support/octrees.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace abacus::test {
namespace {

template <class T> class OctreesEdited : public testing::Test {};
TYPED_TEST_SUITE(OctreesEdited, Dimensions);

TYPED_TEST(OctreesEdited, are_split_and_merged_in_place) {
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
    octree.header.facts.census.leaves = model.leaves.size();
    ASSERT_EQ(octree.list(), model.list());
    expect_sound(octree);
    // Then the whole octree.
    OctreeEdit<D> edit(h, octree.header, octree.memory, std::size_t{1} << 18);
    edit.merge_at({}, 0);
    EXPECT_EQ(edit.merge(octree.header), model.leaves.size());
    EXPECT_EQ(octree.list(), std::vector<Octant<D>>(1));
    expect_sound(octree);
}

TYPED_TEST(OctreesEdited, are_what_a_model_is_after_changes_at_random) {
    constexpr int D = TypeParam::value;
    for (unsigned seed = 0; seed < 6; ++seed) {
        std::mt19937_64 random(seed);
        StoredOctree<D> octree(seed % 3);
        OctreeModel<D> model;
        octree.header.facts.form.levels = D == 2 ? 11 : 7;
        for (int step = 0; step < 40; ++step) {
            const int n = 1 << random() % 10;
            const auto cells =
                random_cells<D>(random, n, static_cast<int>(octree.header.facts.form.levels));
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
                model.split_to_points(points, most,
                                      static_cast<int>(octree.header.facts.form.levels));
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
            ASSERT_EQ(octree.header.facts.census.leaves, model.leaves.size())
                << seed << ' ' << step;
            ASSERT_EQ(octree.list(), model.list()) << seed << ' ' << step;
            expect_sound(octree);
        }
    }
}

TYPED_TEST(OctreesEdited, keep_the_last_of_several_rows_of_a_leaf) {
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

TYPED_TEST(OctreesEdited, are_loaded_leaf_by_leaf) {
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
    pages = 64; // the pages of merged leaves are returned
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
    EXPECT_EQ(detail(rows), "There is a gap between the octants of row 3 and row 4.");
    rows = leaves;
    rows.push_back(leaves[7].parent());
    EXPECT_THAT(detail(rows), testing::HasSubstr("overlaps that of row"));
    rows = leaves;
    rows.pop_back();
    EXPECT_THAT(detail(rows), testing::HasSubstr("There is a gap after the octant of row"));
    EXPECT_EQ(detail({}), "There are no octants.");
    EXPECT_EQ(detail({leaves.begin() + 1, leaves.end()}),
              "There is a gap before the octant of row 1.");
}

} // namespace
} // namespace abacus::test
