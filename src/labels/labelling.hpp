// Labels given to simplices of a mesh, many at once.
//
// Rows name simplices as readers return them, by code and ids of corners, in any order. Sorted by
// code they follow the curve, so that each simplex page is read once, and each page of labels read
// and written once. If there are several rows for a simplex, the last one counts. No simplex page
// changes, so any mesh can get labels, whether or not it is Delaunay.
#pragma once

#include "attributes/attribute_pages.hpp"
#include "labels/named_simplices.hpp"
#include "sort/record_sort.hpp"

#include <abacus/mesh_header.h>
#include <span>

namespace abacus {

template <int D> class Labelling {
public:
    /// `facts` counts all labels; of these `known` are not new. A row has those whose numbers are
    /// `labels`. Sorts within `memory` bytes.
    Labelling(const Host &host, const abacus_facts &facts, unsigned known,
              std::span<const std::uint32_t> labels, std::size_t memory);

    /// Adds rows: code, D + 1 ids, values.
    void add(const std::uint64_t *rows, std::size_t count);
    /// No more rows come: sets the labels, and brings the header up to date. Throws an Error
    /// (argument) if the mesh has no such simplex, or several.
    void set(NamedSimplices<D> &mesh, abacus_header &header);

private:
    static constexpr std::size_t name_words = 1 + (D + 1); // code and ids

    static Owner<D, D + 1> owner(NamedSimplices<D> &mesh, const std::uint64_t *record);
    void set_row(AttributePages<D, D + 1> &pages, const Owner<D, D + 1> &simplex,
                 std::uint64_t code, std::uint64_t &labelled);

    const Host &host_;
    const unsigned known_;
    Arena<std::uint32_t> labels_;
    Arena<double> some_, all_; // of a simplex: the labels in a row, all of the mesh
    RecordSort sort_;          // code, number of the row, ids, values
};

extern template class Labelling<2>;
extern template class Labelling<3>;

} // namespace abacus
