// Whether the simplices of a loaded mesh form a complex: whether any two of them meet in a
// common face or not at all. Exact, and within a bound of memory.
//
// Facets have been matched before: each is used once, on the boundary, or by two simplices
// on its two sides. So the number of simplices that cover a place is the same on both sides
// of a facet that is used twice, and changes by one across a facet of the boundary: no more
// than the boundary has to be looked at.
//
//   1  Just outside each facet of the boundary, near its first vertex, there must be no
//      simplex.
//   2  Any two facets of the boundary must meet in a common face or not at all.
//
// By 2 the boundary cuts space into cells that are covered evenly. A cell that is covered
// twice has a facet of the boundary with one more on the one side than on the other. If the
// cell is that facet's outside, 1 finds it; if it is the inside, the cell beyond is covered
// once at least and is the facet's outside, so 1 finds that. So nothing is covered twice;
// and then two simplices that meet in less or more than a common face do so with facets of
// the boundary, since around any other point the simplices of one star cover all there is.
//
// "Just outside, near the first vertex" is a point that is not computed. It lies at the
// first vertex, moved infinitesimally towards the second, less towards the third, still less
// away from the simplex: on which side of a plane it lies, the first of these decides that
// is not on the plane.
//
// Facets of the boundary are held in memory, as many as fit, in an R-tree of their boxes
// along the curve. All simplices and all later facets of the boundary stream past them. A
// mesh has few facets on its boundary as a rule, so once. If they do not fit, they are held in
// parts, each of which is compared with what is near it (boundary_parts.hpp).
//
// Where the boundary is large, several threads look at what streams past. They only find out where
// there is no fault, as in most places. Where there is one the session's thread looks again: so
// which faults are reported does not depend on the number of threads.
#pragma once

#include "geometry/box_tree.hpp"
#include "geometry/contact.hpp"
#include "host/shared_loop.hpp"
#include "load/boundary_parts.hpp"
#include "load/faults.hpp"
#include "load/records.hpp"
#include "sort/record_sort.hpp"
#include "sort/record_spool.hpp"

namespace abacus {

template <int D> class Overlap {
public:
    Overlap(const Host &host, const LoadLayout<D> &layout, std::size_t memory);

    /// `boundary` is sorted. Throws an Error (argument) that names pairs of simplices.
    void check(RecordSort &boundary, RecordSpool &simplices, Faults &faults);

private:
    /// A facet of the boundary, its ghost's vertices, and the simplex behind it.
    struct BoundaryFacet {
        std::array<Word, D> id;
        std::array<Point<D>, D> point;
        Word opposite_id;
        Point<D> opposite;

        std::string simplex() const { return sorted_name(id, opposite_id); }
        Facet<D> vertices() const {
            Facet<D> result;
            for (int i = 0; i < D; ++i) result[i] = &point[i];
            return result;
        }
        Box<D> box() const {
            Box<D> box;
            for (const Point<D> &p : point) box.extend(p);
            return box;
        }
    };

    BoundaryFacet read(const Word *record) const;
    Box<D> box_of_simplex(const Word *simplex) const;
    void check_at_once(RecordSort &boundary, RecordSpool &simplices, Faults &faults);
    /// The next parts of the boundary, from facet `first` on; returns the first one behind them.
    std::uint64_t check_parts(std::uint64_t first, RecordSort &boundary, RecordSpool &simplices,
                              Faults &faults);
    void put_aside(BoundaryParts<D> &parts, std::uint64_t first, RecordSort &boundary,
                   RecordSpool &simplices) const;
    void fill(RecordSort &boundary);
    /// Looks at all records that next() returns: is_sound(record, host) tells whether anything is
    /// wrong with one, and report(record) reports what.
    template <class Next, class IsSound, class Report>
    void each(std::size_t words, Next next, IsSound is_sound, Report report, const Faults &faults);
    template <class IsSound, class Report>
    void look_at_batch(std::size_t words, IsSound is_sound, Report report);
    /// What next() returns, simplices or facets with their numbers, against facets in memory.
    template <class Next> void check_simplices(Next next, Faults &faults);
    template <class Next> void check_facets(Next next, Faults &faults);
    /// Whether the simplex with these corners covers the place just outside the facet, which lies
    /// inside of it, or along one of its own facets: then the simplex behind is on the other side.
    enum class Cover { none, inside, along };
    static Cover covers(const Corners<D> &corners, const BoundaryFacet &facet);
    /// Calls visit(i, cover) for each facet in memory just outside of which the simplex lies, until
    /// it returns false; returns whether it did not.
    template <class Visit>
    bool each_covered(const Word *simplex, const Host &host, Visit visit) const;
    /// The same with visit(i) for each earlier facet in memory that a facet meets improperly.
    template <class Visit>
    bool each_crossed(const Word *numbered, const Host &host, Visit visit) const;

    const Host &host_;
    const LoadLayout<D> layout_;
    const std::size_t memory_;
    std::size_t room_;        // facets
    std::uint64_t first_ = 0; // number of the first facet held
    Arena<BoundaryFacet> facets_;
    BoxTree<D> tree_;
    SharedLoop loop_;
    bool is_shared_ = false;
    Arena<Word> batch_; // records that threads look at
};

} // namespace abacus
