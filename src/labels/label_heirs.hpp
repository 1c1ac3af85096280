// Labels passed on from removed simplices to the new ones in their place.
//
// If the mesh is set to do so, a simplex that a change has created gets the labels of the one that
// contained its centroid before: a region keeps its material while points are inserted and deleted.
// Only the mesh before the change and after it matters, as for labels that stay (label_sweep.hpp).
//
// The centroid is rounded. If it is then not inside its own simplex, that simplex gets no labels.
// So a simplex that was there before, without labels, gets none: its centroid was in no other.
// Which removed simplices contain the centroid is decided exactly; of several, the one with the
// least key counts. A removed simplex without labels has nothing to pass on, and neither has the
// outside of the mesh.
//
// Removed simplices go to a spool, in the order of their keys. As many as memory holds are kept at
// a time, in a tree of their boxes, to be compared with the simplices of the stretches.
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

    /// Adds a removed simplex with its labels; in the order of their keys.
    void lose(const Simplex &simplex, const double *labels);
    /// After the last one: gives labels to simplices of the stretches. Returns how many got some.
    std::uint64_t pass_on(LabelSweep<D> &sweep, const Arena<StoredPages::Stretch> &stretches);

private:
    struct Heir {
        Simplex simplex;
        std::uint64_t code;
        std::size_t from; // number among the removed simplices in memory
    };

    /// Reads the next removed simplices into memory; false if there are none.
    bool read_lost();
    void look_at(const Simplex &simplex, std::uint64_t code);
    std::uint64_t give(AttributePages<D, D + 1> &pages);

    const unsigned labels_;
    RecordSpool spool_;
    const std::size_t room_; // for this many at once
    BoxTree<D> tree_;
    Arena<Simplex> lost_;
    Arena<double> values_; // of each of them
    Arena<Heir> heirs_;    // in a page
};

extern template class LabelHeirs<2>;
extern template class LabelHeirs<3>;

} // namespace abacus
