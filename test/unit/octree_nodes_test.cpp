// Nodes, anchors and elements of octrees, compared with a table of all corners.
#include "octree/octree_nodes.hpp"
#include "support/octrees.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace abacus::test {
namespace {

template <class T> class OctreeNodesOf : public testing::Test {};
TYPED_TEST_SUITE(OctreeNodesOf, Dimensions);

template <int D> struct Extracted {
    std::vector<typename OctreeNodes<D>::Node> nodes;
    std::vector<std::array<std::uint64_t, Octant<D>::children>> elements;
    std::vector<Octant<D>> leaves;

    explicit Extracted(StoredOctree<D> &octree, std::size_t memory = 1) {
        const Host h = octree.host->host();
        OctreeNodes<D> list(h, octree.header, memory);
        for (typename OctreeNodes<D>::Node node; list.next(node);) nodes.push_back(node);
        OctreeElements<D> all(h, octree.header, memory);
        for (std::array<std::uint64_t, Octant<D>::children> corners; all.next(corners);) {
            elements.push_back(corners);
            leaves.push_back(all.scan().leaf());
        }
        EXPECT_TRUE(octree.host->spools.empty());
        EXPECT_THAT(octree.host->violations, testing::IsEmpty());
    }
};

/// Whether a leaf has a point that is not one of its corners.
template <int D> bool hangs_on(const Octant<D> &leaf, const GridPoint<D> &point) {
    bool is_corner = true;
    const Cell<D> cell = leaf.cell();
    for (int i = 0; i < D; ++i) {
        if (point[i] < cell[i] || point[i] > cell[i] + leaf.edge()) return false;
        is_corner = is_corner && (point[i] == cell[i] || point[i] == cell[i] + leaf.edge());
    }
    return !is_corner;
}

TYPED_TEST(OctreeNodesOf, are_the_corners_of_leaves) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(11);
    for (const int kind : {0, 1, 2}) {
        StoredOctree<D> octree;
        auto cells = random_cells<D>(random, D == 2 ? 40 : 8, D == 2 ? 7 : 5);
        if (kind == 0) cells.clear();
        if (kind == 2) cells = {{domain_cells<D> / 2 - 1, D == 2 ? finest_level<D> : 9}};
        octree.split_to(cells);
        octree.balance(D);
        const Extracted<D> extracted(octree);
        ASSERT_EQ(extracted.leaves, octree.list());

        std::set<GridPoint<D>> points;
        for (const Octant<D> &leaf : extracted.leaves)
            for (int i = 0; i < Octant<D>::children; ++i) points.insert(corner<D>(leaf, i));
        ASSERT_EQ(extracted.nodes.size(), points.size());
        for (std::size_t n = 0; n < extracted.nodes.size(); ++n) {
            const auto &node = extracted.nodes[n];
            ASSERT_EQ(node.number, n);
            ASSERT_EQ(points.erase(node.point), 1u);
            const auto coarse =
                std::find_if(extracted.leaves.begin(), extracted.leaves.end(),
                             [&](const Octant<D> &leaf) { return hangs_on<D>(leaf, node.point); });
            ASSERT_EQ(node.anchors != 0, coarse != extracted.leaves.end());
            // Anchors do not hang, are corners of the larger leaf, and the node is in their middle.
            std::set<std::uint64_t> anchors;
            GridPoint<D> sum{};
            for (int i = 0; i < node.anchors; ++i) {
                const auto &anchor = extracted.nodes[node.anchor[i]];
                EXPECT_EQ(anchor.anchors, 0);
                EXPECT_FALSE(hangs_on<D>(*coarse, anchor.point));
                anchors.insert(anchor.number);
                for (int axis = 0; axis < D; ++axis) sum[axis] += anchor.point[axis];
            }
            ASSERT_EQ(anchors.size(), static_cast<std::size_t>(node.anchors));
            for (int axis = 0; axis < D; ++axis)
                EXPECT_EQ(sum[axis], static_cast<std::uint64_t>(node.anchors) * node.point[axis]);
        }
        for (std::size_t e = 0; e < extracted.elements.size(); ++e)
            for (int i = 0; i < Octant<D>::children; ++i)
                ASSERT_EQ(extracted.nodes[extracted.elements[e][i]].point,
                          corner<D>(extracted.leaves[e], i));
    }
}

TYPED_TEST(OctreeNodesOf, need_balance) {
    constexpr int D = TypeParam::value;
    StoredOctree<D> octree;
    octree.split_to({{domain_cells<D> / 2 - 1, 5}});
    try {
        Extracted<D> extracted(octree);
        FAIL() << "not refused";
    } catch (const Error &error) {
        EXPECT_EQ(error.kind, ABACUS_ERROR_STATE);
        EXPECT_STREQ(error.what(), "the octree is not balanced");
    }
}

} // namespace
} // namespace abacus::test
