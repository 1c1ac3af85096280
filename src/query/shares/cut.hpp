// A mesh cut into parts: stretches of the curve with equal numbers of simplices, or equal sums of
// weights.
//
// Simplex i has the weight w(i), and those before it in the order of curve_place.hpp weigh s(i).
// All weigh s. Of n parts it belongs to that in which its middle lies: floor(n (2 s(i) + w(i)) / 2
// s). So the sum of a part differs from the mean by at most half a simplex at each end. Sums are
// exact, so the parts do not depend on pages, and neither do the answers of two sessions.
//
// One pass over the pages finds the cut. Only pages in which a part begins are sorted. Weights are
// not known before they have all been read; so the sum of each page goes to a spool, and the pages
// in which parts begin are read once more. The pass also collects the boxes of the pages, by which
// shares find the pages around them.
//
// Where parts begin is kept in memory, so there cannot be more of them than the memory of a query
// holds.
#pragma once

#include "geometry/exact_sum.hpp"
#include "query/pages/page_boxes.hpp"
#include "query/shares/curve_place.hpp"
#include "query/shares/simplex_weight.hpp"
#include "sort/record_spool.hpp"

#include <optional>

namespace abacus {

template <int D> class Cut {
public:
    /// Where the simplices of a part begin; those of a part without any have no piece.
    struct Piece {
        std::uint32_t part;
        std::uint64_t first, simplices; // which of the mesh is its first, and how many it has
        CurvePlace<D> begin;            // of that one
    };
    /// The pieces that a page may have simplices of.
    struct Range {
        std::size_t first, last;
    };

    /// Of a mesh that is not empty. Throws if there are too many parts for so many bytes.
    Cut(const Host &host, const abacus_facts &facts, const abacus_cut &cut, std::size_t memory);

    bool is_same(const abacus_cut &cut) const {
        return cut.parts == cut_.parts && cut.weight == cut_.weight &&
               (cut.weight == ABACUS_WEIGHT_ONE || cut.column == cut_.column);
    }
    std::uint32_t parts() const { return cut_.parts; }
    std::size_t pieces() const { return pieces_.size(); }
    const Piece &piece(std::size_t number) const { return pieces_[number]; }
    /// The number of a part's piece, if it has one.
    std::optional<std::size_t> piece_of(std::uint32_t part) const;
    Range range(const PageView<D> &page) const;
    /// The piece that a finite simplex of the page belongs to.
    std::size_t piece_of(const PageView<D> &page, const Range &range, int simplex) const;
    /// Boxes of pages that may have simplices of a piece.
    Range boxes_of(std::size_t piece) const;
    const PageBoxes<D> &boxes() const { return *boxes_; }

private:
    static constexpr std::size_t box_bytes = std::size_t{16} << 20;

    /// The finite simplices of a page in their order.
    struct Placed {
        CurvePlace<D> place;
        int simplex;
    };

    template <class Course> void cut_pages(RecordSpool &spool, std::size_t words, Course course);
    template <class Course> void cut_page(const Key &key, std::uint64_t before, Course course);
    std::size_t last_before(const Key &key) const;

    const Host &host_;
    const abacus_facts facts_;
    const abacus_cut cut_;
    const Domain<D> domain_;
    std::optional<SimplexWeight<D>> weight_; // until the cut is found
    Arena<Piece> pieces_;
    Arena<Placed> placed_;
    std::optional<PageBoxes<D>> boxes_;
};

extern template class Cut<2>;
extern template class Cut<3>;

} // namespace abacus
