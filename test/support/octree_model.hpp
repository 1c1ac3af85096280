// A simple octree in memory, for comparison.
#pragma once

#include "octree/grow.hpp"
#include "octree/octree_edit.hpp"
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
    /// Merges the leaves of an octant into one; returns how many there were.
    std::uint64_t merge(const Octant<D> &octant) {
        if (find(octant.code).level <= octant.level) return 1;
        const auto begin = leaves.lower_bound(octant.code), end = leaves.lower_bound(octant.end());
        const auto merged = static_cast<std::uint64_t>(std::distance(begin, end));
        leaves.erase(begin, end);
        leaves[octant.code] = octant.level;
        return merged;
    }
    /// Splits leaves until none has more than `most` of the cells, or can be split.
    void split_to_points(const std::vector<std::uint64_t> &cells, std::uint64_t most, int levels) {
        for (bool done = false; !done;) {
            done = true;
            std::map<std::uint64_t, std::uint64_t> points;
            for (const std::uint64_t cell : cells) ++points[find(cell).code];
            for (const auto &[code, n] : points)
                if (n > most && find(code).level < levels) {
                    split(find(code));
                    done = false;
                }
        }
    }
    /// Splits leaves that touch, one at a time, until none is too coarse.
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
        header.facts.form.type = ABACUS_OCTREE;
        header.facts.form.dimension = D;
        header.facts.columns.attributes = attributes;
        header.facts.form.has_domain = 1;
        header.facts.form.levels = finest_level<D>;
        for (int i = 0; i < D; ++i) header.facts.form.upper[i] = 1;
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
    void split_to_points(const std::vector<std::uint64_t> &cells, std::uint64_t most) {
        const Host h = host->host();
        Growth<D> growth(h, header, memory);
        for (const std::uint64_t cell : cells) growth.add(place(cell));
        growth.to_points(most, header);
    }
    /// Merges the leaves of octants; returns how many there were.
    std::uint64_t merge(const std::vector<Octant<D>> &octants, std::size_t cache = memory) {
        const Host h = host->host();
        OctreeEdit<D> edit(h, header, memory, cache);
        for (const Octant<D> &octant : octants) edit.merge_at(place(octant.code), octant.level);
        return edit.merge(header);
    }
    void balance(int across, std::size_t bytes = memory) {
        const Host h = host->host();
        Growth<D> growth(h, header, bytes);
        growth.to_balance(across, header);
    }
    /// A new octree on this many pages, a power of 2: the first has its leaf, the others are empty,
    /// as merges may leave them.
    void spread_root(std::uint64_t pages) {
        const Host h = host->host();
        OctantPageWriter<D> writer(h, static_cast<int>(header.facts.columns.attributes));
        const std::vector<double> values(header.facts.columns.attributes, 0.5);
        const auto border = [&](std::uint64_t i) { return domain_cells<D> / pages * i; };
        for (std::uint64_t i = 0; i < pages; ++i) {
            writer.write(
                border(i), i + 1 == pages ? key_word_end : border(i + 1), i == 0,
                [](std::size_t) { return Octant<D>{}; },
                [&](std::size_t) { return values.data(); });
            abacus_page page{{border(i), 0}, writer.bytes(), writer.size(), 0};
            if (i == 0) page.location = host->pages.begin()->second.location;
            h.put(ABACUS_OCTANT_PAGES, page);
        }
    }
    /// The lower corner of a cell.
    Point<D> place(std::uint64_t cell) const {
        return Grid<D>(header.facts.form).box({cell, finest_level<D>}).lower;
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

/// Cells near a random place, with levels: a deep corner or scattered ones.
template <int D>
std::vector<std::pair<std::uint64_t, int>> random_cells(std::mt19937_64 &random, int n, int depth) {
    std::vector<std::pair<std::uint64_t, int>> cells;
    for (int i = 0; i < n; ++i)
        cells.push_back({random() % domain_cells<D>,
                         static_cast<int>(random() % static_cast<std::uint64_t>(depth + 1))});
    return cells;
}

} // namespace abacus::test
