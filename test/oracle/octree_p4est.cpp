// Compares octrees with p4est: the same octants are refined in both; then balancing must give the
// same leaves, and extraction the same nodes, elements and hanging corners.
#include "octree/octree_nodes.hpp"
#include "oracle/p4est.hpp"
#include "support/octree_model.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <set>

namespace abacus::test {
namespace {

void require(bool condition, const char *what) {
    if (condition) return;
    std::fprintf(stderr, "octrees differ from p4est's: %s\n", what);
    std::exit(1);
}

using Cells = std::vector<std::pair<std::uint64_t, int>>;

template <int D> Octant<D> octant_of(const typename Foreign<D>::Quadrant *quadrant) {
    Cell<D> cell = Foreign<D>::cell(quadrant);
    for (std::uint32_t &x : cell) x <<= finest_level<D> - Foreign<D>::levels;
    return {morton<D>(cell), quadrant->level};
}

/// Whether p4est should split a quadrant: it contains one of the cells, which are sorted, and is
/// coarser.
template <int D>
int is_split(typename Foreign<D>::Forest *forest, p4est_topidx_t,
             typename Foreign<D>::Quadrant *quadrant) {
    const auto &cells = *static_cast<const Cells *>(forest->user_pointer);
    const Octant<D> octant = octant_of<D>(quadrant);
    for (auto it = std::lower_bound(cells.begin(), cells.end(), std::pair{octant.code, 0});
         it != cells.end() && it->first < octant.end(); ++it)
        if (it->second > octant.level) return 1;
    return 0;
}

template <int D> void compare_leaves(StoredOctree<D> &octree, typename Foreign<D>::Forest *forest) {
    const auto leaves = octree.list();
    require(leaves.size() == static_cast<std::size_t>(forest->local_num_quadrants),
            "number of leaves");
    for (std::size_t i = 0; i < leaves.size(); ++i)
        require(octant_of<D>(Foreign<D>::quadrant(forest, i)) == leaves[i], "leaves");
}

template <int D> void compare_nodes(StoredOctree<D> &octree, typename Foreign<D>::Forest *forest) {
    const Host host = octree.host->host();
    std::vector<typename OctreeNodes<D>::Node> nodes;
    OctreeNodes<D> list(host, octree.header, octree.memory);
    for (typename OctreeNodes<D>::Node node; list.next(node);) nodes.push_back(node);

    auto *foreign = Foreign<D>::nodes(forest);
    require(std::count_if(nodes.begin(), nodes.end(),
                          [](const auto &node) { return node.anchors == 0; }) ==
                foreign->num_local_nodes,
            "number of nodes that do not hang");
    // Nodes that do not hang correspond; for a hanging node, p4est names one of its anchors.
    std::vector<std::int64_t> ours(static_cast<std::size_t>(foreign->num_local_nodes), -1);
    OctreeElements<D> elements(host, octree.header, octree.memory);
    std::array<std::uint64_t, Octant<D>::children> corners;
    const auto *theirs = foreign->element_nodes;
    std::vector<std::pair<std::uint64_t, std::int64_t>> hanging; // our node, and one of theirs
    for (; elements.next(corners); theirs += Octant<D>::children)
        for (int i = 0; i < Octant<D>::children; ++i) {
            if (nodes[corners[i]].anchors != 0) {
                hanging.push_back({corners[i], theirs[i]});
                continue;
            }
            std::int64_t &known = ours[static_cast<std::size_t>(theirs[i])];
            require(known < 0 || known == static_cast<std::int64_t>(corners[i]), "elements");
            known = static_cast<std::int64_t>(corners[i]);
        }
    require(std::set<std::int64_t>(ours.begin(), ours.end()).size() == ours.size(), "nodes");
    for (const auto &[node, other] : hanging) {
        const auto begin = nodes[node].anchor.begin(), end = begin + nodes[node].anchors;
        require(std::find(begin, end,
                          static_cast<std::uint64_t>(ours[static_cast<std::size_t>(other)])) != end,
                "anchors of a node that hangs");
    }
    Foreign<D>::destroy(foreign);
}

template <int D> void compare(const char *name, Cells cells) {
    std::sort(cells.begin(), cells.end());
    for (int across = 1; across <= D; ++across) {
        StoredOctree<D> octree;
        octree.split_to(cells);
        auto *unit = Foreign<D>::unit();
        auto *forest = Foreign<D>::forest(unit, &cells);
        Foreign<D>::refine(forest, is_split<D>);
        compare_leaves<D>(octree, forest);
        octree.balance(across, 1);
        Foreign<D>::balance(forest, across);
        compare_leaves<D>(octree, forest);
        if (across == D) compare_nodes<D>(octree, forest);
        std::printf("%dD %s, across %d: %lld leaves\n", D, name, across,
                    static_cast<long long>(octree.header.facts.census.leaves));
        Foreign<D>::destroy(forest);
        Foreign<D>::destroy(unit);
    }
}

/// Cells along a slanting fault below a basin, fine at the surface: as for earthquake waves.
template <int D> Cells quake(std::mt19937_64 &random) {
    Cells cells;
    for (int i = 0; i < (D == 2 ? 3000 : 1500); ++i) {
        Cell<D> cell;
        for (std::uint32_t &x : cell) x = static_cast<std::uint32_t>(random() % axis_cells<D>);
        const double depth = std::ldexp(static_cast<double>(random() % 1000), -10);
        cell[D - 1] = static_cast<std::uint32_t>(depth * depth * depth * (axis_cells<D> - 1));
        if (i % 3 == 0) cell[0] = cell[D - 1] / 2 + static_cast<std::uint32_t>(axis_cells<D> / 3);
        cells.push_back({morton<D>(cell), (D == 2 ? 11 : 8) - static_cast<int>(6 * depth)});
    }
    return cells;
}

template <int D> void compare_all() {
    std::mt19937_64 random(17);
    constexpr int finest = Foreign<D>::finest;
    compare<D>("random", random_cells<D>(random, D == 2 ? 3000 : 1000, D == 2 ? 10 : 7));
    compare<D>("deep in the middle", {{domain_cells<D> / 2 - 1, finest}});
    compare<D>("deep corners", {{0, finest}, {domain_cells<D> - 1, finest}});
    compare<D>("quake", quake<D>(random));
}

} // namespace
} // namespace abacus::test

int main(int argc, char **argv) {
    return abacus::test::with_p4est(argc, argv, [] {
        abacus::test::compare_all<2>();
        abacus::test::compare_all<3>();
        return 0;
    });
}
