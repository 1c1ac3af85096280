#include "octree/octree_nearest.hpp"

namespace abacus {

template <int D> void OctreeNearest<D>::add(const Octant<D> &octant, bool is_leaf) {
    waiting_.push_back({octant, reader_.grid().box(octant).nearest(place_), is_leaf});
    std::push_heap(waiting_.begin(), waiting_.end(), order());
}

template <int D> auto OctreeNearest<D>::take() -> Waiting {
    std::pop_heap(waiting_.begin(), waiting_.end(), order());
    const Waiting first = waiting_.back();
    waiting_.pop_back();
    return first;
}

template <int D> void OctreeNearest<D>::open(Octant<D> octant) {
    const Cell<D> at = octant.cell();
    Cell<D> cell;
    for (int i = 0; i < D; ++i)
        cell[i] =
            std::clamp(cell_[i], at[i], static_cast<std::uint32_t>(at[i] + octant.edge() - 1));
    const std::uint64_t code = morton<D>(cell);
    const int level = reader_.cache().octant(reader_.find(code)).level;
    while (octant.level < level) {
        Octant<D> next = octant;
        for (int i = 0; i < Octant<D>::children; ++i) {
            const Octant<D> child = octant.child(i);
            if (child.contains(code))
                next = child;
            else
                add(child, false);
        }
        octant = next;
    }
    add(octant, true);
}

template class OctreeNearest<2>;
template class OctreeNearest<3>;

} // namespace abacus
