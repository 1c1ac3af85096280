// Markers given to facets of a mesh, many at once.
//
// A row names a facet by a simplex beside it, with code and ids of corners as readers return them,
// and by the corner opposite the facet. The simplex on the other side, if there is one, gets the
// same marker. Sorted by code, rows follow the curve, so that each simplex page is read once. The
// markers of both sides are sorted once more, by the keys of the simplices, so that each page of
// markers is written once. If a facet has several rows, the last row of the simplex that is last on
// the curve counts.
#pragma once

#include "attributes/attribute_pages.hpp"
#include "labels/named_simplices.hpp"
#include "sort/record_sort.hpp"

#include <abacus/mesh_header.h>

namespace abacus {

template <int D> class Marking {
public:
    /// Sorts within `memory` bytes.
    Marking(const Host &host, const abacus_facts &facts, std::size_t memory);

    /// Adds rows: code, D + 1 ids, number of the corner, marker; NaN removes the marker.
    void add(const std::uint64_t *rows, std::size_t count);
    /// No more rows come: sets the markers, and brings the header up to date. Throws an Error
    /// (argument) if the mesh has no such simplex, or several.
    void set(NamedSimplices<D> &mesh, abacus_header &header);

private:
    using Pages = AttributePages<D, D + 1>;
    static constexpr std::size_t row_words = 1 + (D + 1) + 2;
    static constexpr std::size_t side_key = 3, side_words = side_key + 1 + D * (D + 1) + 2;

    /// Adds both sides of a row's facet to sides_.
    void add_sides(NamedSimplices<D> &mesh, const std::uint64_t *record);
    void add_side(const abacus_simplex &simplex, int corner, double marker);
    static void mark(Pages &pages, const std::uint64_t *side, std::uint64_t &marked);

    const Host &host_;
    RecordSort sort_;  // code, number of the row, ids, corner, marker
    RecordSort sides_; // key, number, code and corners of the simplex, the one opposite, marker
};

extern template class Marking<2>;
extern template class Marking<3>;

} // namespace abacus
