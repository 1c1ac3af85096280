// A mesh as two arrays, for programs outside the database: vertices, and simplices by the numbers
// of their corners.
//
// Vertices are numbered from 0 in the order of their codes along the curve; those of one code by
// their coordinates, those at one place by their ids. So the numbers depend on the points alone,
// and points close to each other are close in the array. No page stores a number. Each page names
// its vertices; an external sort by code brings the names of a vertex together, and its rank is the
// number. Where simplices need the numbers, another sort brings them back to the pages
// (sort/dense_ranks.hpp).
#pragma once

#include "keys/locational_code.hpp"
#include "query/pages/page_scan.hpp"
#include "query/pages/vertex_values.hpp"
#include "sort/dense_ranks.hpp"

#include <abacus/arrays.h>

namespace abacus {

/// The vertices of a mesh in the order of their numbers.
template <int D> class NumberedVertices {
public:
    /// Reads all pages.
    NumberedVertices(const Host &host, const abacus_facts &facts, std::size_t memory);

    /// False after the last one. The attributes stay valid until the next call.
    bool next(abacus_vertex &vertex);

private:
    const VertexValues<D> vertex_values_;
    const std::size_t key_;      // words of a name that identify the vertex
    RecordSort named_;           // without attributes that are apart
    std::uint64_t left_;         // vertices, as the header counts them
    const std::uint64_t *ahead_; // the next record, null after the last
    Arena<std::uint64_t> current_;
    Arena<double> apart_; // attributes of the current one
};

/// The simplices of a mesh in the order of their pages, with the numbers of their corners.
template <int D> class NumberedSimplices {
public:
    /// Reads all pages.
    NumberedSimplices(const Host &host, const abacus_facts &facts, std::size_t memory);

    /// False after the last one. The numbers of the corners are in the order of the description.
    bool next(abacus_simplex &simplex, std::uint64_t *numbers);

private:
    void enter_page();

    const Domain<D> domain_;
    DenseRanks ranks_; // of the names in pages, page by page
    PageScan<D> pages_;
    Arena<std::uint64_t> numbers_; // of the vertices of the current page
    bool in_page_ = false;
    int at_ = 0;
};

extern template class NumberedVertices<2>;
extern template class NumberedVertices<3>;
extern template class NumberedSimplices<2>;
extern template class NumberedSimplices<3>;

} // namespace abacus
