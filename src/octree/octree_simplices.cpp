#include "octree/octree_simplices.hpp"

#include <algorithm>

namespace abacus {
namespace {

/// Whether places in a lattice are the corners of a positively oriented simplex.
template <int D> bool is_positive(const typename LeafSplit<D>::Simplex &simplex) {
    std::array<std::array<int, D>, D> edge;
    const auto from = LeafSplit<D>::lattice(simplex[0]);
    for (int i = 0; i < D; ++i) {
        const auto to = LeafSplit<D>::lattice(simplex[i + 1]);
        for (int k = 0; k < D; ++k) edge[i][k] = to[k] - from[k];
    }
    const auto area = [&](int a, int b, int u, int v) {
        return edge[a][u] * edge[b][v] - edge[a][v] * edge[b][u];
    };
    if constexpr (D == 2)
        return area(0, 1, 0, 1) > 0;
    else
        return edge[0][0] * area(1, 2, 1, 2) + edge[0][1] * area(1, 2, 2, 0) +
                   edge[0][2] * area(1, 2, 0, 1) >
               0;
}

} // namespace

template <int D>
OctreeSimplices<D>::OctreeSimplices(const Host &host, const abacus_facts &facts, std::size_t memory)
    : host_(host), sent_(host, 4, 2, memory / 2), scan_(host, facts) {
    find_nodes(facts, memory / 2);
    sent_.finish();
    arrived_ = sent_.next();
}

template <int D>
void OctreeSimplices<D>::find_nodes(const abacus_facts &facts, std::size_t memory) {
    RecordSort corners(host_, 5, 2, memory); // key, code and level of the leaf, which corner
    corners.expect(corners_in_all<D>(facts));
    each_corner<D>(host_, facts, [&](const NodeKey &key, const Octant<D> &leaf, int i) {
        std::uint64_t *const record = corners.add();
        record[0] = key.code;
        record[1] = key.ends;
        record[2] = leaf.code;
        record[3] = static_cast<std::uint64_t>(leaf.level);
        record[4] = static_cast<std::uint64_t>(i);
    });
    corners.finish();
    std::uint64_t number = 0;
    const std::uint64_t *next = corners.next();
    while (next != nullptr) {
        const NodeKey key{next[0], next[1]};
        Touching touching{};
        for (; next != nullptr && NodeKey{next[0], next[1]} == key; next = corners.next()) {
            touching.code[touching.count] = next[2];
            touching.level[touching.count] = next[3];
            touching.corner[touching.count++] = static_cast<int>(next[4]);
        }
        send(grid_point<D>(key), touching, number++);
        if (number % Pacer::stride == 0) host_.poll();
    }
    corners.close();
}

template <int D>
void OctreeSimplices<D>::send(const GridPoint<D> &point, const Touching &leaves,
                              std::uint64_t number) {
    int filled = 0; // orthants around the node
    std::uint64_t level = 0;
    for (int i = 0; i < leaves.count; ++i) {
        filled |= 1 << (Octant<D>::children - 1 - leaves.corner[i]);
        level = std::max(level, leaves.level[i]);
    }
    const bool hangs = static_cast<std::uint64_t>(leaves.count) < orthants<D>(point);
    const int middle = hangs ? middle_axes<D>(point, level).count : 0;
    const std::uint64_t order = Split::order(middle, number);
    for (int i = 0; i < leaves.count; ++i)
        send_to({leaves.code[i], static_cast<int>(leaves.level[i])},
                Split::corner(leaves.corner[i]), order);
    if (!hangs) return;
    std::uint64_t last = domain_cells<D>; // a larger leaf has several orthants
    for (int orthant = 0; orthant < Octant<D>::children; ++orthant) {
        if ((filled >> orthant & 1) != 0) continue;
        const auto cell = cell_around<D>(point, orthant);
        if (!cell) continue;
        const auto larger = Octant<D>{*cell, finest_level<D>}.ancestor(static_cast<int>(level) - 1);
        const Cell<D> at = larger.cell();
        std::array<int, D> lattice;
        for (int i = 0; i < D; ++i)
            lattice[i] = static_cast<int>((point[i] - at[i]) / (larger.edge() / 2));
        if (larger.code != last) send_to(larger, Split::place(lattice), order);
        last = larger.code;
    }
}

template <int D>
void OctreeSimplices<D>::send_to(const Octant<D> &leaf, int place, std::uint64_t order) {
    std::uint64_t *const record = sent_.add();
    record[0] = leaf.code;
    record[1] = static_cast<std::uint64_t>(place);
    record[2] = static_cast<std::uint64_t>(leaf.level);
    record[3] = order;
}

template <int D> bool OctreeSimplices<D>::next_leaf() {
    if (!scan_.next()) {
        if (arrived_ != nullptr) throw_unbalanced();
        sent_.close();
        return false;
    }
    const Octant<D> leaf = scan_.leaf();
    ++leaves_;
    nodes_.fill(Split::no_node);
    for (; arrived_ != nullptr && arrived_[0] <= leaf.code; arrived_ = sent_.next()) {
        if (arrived_[0] != leaf.code || arrived_[2] != static_cast<std::uint64_t>(leaf.level))
            throw_unbalanced();
        nodes_[arrived_[1]] = arrived_[3];
    }
    count_ = Split::split(nodes_, simplices_);
    at_ = 0;
    return true;
}

template <int D>
bool OctreeSimplices<D>::next(std::uint64_t &element, std::array<std::uint64_t, D + 1> &nodes) {
    while (at_ == count_)
        if (!next_leaf()) return false;
    typename Split::Simplex simplex = simplices_[at_++];
    const auto number = [&](int place) { return Split::number(nodes_[place]); };
    std::sort(simplex.begin(), simplex.end(), [&](int a, int b) { return number(a) < number(b); });
    if (!is_positive<D>(simplex)) std::swap(simplex[D - 1], simplex[D]);
    for (int i = 0; i <= D; ++i) nodes[i] = number(simplex[i]);
    element = leaves_ - 1;
    return true;
}

template class OctreeSimplices<2>;
template class OctreeSimplices<3>;

} // namespace abacus
