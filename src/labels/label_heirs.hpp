// Labels of simplices that have gone, for those that have come in their place.
//
// In a mesh that wants it so, a simplex that a change has created gets the labels of the one in
// which its centroid lay before: a region keeps its material while points are inserted and deleted.
// What counts is the mesh before the change and after it, as for labels that stay
// (label_sweep.hpp).
//
// The centroid is rounded. If it is not inside its own simplex then, that gets no labels. So a
// simplex that is as old as the mesh, and has none, gets none: its centroid was in no other. Which
// simplices that have gone have the centroid is decided exactly, and of several around it the one
// with the least key counts. One without labels has nothing to give, and outside the mesh there is
// nothing.
//
// Those that have gone go to a spool, in the order of their keys, and as many as memory holds are
// looked for at once, in a tree of their boxes.
#pragma once

#include "geometry/box_tree.hpp"
#include "geometry/predicates.hpp"
#include "labels/label_sweep.hpp"
#include "sort/record_spool.hpp"

namespace abacus {

template <int D> class LabelHeirs {
public:
    using Simplex = Owner<D, D + 1>;

    LabelHeirs(const Host &host, unsigned labels, std::size_t memory);

    /// A simplex that has gone with its labels; in the order of their keys.
    void lose(const Simplex &simplex, const double *labels);
    /// After the last one: gives labels to simplices of the stretches. Returns to how many.
    std::uint64_t pass_on(LabelSweep<D> &sweep, const Arena<StoredPages::Stretch> &stretches);

private:
    struct Heir {
        Simplex simplex;
        std::uint64_t code;
        std::size_t from; // number among those that are looked for
    };

    /// Reads the next of those that have gone; false if there are none.
    bool read_lost();
    void look_at(const Simplex &simplex, std::uint64_t code);
    std::uint64_t give(AttributePages<D, D + 1> &pages);

    const unsigned labels_;
    RecordSpool spool_;
    const std::size_t room_; // for so many at once
    BoxTree<D> tree_;
    Arena<Simplex> lost_;
    Arena<double> values_; // of each of them
    Arena<Heir> heirs_;    // in a page
};

extern template class LabelHeirs<2>;
extern template class LabelHeirs<3>;

} // namespace abacus
