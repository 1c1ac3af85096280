// Values between the leaves of an octree: continuous, though each leaf has one value.
//
// A node, the corner of some leaf, gets the mean of the leaves around it, unless it hangs: then it
// lies on a face or an edge of a larger leaf, and gets the value that the largest of these has
// there. Where neighbours differ by a level at most that is the mean of its anchors
// (octree_nodes.hpp). Within a leaf values follow from those of its corners, linear along each
// axis. Leaves that touch have, where they do, the values of the largest one: its nodes alone count
// there. So there is no step between them, whether the octree is balanced or not.
//
// The nodes of one leaf are kept, for places come along the curve, many in a leaf.
#pragma once

#include "octree/octree_nodes.hpp"
#include "octree/octree_reader.hpp"

namespace abacus {

template <int D> class OctreeInterpolation {
public:
    /// Of some attributes, by their numbers.
    OctreeInterpolation(OctreeReader<D> &reader, const std::uint32_t *attributes,
                        std::uint32_t count)
        : reader_(reader), attributes_(attributes), count_(count), keys_(reader.cache().host()),
          values_(reader.cache().host()) {}

    /// The values at a place, NaN where a leaf has none that counts there; false outside the
    /// domain.
    bool values(const Point<D> &place, double *values);

private:
    using Share = std::array<double, D>; // of the way from lower to upper, 0 to 1
    static constexpr int corners = Octant<D>::children;

    void inside(const Octant<D> &leaf, const Share &share, double *values);
    /// The number of a node, with its values.
    std::size_t node(const GridPoint<D> &point);
    /// The leaves around a node: the largest that does not have it as a corner, if there is one;
    /// else the mean of all is in `values`.
    std::optional<Octant<D>> look_around(const GridPoint<D> &point, double *values);

    OctreeReader<D> &reader_;
    const std::uint32_t *const attributes_;
    const std::uint32_t count_;
    std::optional<Octant<D>> leaf_; // whose nodes are kept
    Arena<NodeKey> keys_;
    Arena<double> values_; // so many of each node
};

extern template class OctreeInterpolation<2>;
extern template class OctreeInterpolation<3>;

} // namespace abacus
