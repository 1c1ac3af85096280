// The corners of a random quadtree or octree. Leaves of very different sizes meet, so corners hang
// on edges and faces of larger leaves: nearly every point is cospherical, coplanar or collinear
// with many others.
#pragma once

#include "coordinates.hpp"
#include "random.hpp"

#include <deque>
#include <unordered_set>

namespace abacus::oracle {

template <int D> Points<D> octree(std::size_t size, Random &random) {
    using Corner = std::array<std::uint32_t, D>;
    struct Cell {
        Corner corner;
        std::uint32_t edge;
    };
    constexpr std::uint32_t root_edge = 1 << 20; // so that a corner fits D times 21 bits

    Points<D> points;
    std::unordered_set<std::uint64_t> known;
    /// Adds or visits the corners at `edge` apart from `from`, `count` along each axis.
    const auto for_each_corner = [](const Corner &from, std::uint32_t edge, int count, auto visit) {
        std::array<int, D> step{};
        for (int axis = 0; axis < D;) {
            Corner corner = from;
            for (int i = 0; i < D; ++i) corner[i] += std::uint32_t(step[i]) * edge;
            visit(corner);
            for (axis = 0; axis < D && ++step[axis] == count; ++axis) step[axis] = 0;
        }
    };

    std::deque<Cell> cells{{Corner{}, root_edge}};
    while (points.size() < size && !cells.empty()) {
        const Cell cell = cells.front();
        cells.pop_front();
        const bool is_leaf = cell.edge == 1 || (cell.edge < root_edge / 4 && random.below(2) == 0);
        if (is_leaf) continue;
        const std::uint32_t half = cell.edge / 2;
        for_each_corner(cell.corner, half, 3, [&](const Corner &corner) {
            std::uint64_t key = 0;
            Coordinates<D> point;
            for (int i = 0; i < D; ++i) {
                key = key << 21 | corner[i];
                point[i] = double(corner[i]);
            }
            if (points.size() < size && known.insert(key).second) points.push_back(point);
        });
        for_each_corner(cell.corner, half, 2, [&](const Corner &corner) {
            cells.push_back({corner, half});
        });
    }
    return points;
}

} // namespace abacus::oracle
