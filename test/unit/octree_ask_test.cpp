// Answers of octrees about places, compared with brute force over all leaves.
#include "octree/octree_interpolation.hpp"
#include "octree/octree_nearest.hpp"
#include "octree/octree_places.hpp"
#include "support/octrees.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace abacus::test {
namespace {

template <class T> class OctreesAsked : public testing::Test {};
TYPED_TEST_SUITE(OctreesAsked, Dimensions);

TYPED_TEST(OctreesAsked, have_nearest_leaves_in_order) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(2);
    const AskedOctree<D> octree(2);
    const Host h = octree.host->host();
    const auto leaves = octree.list();
    OctreeReader<D> reader(h, octree.header, 0);
    OctreeNearest<D> nearest(reader);
    for (int n = 0; n < 60; ++n) {
        const Point<D> place = random_place<D>(random);
        std::vector<std::pair<double, std::uint64_t>> expected, found;
        for (const Octant<D> &leaf : leaves) {
            const auto [lower, upper] = reader.grid().box(leaf);
            double square = 0; // exact: coordinates have few digits
            for (int i = 0; i < D; ++i) {
                const double x = std::clamp(place[i], lower[i], upper[i]) - place[i];
                square += x * x;
            }
            expected.push_back({square, leaf.code});
        }
        std::sort(expected.begin(), expected.end());
        const std::size_t k = n == 0 ? leaves.size() + 5 : 1 + random() % 40;
        nearest.find(place, k, [&](std::uint64_t rank, Handle leaf, double distance) {
            EXPECT_EQ(rank, found.size() + 1);
            const std::uint64_t code = reader.cache().octant(leaf).code;
            EXPECT_NEAR(distance, std::sqrt(expected[found.size()].first), 1e-12);
            found.push_back({expected[found.size()].first, code});
        });
        expected.resize(std::min(k, leaves.size()));
        ASSERT_EQ(found, expected) << n;
    }
}

TYPED_TEST(OctreesAsked, read_few_pages_for_the_nearest_leaf) {
    constexpr int D = TypeParam::value;
    StoredOctree<D> octree(1);
    std::mt19937_64 random(3);
    octree.split_to(random_cells<D>(random, 20000, D == 2 ? 10 : 7));
    const Host h = octree.host->host();
    std::uint64_t pages = 0;
    LeafScan<D> all(h, octree.header);
    while (all.next()) pages = all.pages();
    for (int n = 0; n < 20; ++n) {
        OctreeReader<D> reader(h, octree.header, std::size_t{1} << 24);
        Point<D> place;
        for (double &x : place) x = std::ldexp(static_cast<double>(random() % 1024), -10);
        OctreeNearest<D>(reader).find(place, 1, [](std::uint64_t, Handle, double) {});
        EXPECT_LE(reader.cache().counters.loads, 2u); // two if the leaf begins on the page before
    }
    EXPECT_GT(pages, 10u);
}

/// The value of a node by brute force: from the values at the corners of the largest leaf that
/// touches it without having it as a corner; if there is none, the mean of the leaves around.
template <int D> class SlowValues {
public:
    explicit SlowValues(std::vector<Octant<D>> leaves) : leaves_(std::move(leaves)) {}

    double at(const GridPoint<D> &node) const {
        const Octant<D> *largest = nullptr;
        double sum = 0;
        int n = 0;
        for (const Octant<D> &leaf : leaves_) {
            const Cell<D> at = leaf.cell();
            bool touches = true, is_corner = true;
            for (int i = 0; i < D; ++i) {
                const std::uint64_t upper = at[i] + leaf.edge();
                touches &= at[i] <= node[i] && node[i] <= upper;
                is_corner &= at[i] == node[i] || node[i] == upper;
            }
            if (!touches) continue;
            sum += AskedOctree<D>::first(leaf);
            ++n;
            if (!is_corner && (largest == nullptr || leaf.level < largest->level)) largest = &leaf;
        }
        if (largest == nullptr) return sum / n;
        Point<D> share;
        const Cell<D> at = largest->cell();
        for (int i = 0; i < D; ++i)
            share[i] = static_cast<double>(node[i] - at[i]) / static_cast<double>(largest->edge());
        return inside(*largest, share);
    }
    double inside(const Octant<D> &leaf, const Point<D> &share) const {
        double sum = 0;
        for (int c = 0; c < Octant<D>::children; ++c) {
            double weight = 1;
            for (int i = 0; i < D; ++i) weight *= (c >> i & 1) != 0 ? share[i] : 1 - share[i];
            if (weight > 0) sum += weight * at(corner(leaf, c));
        }
        return sum;
    }

private:
    std::vector<Octant<D>> leaves_;
};

