// Octrees as triangles and tetrahedra: these fill each leaf, and fit together.
#include "octree/octree_simplices.hpp"
#include "support/octrees.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace abacus::test {
namespace {

template <class T> class OctreeSimplicesOf : public testing::Test {};
TYPED_TEST_SUITE(OctreeSimplicesOf, Dimensions);

template <int D> using Corners = std::array<std::uint64_t, D + 1>;

template <int D> struct Mesh {
    std::vector<GridPoint<D>> nodes;
    std::vector<std::pair<std::uint64_t, Corners<D>>> simplices; // with their elements' numbers

    explicit Mesh(StoredOctree<D> &octree, std::size_t memory = 1) {
        const Host h = octree.host->host();
        OctreeNodes<D> list(h, octree.header, memory);
        for (typename OctreeNodes<D>::Node node; list.next(node);) nodes.push_back(node.point);
        OctreeSimplices<D> all(h, octree.header, memory);
        std::uint64_t element;
        for (Corners<D> corners; all.next(element, corners);)
            simplices.push_back({element, corners});
        EXPECT_TRUE(octree.host->spools.empty());
        EXPECT_THAT(octree.host->violations, testing::IsEmpty());
    }
    /// Twice the area, or six times the volume, in units of the grid's lines.
    __int128 size(const Corners<D> &corners) const {
        std::array<std::array<__int128, D>, D> edge;
        for (int i = 0; i < D; ++i)
            for (int k = 0; k < D; ++k)
                edge[i][k] = static_cast<__int128>(nodes[corners[i + 1]][k]) -
                             static_cast<__int128>(nodes[corners[0]][k]);
        if constexpr (D == 2)
            return edge[0][0] * edge[1][1] - edge[0][1] * edge[1][0];
        else
            return edge[0][0] * (edge[1][1] * edge[2][2] - edge[1][2] * edge[2][1]) -
                   edge[0][1] * (edge[1][0] * edge[2][2] - edge[1][2] * edge[2][0]) +
                   edge[0][2] * (edge[1][0] * edge[2][1] - edge[1][1] * edge[2][0]);
    }
    /// Whether all nodes lie on one side of the domain.
    bool is_outer(const std::vector<std::uint64_t> &facet) const {
        for (int axis = 0; axis < D; ++axis)
            for (const std::uint64_t side : {std::uint64_t{0}, axis_cells<D>})
                if (std::all_of(facet.begin(), facet.end(),
                                [&](std::uint64_t n) { return nodes[n][axis] == side; }))
                    return true;
        return false;
    }
};

template <int D> void expect_conforming(StoredOctree<D> &octree) {
    const Mesh<D> mesh(octree);
    const auto leaves = octree.list();
    std::vector<__int128> sizes(leaves.size());
    std::map<std::vector<std::uint64_t>, int> facets;
    std::vector<bool> is_used(mesh.nodes.size());
    std::uint64_t last = 0;
    for (const auto &[element, corners] : mesh.simplices) {
        ASSERT_LT(element, leaves.size());
        ASSERT_LE(last, element);
        last = element;
        ASSERT_GT(mesh.size(corners), 0);
        sizes[element] += mesh.size(corners);
        for (int i = 0; i <= D; ++i) {
            std::vector<std::uint64_t> facet(corners.begin(), corners.end());
            facet.erase(facet.begin() + i);
            std::sort(facet.begin(), facet.end());
            ++facets[facet];
            is_used[corners[i]] = true;
        }
        // The least one comes first; in space the least of the others comes second.
        ASSERT_EQ(corners[0], *std::min_element(corners.begin(), corners.end()));
        if (D == 3) {
            ASSERT_EQ(corners[1], *std::min_element(corners.begin() + 1, corners.end()));
        }
    }
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        __int128 size = D == 2 ? 2 : 6;
        for (int k = 0; k < D; ++k) size *= leaves[i].edge();
        ASSERT_TRUE(sizes[i] == size) << i;
    }
    for (const auto &[facet, n] : facets) ASSERT_EQ(n, mesh.is_outer(facet) ? 1 : 2);
    EXPECT_EQ(std::count(is_used.begin(), is_used.end(), false), 0);
}

TYPED_TEST(OctreeSimplicesOf, fill_leaves_and_fit_together) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(21);
    for (int kind = 0; kind < 12; ++kind) {
        StoredOctree<D> octree;
        auto cells = random_cells<D>(random, 2 + 4 * kind, D == 2 ? 8 : 5);
        if (kind == 0) cells.clear();
        if (kind == 1) cells = {{domain_cells<D> / 2 - 1, D == 2 ? finest_level<D> : 12}};
        if (kind == 2) cells = {{0, 6}, {domain_cells<D> - 1, 6}};
        octree.split_to(cells);
        octree.balance(kind % 2 == 0 ? D : D - 1);
        expect_conforming<D>(octree);
    }
}

// In the plane all ways in which smaller leaves can touch a leaf; in space many of them.
TYPED_TEST(OctreeSimplicesOf, fill_a_leaf_with_any_leaves_around) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(22);
    for (int n = 0; n < (D == 2 ? 256 : 400); ++n) {
        StoredOctree<D> octree;
        std::vector<std::pair<std::uint64_t, int>> cells;
        int number = 0;
        for (const Direction<D> &way : OctreeModel<D>::ways(D)) {
            Cell<D> cell;
            for (int i = 0; i < D; ++i)
                cell[i] = static_cast<std::uint32_t>(axis_cells<D> / 4) *
                          static_cast<std::uint32_t>(1 + way[i]);
            const bool is_split = D == 2 ? (n >> number & 1) != 0 : random() % 3 == 0;
            cells.push_back({morton<D>(cell), is_split ? 3 : 2});
            ++number;
        }
        octree.split_to(cells);
        expect_conforming<D>(octree);
    }
}

TYPED_TEST(OctreeSimplicesOf, are_refused_where_leaves_are_not_balanced) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(23);
    int refused = 0;
    for (int n = 0; n < 40; ++n) {
        StoredOctree<D> octree;
        octree.split_to(random_cells<D>(random, 1 + n % 5, 4));
        OctreeModel<D> model;
        for (const Octant<D> &leaf : octree.list()) model.split_to(leaf.code, leaf.level);
        model.balance(D - 1);
        const bool is_balanced = model.list() == octree.list();
        const auto extract = [&] { Mesh<D> mesh(octree); };
        if (is_balanced)
            expect_conforming<D>(octree);
        else
            EXPECT_THROW(extract(), Error);
        refused += !is_balanced;
    }
    EXPECT_GT(refused, 5);
}

TYPED_TEST(OctreeSimplicesOf, come_in_any_memory) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(24);
    StoredOctree<D> octree;
    octree.split_to(random_cells<D>(random, 500, D == 2 ? 8 : 5));
    octree.balance(D);
    EXPECT_EQ(Mesh<D>(octree, 1).simplices, Mesh<D>(octree, std::size_t{1} << 28).simplices);
}

} // namespace
} // namespace abacus::test
