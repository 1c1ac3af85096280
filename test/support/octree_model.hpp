// An octree in memory, made the simple way: to compare with.
#pragma once

#include "octree/grow.hpp"
#include "octree/octree_reader.hpp"
#include "support/memory_host.hpp"

#include <map>
#include <random>
#include <vector>

namespace abacus::test {

template <int D> class OctreeModel {
public:
    std::map<std::uint64_t, int> leaves{{0, 0}}; // level by code

    Octant<D> find(std::uint64_t cell) const {
        const auto it = std::prev(leaves.upper_bound(cell));
        return {it->first, it->second};
    }
    void split(const Octant<D> &leaf) {
        leaves.erase(leaf.code);
        for (int i = 0; i < Octant<D>::children; ++i) {
            const Octant<D> child = leaf.child(i);
            leaves[child.code] = child.level;
        }
    }
    void split_to(std::uint64_t cell, int level) {
        while (find(cell).level < level) split(find(cell));
    }
    /// Leaves that touch, one at a time, until none is too coarse.
    void balance(int across) {
        std::vector<Octant<D>> queue;
        for (const auto &[code, level] : leaves) queue.push_back({code, level});
        while (!queue.empty()) {
            const Octant<D> leaf = queue.back();
            queue.pop_back();
            if (!(find(leaf.code) == leaf)) continue;
            for (const Direction<D> &way : ways(across)) {
                const auto beyond = leaf.neighbour(way);
                if (!beyond) continue;
                while (find(beyond->code).level < leaf.level - 1) {
                    const Octant<D> coarse = find(beyond->code);
                    split(coarse);
                    for (int i = 0; i < Octant<D>::children; ++i) queue.push_back(coarse.child(i));
                }
            }
        }
    }
    static std::vector<Direction<D>> ways(int across) {
        std::vector<Direction<D>> ways;
        for (int n = 0; n < (D == 2 ? 9 : 27); ++n) {
            Direction<D> way;
            int moved = 0;
            for (int i = 0, rest = n; i < D; ++i, rest /= 3) moved += (way[i] = rest % 3 - 1) != 0;
            if (moved > 0 && moved <= across) ways.push_back(way);
        }
        return ways;
    }
    std::vector<Octant<D>> list() const {
        std::vector<Octant<D>> list;
        for (const auto &[code, level] : leaves) list.push_back({code, level});
        return list;
    }
};

/// A stored octree over the unit square or cube.
template <int D> class StoredOctree {
public:
    static constexpr std::size_t memory = std::size_t{1} << 20;

    explicit StoredOctree(std::uint32_t attributes = 0) {
        header.type = ABACUS_OCTREE;
        header.dimension = D;
        header.attributes = attributes;
        header.has_domain = 1;
        header.levels = finest_level<D>;
        for (int i = 0; i < D; ++i) header.upper[i] = 1;
        host = std::make_unique<MemoryHost>();
        create_root<D>(host->host(), header);
    }

    /// Splits the leaves that have the cells, to these levels.
    void split_to(const std::vector<std::pair<std::uint64_t, int>> &cells) {
        const Host h = host->host();
        Growth<D> growth(h, header, memory);
        for (const auto &[cell, level] : cells) growth.add(place(cell), level);
        growth.to_levels(header);
    }
    void balance(int across, std::size_t bytes = memory) {
        const Host h = host->host();
        Growth<D> growth(h, header, bytes);
        growth.to_balance(across, header);
    }
    /// The lower corner of a cell.
    Point<D> place(std::uint64_t cell) const {
        return Grid<D>(header).lower({cell, finest_level<D>});
    }
    std::vector<Octant<D>> list() const {
        std::vector<Octant<D>> list;
        const Host h = host->host();
        LeafScan<D> scan(h, header);
        while (scan.next()) list.push_back(scan.leaf());
        return list;
    }

    abacus_header header{};
    std::unique_ptr<MemoryHost> host;
};

/// Cells near a place that is drawn at random, with levels: a deep corner or scattered ones.
template <int D>
std::vector<std::pair<std::uint64_t, int>> random_cells(std::mt19937_64 &random, int n, int depth) {
    std::vector<std::pair<std::uint64_t, int>> cells;
    for (int i = 0; i < n; ++i)
        cells.push_back({random() % domain_cells<D>,
                         static_cast<int>(random() % static_cast<std::uint64_t>(depth + 1))});
    return cells;
}

} // namespace abacus::test