TYPED_TEST(OctreesAsked, have_values_between_leaves) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(4);
    for (const bool is_balanced : {false, true}) {
        AskedOctree<D> octree(4);
        if (is_balanced) {
            octree.balance(D);
            octree.fill();
        }
        const Host h = octree.host->host();
        const SlowValues<D> slow(octree.list());
        OctreeReader<D> reader(h, octree.header, 0);
        const std::uint32_t attributes[] = {1, 0};
        OctreeInterpolation<D> between(reader, attributes, 2);
        int missing = 0;
        for (int n = 0; n < 200; ++n) {
            const Point<D> place = random_place<D>(random);
            double values[2];
            const Handle leaf = reader.locate(place);
            ASSERT_EQ(between.values(place, values), leaf != no_handle);
            if (leaf == no_handle) continue;
            const Octant<D> octant = reader.cache().octant(reader.locate(place));
            const auto [lower, upper] = reader.grid().box(octant);
            Point<D> share;
            for (int i = 0; i < D; ++i) share[i] = (place[i] - lower[i]) / (upper[i] - lower[i]);
            const double expected = slow.inside(octant, share);
            ASSERT_NEAR(values[1], expected, 1e-9 * std::fabs(expected));
            ASSERT_TRUE(std::isnan(values[0]) || values[0] == 7);
            missing += std::isnan(values[0]);
        }
        EXPECT_GT(missing, 0);
    }
}

TYPED_TEST(OctreesAsked, have_values_without_a_step) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(5);
    const AskedOctree<D> octree(5);
    const Host h = octree.host->host();
    OctreeReader<D> reader(h, octree.header, 0);
    const std::uint32_t attributes[] = {0};
    OctreeInterpolation<D> between(reader, attributes, 1);
    int crossed = 0;
    for (const Octant<D> &leaf : octree.list()) {
        if (leaf.code == 0) continue;
        // A place on a lower side, and one just below it.
        const auto [lower, upper] = reader.grid().box(leaf);
        const int axis = static_cast<int>(random() % D);
        if (lower[axis] == 0) continue;
        Point<D> place;
        for (int i = 0; i < D; ++i)
            place[i] = lower[i] + (upper[i] - lower[i]) * static_cast<double>(random() % 8) / 8;
        place[axis] = lower[axis];
        double on, below;
        ASSERT_TRUE(between.values(place, &on));
        place[axis] = std::nextafter(place[axis], 0.0);
        ASSERT_TRUE(between.values(place, &below));
        ASSERT_NEAR(on, below, 1e-6 * std::fabs(on));
        ++crossed;
    }
    EXPECT_GT(crossed, 30);
}

TYPED_TEST(OctreesAsked, answer_many_places_along_the_curve) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(6);
    const AskedOctree<D> octree(6);
    const Host h = octree.host->host();
    std::vector<Point<D>> places;
    for (int n = 0; n < 3000; ++n) places.push_back(random_place<D>(random));
    std::vector<std::int64_t> orders[2];
    for (const bool is_reversed : {false, true}) {
        OctreePlaces<D> all(h, octree.header, 1, 0);
        for (std::size_t n = 0; n < places.size(); ++n) {
            const std::size_t id = is_reversed ? places.size() - 1 - n : n;
            std::array<std::uint64_t, 1 + D> record{id};
            for (int i = 0; i < D; ++i) record[1 + i] = std::bit_cast<std::uint64_t>(places[id][i]);
            all.add(record.data());
        }
        std::uint64_t last = 0;
        all.each([&](std::int64_t id, const Point<D> &place) {
            EXPECT_EQ(place, places[static_cast<std::size_t>(id)]);
            const std::uint64_t code = morton<D>(all.reader().grid().nearest_cell(place));
            EXPECT_LE(last, code);
            last = code;
            orders[is_reversed].push_back(id);
        });
    }
    EXPECT_EQ(orders[0].size(), places.size());
    EXPECT_EQ(orders[0], orders[1]);
}

} // namespace
} // namespace abacus::test
