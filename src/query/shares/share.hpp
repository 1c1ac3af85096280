// A part of a mesh, with layers of simplices around it and numbers for its vertices.
//
// V(0) are the vertices of the part's simplices; V(k + 1) are those of all simplices at a vertex of
// V(k). So the share has the simplices at a vertex of V(halo - 1), and its vertices are V(halo); a
// layer without a new vertex is the last one, however many are wanted. A
// vertex belongs to the least part that has a simplex at it; so all simplices at the vertices of
// V(halo) are read, also those beyond the share.
//
// Neighbours are found by their places, since in a loaded mesh simplices may share a vertex alone:
// all simplices at a vertex are on pages whose boxes contain it. For each layer such pages are
// added to those read so far. Pages do not know which of their vertices others have named: sorts
// bring that together (vertex_groups.hpp). So no table grows with the share, and other pages are
// not read.
#pragma once

#include "query/pages/vertex_values.hpp"
#include "query/shares/cut.hpp"
#include "query/shares/page_set.hpp"
#include "query/shares/vertex_groups.hpp"

#include <functional>

namespace abacus {

template <int D> class Share {
public:
    /// Of a part with simplices, whose piece is `own`.
    Share(const Host &host, const abacus_facts &facts, const Cut<D> &cut, std::size_t own,
          std::uint32_t halo, std::size_t memory);

    /// Calls visit(vertex) in the order of the numbers.
    void vertices(const std::function<void(const abacus_share_vertex &)> &visit);
    /// Calls visit(simplex) page by page; labels and markers are not filled in.
    void simplices(const std::function<void(abacus_share_simplex &)> &visit);

private:
    // What is known of a vertex of a page: whether it is in V(k), and in V(k - 1), whether this is
    // the first page that names it, and the piece that it belongs to.
    static constexpr std::uint64_t is_in = 1, was_in = 2, is_first = 4;
    static constexpr int piece_shift = 3;
    static constexpr std::uint64_t no_piece = ~std::uint64_t{0} >> piece_shift;

    /// Calls visit(page, box) for the pages known so far, with the answers of the last layer.
    template <class Visit> void each_known(Visit visit);
    void enter(const PageView<D> &page, std::size_t box);
    /// Sets in_: which vertices of the page are in V(k).
    void find_members(const PageView<D> &page);
    /// Adds all pages that may have a simplex at a vertex of V(k).
    void reach();
    /// Answers for all pages, for V(k). False if V(k - 1) is the same: then so are all further
    /// ones.
    bool join();
    bool is_member(const PageView<D> &page, int simplex) const;
    /// Comes first in the order of the numbers: the part itself, then the others.
    std::uint64_t rank_of(std::uint64_t answer) const {
        const std::uint64_t piece = answer >> piece_shift;
        return piece == own_ ? 0 : piece + 1;
    }

    const Host &host_;
    const abacus_facts facts_;
    const Cut<D> &cut_;
    const std::size_t own_;
    const std::uint32_t halo_;
    const std::size_t memory_;
    const VertexNames<D> names_;
    const VertexValues<D> vertex_values_;
    std::uint32_t layer_ = 0;      // k
    std::uint64_t former_ = is_in; // the bit of V(k - 1) in the answers
    PageSet<D> reached_, known_;
    std::optional<PlacedWords> answers_; // of the last layer, for the vertices of known_
    std::uint64_t place_ = 0;            // of the current page's first vertex in answers_
    typename Cut<D>::Range range_{};     // of the current page
    std::array<std::uint64_t, page_vertices<D>> answer_;
    std::array<bool, page_vertices<D> + 1> in_;
};

extern template class Share<2>;
extern template class Share<3>;

} // namespace abacus
