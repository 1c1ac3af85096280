#include "octree/octree_nodes.hpp"

#include <algorithm>

namespace abacus {

void throw_unbalanced() {
    throw Error(ABACUS_ERROR_STATE, "the octree is not balanced",
                "A hanging node has anchors only where neighbours differ by at most one level.",
                "Balance it with abacus_octree_balance.");
}

template <int D>
OctreeNodes<D>::OctreeNodes(const Host &host, const abacus_facts &facts, std::size_t memory)
    : host_(host), nodes_(host, 3), wanted_(host, 4, 2, memory / 4),
      found_(host, 3, 2, memory / 4) {
    find_nodes(memory / 2, facts);
    join_anchors();
}

template <int D> void OctreeNodes<D>::find_nodes(std::size_t memory, const abacus_facts &facts) {
    RecordSort corners(host_, 3, 2, memory); // key, level
    corners.expect(corners_in_all<D>(facts));
    each_corner<D>(host_, facts, [&](const NodeKey &key, const Octant<D> &leaf, int) {
        std::uint64_t *const record = corners.add();
        record[0] = key.code;
        record[1] = key.ends;
        record[2] = static_cast<std::uint64_t>(leaf.level);
    });
    corners.finish();
    const std::uint64_t *next = corners.next();
    while (next != nullptr) {
        const NodeKey key{next[0], next[1]};
        std::uint64_t touching = 0, level = 0;
        for (; next != nullptr && NodeKey{next[0], next[1]} == key; next = corners.next()) {
            ++touching;
            level = std::max(level, next[2]);
        }
        const GridPoint<D> point = grid_point<D>(key);
        const bool hangs = touching < orthants<D>(point);
        const std::uint64_t before = wanted_.size();
        if (hangs) add_anchors(point, level);
        std::uint64_t *const node = nodes_.add();
        node[0] = key.code;
        node[1] = key.ends;
        node[2] = wanted_.size() - before;
        if (++count_ % Pacer::stride == 0) host_.poll();
    }
    corners.close();
}

template <int D> void OctreeNodes<D>::add_anchors(const GridPoint<D> &point, std::uint64_t level) {
    const std::uint64_t step = axis_cells<D> >> level;
    const MiddleAxes<D> middle = middle_axes<D>(point, level);
    for (int anchor = 0; anchor < 1 << middle.count; ++anchor) {
        GridPoint<D> at = point;
        for (int i = 0; i < middle.count; ++i)
            at[middle.axis[i]] += (anchor >> i & 1) != 0 ? step : 0 - step;
        const NodeKey key = node_key<D>(at);
        std::uint64_t *const record = wanted_.add();
        record[0] = key.code;
        record[1] = key.ends;
        record[2] = count_;
        record[3] = static_cast<std::uint64_t>(anchor);
    }
}

template <int D> void OctreeNodes<D>::join_anchors() {
    nodes_.rewind();
    wanted_.finish();
    std::uint64_t number = 0;
    const std::uint64_t *node = nodes_.next();
    while (const std::uint64_t *wanted = wanted_.next()) {
        const auto before = [&] {
            return node[0] != wanted[0] ? node[0] < wanted[0] : node[1] < wanted[1];
        };
        for (; node != nullptr && before(); ++number) node = nodes_.next();
        if (node == nullptr || node[0] != wanted[0] || node[1] != wanted[1] || node[2] != 0)
            throw_unbalanced();
        std::uint64_t *const record = found_.add();
        record[0] = wanted[2];
        record[1] = wanted[3];
        record[2] = number;
    }
    wanted_.close();
    nodes_.rewind();
    found_.finish();
}

template <int D> bool OctreeNodes<D>::next(Node &node) {
    const std::uint64_t *const record = nodes_.next();
    if (record == nullptr) {
        nodes_.close();
        found_.close();
        return false;
    }
    node.number = at_++;
    node.point = grid_point<D>({record[0], record[1]});
    node.anchors = static_cast<int>(record[2]);
    for (int i = 0; i < node.anchors; ++i) node.anchor[i] = found_.next()[2];
    return true;
}

template <int D>
OctreeElements<D>::OctreeElements(const Host &host, const abacus_facts &facts, std::size_t memory)
    : scan_(host, facts), corners_(host, 2, memory) {
    corners_.expect(corners_in_all<D>(facts));
    each_corner<D>(host, facts, [&](const NodeKey &key, const Octant<D> &, int) {
        std::uint64_t *const record = corners_.add();
        record[0] = key.code;
        record[1] = key.ends;
    });
    corners_.finish();
}

template <int D>
bool OctreeElements<D>::next(std::array<std::uint64_t, Octant<D>::children> &corners) {
    if (!scan_.next()) {
        corners_.close();
        return false;
    }
    for (std::uint64_t &number : corners) number = corners_.next();
    return true;
}

template class OctreeNodes<2>;
template class OctreeNodes<3>;
template class OctreeElements<2>;
template class OctreeElements<3>;

} // namespace abacus
