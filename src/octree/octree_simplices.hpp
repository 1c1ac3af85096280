// A balanced octree as a conforming mesh of triangles or tetrahedra, leaf by leaf along the curve,
// by the numbers of its nodes (octree_nodes.hpp). leaf_split.hpp tells how a leaf is cut.
//
// A leaf must be given its nodes, those in the middles of its edges and faces too. Corners are
// sorted, as for the nodes. Around a node that hangs, leaves that do not have it as a corner are
// one level coarser; so they are known by their codes, without looking for them. Each node is sent
// to the leaves that have it, by one more sort. A leaf that gets a node for another level is not
// balanced.
#pragma once

#include "octree/leaf_split.hpp"
#include "octree/octree_nodes.hpp"

namespace abacus {

template <int D> class OctreeSimplices {
public:
    /// Throws Error (state) if the octree is not balanced across faces and edges; next() does, too.
    OctreeSimplices(const Host &host, const abacus_facts &facts, std::size_t memory);

    /// The next simplex, of positive orientation, its least node first and, in space, the least of
    /// the others second; false after the last. `element` is the number of its leaf.
    bool next(std::uint64_t &element, std::array<std::uint64_t, D + 1> &nodes);

private:
    using Split = LeafSplit<D>;
    struct Touching { // leaves that have a node as a corner
        std::array<std::uint64_t, Octant<D>::children> code;
        std::array<std::uint64_t, Octant<D>::children> level;
        std::array<int, Octant<D>::children> corner;
        int count;
    };

    void find_nodes(const abacus_facts &facts, std::size_t memory);
    void send(const GridPoint<D> &point, const Touching &leaves, std::uint64_t number);
    void send_to(const Octant<D> &leaf, int place, std::uint64_t order);
    bool next_leaf();

    const Host &host_;
    RecordSort sent_; // code of a leaf, place in it, its level, order of the node
    const std::uint64_t *arrived_ = nullptr;
    LeafScan<D> scan_;
    std::uint64_t leaves_ = 0;
    typename Split::Nodes nodes_{}; // of the leaf
    std::array<typename Split::Simplex, Split::most_simplices> simplices_{};
    int count_ = 0, at_ = 0; // of its simplices
};

} // namespace abacus
