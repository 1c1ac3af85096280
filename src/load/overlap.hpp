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
// mesh has few facets on its boundary as a rule, so once; at worst as often as the boundary
// is larger than the memory.
#pragma once

#include "geometry/box_tree.hpp"
#include "geometry/contact.hpp"
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
    bool fill(RecordSort &boundary);
    void check_simplices(RecordSpool &simplices, Faults &faults) const;
    void check_boundary(RecordSort &boundary, Faults &faults) const;
    /// Whether the simplex with these corners covers the place just outside the facet, which lies
    /// inside of it, or along one of its own facets: then the simplex behind is on the other side.
    enum class Cover { none, inside, along };
    static Cover covers(const Corners<D> &corners, const BoundaryFacet &facet);

    const Host &host_;
    const LoadLayout<D> layout_;
    std::size_t room_;
    std::uint64_t first_ = 0; // number of the first facet held
    Arena<BoundaryFacet> facets_;
    BoxTree<D> tree_;
};

} // namespace abacus
