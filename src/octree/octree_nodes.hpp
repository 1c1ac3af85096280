// Extraction: what a solver wants of an octree. Nodes are the corners of its leaves, elements the
// leaves by the numbers of their corners, both along the curve.
//
// A node hangs if it lies on a face or an edge of a leaf that does not have it as a corner. That is
// so if the leaves which have it as a corner do not fill the domain around it: each of them fills
// one of its 2^D orthants, so counting tells. In a balanced octree it is then the middle of an edge
// or a face of a larger leaf, and the 2 or 4 corners there are its anchors. These follow from its
// place alone: of the grid of the finest leaves around it, it has an odd number on some axes, and
// the anchors are a step away along these.
//
// Corners are sorted, joined and sorted back; no table of nodes is kept.
#pragma once

#include "octree/leaf_scan.hpp"
#include "sort/dense_ranks.hpp"
#include "sort/record_sort.hpp"
#include "sort/record_spool.hpp"

#include <abacus/facts.h>

#include <optional>

namespace abacus {

/// A line of the grid on each axis, 0 to axis_cells.
template <int D> using GridPoint = std::array<std::uint64_t, D>;

/// Order of nodes: the code of the cell above it, or below where the domain ends, and on which axes
/// it does.
struct NodeKey {
    std::uint64_t code, ends;
    bool operator==(const NodeKey &) const = default;
};
template <int D> NodeKey node_key(const GridPoint<D> &point) {
    Cell<D> cell;
    std::uint64_t ends = 0;
    for (int i = 0; i < D; ++i) {
        const bool is_end = point[i] == axis_cells<D>;
        cell[i] = static_cast<std::uint32_t>(point[i] - is_end);
        ends |= static_cast<std::uint64_t>(is_end) << i;
    }
    return {morton<D>(cell), ends};
}
template <int D> GridPoint<D> grid_point(const NodeKey &key) {
    const Cell<D> cell = morton_cell<D>(key.code);
    GridPoint<D> point;
    for (int i = 0; i < D; ++i) point[i] = std::uint64_t{cell[i]} + (key.ends >> i & 1);
    return point;
}
/// Corner of an octant; bit i of its number tells the side of axis i.
template <int D> GridPoint<D> corner(const Octant<D> &octant, int number) {
    const Cell<D> cell = octant.cell();
    GridPoint<D> point;
    for (int i = 0; i < D; ++i)
        point[i] = cell[i] + (number >> i & 1 ? octant.edge() : std::uint64_t{0});
    return point;
}
/// Leaves that would have the point as a corner if they filled the domain around it.
template <int D> std::uint64_t orthants(const GridPoint<D> &point) {
    std::uint64_t orthants = 1;
    for (const std::uint64_t x : point) orthants <<= x != 0 && x != axis_cells<D>;
    return orthants;
}

/// The code of the cell in an orthant around a point; bit i of its number tells the side of axis i.
/// Nothing outside the domain.
template <int D> std::optional<std::uint64_t> cell_around(const GridPoint<D> &point, int orthant) {
    Cell<D> cell;
    for (int i = 0; i < D; ++i) {
        const std::uint64_t at = point[i] - ((orthant >> i & 1) == 0);
        if (at >= axis_cells<D>) return std::nullopt;
        cell[i] = static_cast<std::uint32_t>(at);
    }
    return morton<D>(cell);
}
/// Of all leaves, those that they share counted for each.
template <int D> double corners_in_all(const abacus_facts &facts) {
    return static_cast<double>(facts.census.leaves) * Octant<D>::children;
}
/// Calls visit(key, leaf, number) for all corners of all leaves, by their numbers.
template <int D, class Visit>
void each_corner(const Host &host, const abacus_facts &facts, Visit visit) {
    LeafScan<D> leaves(host, facts);
    while (leaves.next())
        for (int i = 0; i < Octant<D>::children; ++i)
            visit(node_key<D>(corner(leaves.leaf(), i)), leaves.leaf(), i);
}

/// Where a node hangs that is not in the middle of an edge or a face.
[[noreturn]] void throw_unbalanced();

/// The axes of the edge or the face that a node hangs in the middle of.
template <int D> struct MiddleAxes {
    std::array<int, D> axis{};
    int count = 0;
};
/// `level`: of the finest leaves around the node. Throws Error (state) if it is in no such middle.
template <int D> MiddleAxes<D> middle_axes(const GridPoint<D> &point, std::uint64_t level) {
    const std::uint64_t step = axis_cells<D> >> level;
    MiddleAxes<D> middle;
    for (int i = 0; i < D; ++i)
        if ((point[i] & step) != 0) middle.axis[middle.count++] = i;
    if (middle.count == 0 || middle.count == D) throw_unbalanced();
    return middle;
}

template <int D> class OctreeNodes {
public:
    /// Throws Error (state) if the octree is not balanced across faces and edges.
    OctreeNodes(const Host &host, const abacus_facts &facts, std::size_t memory);

    struct Node {
        std::uint64_t number;
        GridPoint<D> point;
        int anchors; ///< 0: it does not hang
        std::array<std::uint64_t, 4> anchor;
    };
    /// The next node; false after the last.
    bool next(Node &node);

private:
    void find_nodes(std::size_t memory, const abacus_facts &facts);
    void add_anchors(const GridPoint<D> &point, std::uint64_t level);
    void join_anchors();

    const Host &host_;
    RecordSpool nodes_; // key (2), anchors
    RecordSort wanted_; // key of an anchor (2), number of the node, place among its anchors
    RecordSort found_;  // number of the node, place, number of the anchor
    std::uint64_t count_ = 0, at_ = 0;
};

template <int D> class OctreeElements {
public:
    OctreeElements(const Host &host, const abacus_facts &facts, std::size_t memory);

    /// The next leaf, and the numbers of its corners; false after the last.
    bool next(std::array<std::uint64_t, Octant<D>::children> &corners);
    LeafScan<D> &scan() { return scan_; }

private:
    LeafScan<D> scan_;
    DenseRanks corners_;
};

} // namespace abacus
