// The leaves nearest to a place, nearest first: by the exact distance to their closed boxes; of
// those equally far the one comes first that is first along the curve.
//
// Octants wait in a heap in that order, an octant before what lies in it. If the first one is a
// leaf, it is the next answer. If not, the leaf in it that is at the cell nearest to the place
// tells what is split on the way there. So nothing is read but pages around leaves that are
// answers.
#pragma once

#include "geometry/distance.hpp"
#include "octree/octree_reader.hpp"

namespace abacus {

template <int D> class OctreeNearest {
public:
    explicit OctreeNearest(OctreeReader<D> &reader)
        : reader_(reader), waiting_(reader.cache().host()) {}

    /// Calls visit(rank, handle, distance) for the k leaves nearest to a place, all if there are
    /// fewer. A handle dies with the next use of the reader.
    template <class Visit> void find(const Point<D> &place, std::uint64_t k, Visit visit) {
        place_ = place;
        cell_ = reader_.grid().nearest_cell(place);
        waiting_.clear();
        add({}, false);
        for (std::uint64_t rank = 1; rank <= k && !waiting_.empty();) {
            const Waiting first = take();
            if (first.is_leaf)
                visit(rank++, reader_.find(first.octant.code), distance<D>(place_, first.nearest));
            else
                open(first.octant);
            reader_.cache().poll();
        }
    }

private:
    struct Waiting {
        Octant<D> octant;
        Point<D> nearest; // of its box
        bool is_leaf;
    };

    bool comes_later(const Waiting &a, const Waiting &b) const {
        const int sign = compare_distance<D>(place_, a.nearest, b.nearest);
        return sign != 0 ? sign > 0 : a.octant.code > b.octant.code;
    }
    auto order() const {
        return [this](const Waiting &a, const Waiting &b) { return comes_later(a, b); };
    }
    void add(const Octant<D> &octant, bool is_leaf);
    Waiting take();
    /// The octants that a split one has on the way to its cell nearest to the place.
    void open(Octant<D> octant);

    OctreeReader<D> &reader_;
    Point<D> place_{};
    Cell<D> cell_{};
    Arena<Waiting> waiting_; // a heap
};

extern template class OctreeNearest<2>;
extern template class OctreeNearest<3>;

} // namespace abacus
