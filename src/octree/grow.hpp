// Changes of an octree as a whole: each says which octants are to be split, and grow() rewrites the
// pages in which leaves are.
#pragma once

#include "octree/balance.hpp"
#include "octree/grid.hpp"
#include "octree/leaf_scan.hpp"
#include "octree/leaf_writer.hpp"
#include "sort/pacer.hpp"
#include "sort/record_sort.hpp"

#include <abacus/mesh_header.h>
#include <abacus/octree.h>

namespace abacus {

/// Writes the one leaf of a new octree, without attributes.
template <int D> void create_root(const Host &host, abacus_header &header);

/// Grows an octree until it is the least one that serves all requests. No leaf that was there is
/// lost. A leaf that is split leaves its attributes to its children.
template <int D> class Growth {
public:
    Growth(const Host &host, const abacus_facts &facts, std::size_t memory)
        : host_(host), pacer_(host), memory_(memory), levels_(static_cast<int>(facts.form.levels)),
          facts_(facts), grid_(facts.form), places_(host, 2, 2, memory / 2) {}

    /// A place, and the coarsest level of the leaf that has it. Throws Error (argument) outside the
    /// domain and for a level that no leaf may have.
    void add(const Point<D> &place, std::int64_t level = 0);

    /// The levels hold for the places that were added.
    void to_levels(abacus_header &header);
    /// At most so many of the places that were added in a leaf, unless it is as fine as may be.
    void to_points(std::uint64_t most, abacus_header &header);
    /// Leaves are no longer than `sizes` tells for `samples` places along each axis; see
    /// abacus_octree_growth_sizes. Returns how many are longer than a size told for a place in
    /// them.
    std::uint64_t to_sizes(abacus_octree_sizes sizes, void *context, int samples,
                           abacus_header &header);
    /// Neighbours across faces (1), edges (2) and corners (D) differ by a level at most.
    void to_balance(int across, abacus_header &header);

private:
    /// With fewer places pages are changed one by one, so that a small change of a large octree is
    /// cheap; with more, it is cheaper to read them all in order.
    static constexpr std::uint64_t leaves_a_place = 256;

    class Asker;
    class LongLeaves;

    /// Splits the leaves at the places through a cache.
    void split_in_place(abacus_header &header);
    /// Throws if spools have no room for what is split in the octree as it is, and so many bytes.
    void expect(double wanted_bytes) const;
    /// The same for what each(split_to) splits by split_to(cell, level) at the places, which are
    /// counted where there may be no room for them.
    template <class Each> void expect_places(Each each);
    /// Calls split_to(cell, level) for a cell of each place; or of places that are too many in a
    /// leaf.
    template <class SplitTo> void each_place(SplitTo split_to);
    template <class SplitTo>
    void each_crowded(RecordSpool &ahead, std::uint64_t most, SplitTo split_to);
    /// What is split in the octree as it is; `visit` gets its leaves.
    template <class Visit> void read(SplitOctants<D> &octants, abacus_header &header, Visit visit);
    void read(SplitOctants<D> &octants, abacus_header &header) {
        read(octants, header, [](const Octant<D> &) {});
    }
    /// Grows the octree, of which this set is split, by another one; closes both. `visit` gets its
    /// new leaves.
    template <class Visit>
    void grow(SplitOctants<D> &octants, SplitOctants<D> &wanted, abacus_header &header,
              Visit visit);
    void grow(SplitOctants<D> &octants, SplitOctants<D> &wanted, abacus_header &header) {
        grow(octants, wanted, header, [](const Octant<D> &) {});
    }
    /// The leaves are those of a set that has all that are split now; closes it.
    template <class Visit>
    void rewrite(SplitOctants<D> &octants, abacus_header &header, Visit visit);

    const Host &host_;
    Pacer pacer_;
    const std::size_t memory_;
    const int levels_;
    const abacus_facts facts_;
    Grid<D> grid_;
    RecordSort places_; // code, level
};

} // namespace abacus
