// Thins a mesh to a stated error: grows the Delaunay triangulation of some of its vertices until
// all others lie within the error of its surface.
//
// It begins with the corners of the hull of all vertices with values. Then it goes in rounds: in
// each simplex that has a vertex farther from its surface than the error, the worst one is taken;
// of equals the lexicographically least. All are inserted at once. A vertex on a facet counts in
// every simplex there. So what a round adds depends on the two meshes alone, and the answer on the
// first.
//
// A round is one pass over the vertices along the curve. They are gathered in batches, which
// threads locate in the thinned mesh (finder.hpp); candidates are sorted by simplex, the worst of
// each is found exactly, and these are sorted along the curve. Only vertices in cells that changed
// simplices meet are looked at again (due_cells.hpp): every simplex that an insertion makes has the
// inserted vertex as a corner, so the stars of the last round's vertices are all that has changed.
//
// Corners of the hull are found in the same way, as quickhull does: of the vertices beyond a facet
// of the hull so far the farthest is taken.
//
// With a target, the round that would exceed it takes the vertices with the largest errors, of
// equals the lexicographically least.
//
// Memory: sorting and batches take what the options grant, and spools beyond; the cells two
// megabits.
#pragma once

#include "sort/record_sort.hpp"
#include "staging/stage.hpp"
#include "thin/due_cells.hpp"
#include "thin/finder.hpp"
#include "thin/source_vertices.hpp"

#include <abacus/thin.h>

namespace abacus {

template <int D> class Thinning {
public:
    /// `host` and facts: of the thinned mesh.
    Thinning(const Host &host, const abacus_facts &facts, const abacus_thin_options &options);

    /// Adds the vertices of a step to a stage; returns how many.
    std::uint64_t find(abacus_thin_step step, const Host &source_host, const abacus_facts &source,
                       const abacus_facts &facts, Stage<D> &stage);
    void inserted(const abacus_facts &facts);
    /// The ids that the next steps KEEP are about.
    void set_kept(const std::int64_t *ids, std::size_t count);
    /// Those of them with which no vertex has been found.
    std::uint64_t unknown_ids() const;

    struct Greatest {
        double error;
        std::uint64_t without_value; // vertices
    };
    Greatest greatest(const Host &source_host, const abacus_facts &source,
                      const abacus_facts &facts);

private:
    using Source = SourceVertices<D>;
    using Aim = typename Finder<D>::Aim;

    /// Words of a chosen vertex before its candidate: its error, for a target, its code and place.
    static constexpr std::size_t chosen_head = 2 + D;

    std::uint64_t start(const Host &source_host, const abacus_facts &source, Stage<D> &stage);
    /// Vertices of the border or of fixed edges, or with ids to keep.
    std::uint64_t keep(abacus_thin_step step, const Host &source_host, const abacus_facts &source,
                       const abacus_facts &facts, Stage<D> &stage);
    std::uint64_t rise(Aim aim, const Host &source_host, const abacus_facts &source,
                       const abacus_facts &facts, Stage<D> &stage);
    template <class Found>
    double look(Aim aim, const Host &source_host, const abacus_facts &source,
                const abacus_facts &facts, Found found);
    std::uint64_t count_without_value(const Host &source_host, const abacus_facts &source);

    /// Whether an id is to be kept; notes that it is known.
    bool is_kept_id(std::int64_t id);

    void forget_chosen();
    void begin_to_choose();
    /// Chooses a vertex; returns the words of its candidate, whose head is not set.
    std::uint64_t *choose(const std::uint64_t *vertex, double error);
    /// Of the candidates, which are sorted, the worst of each simplex.
    void choose_worst(RecordSort &candidates, bool with_errors);
    /// Adds the first so many different ones of those chosen, without vertices of a mesh.
    std::uint64_t hand_out(const Host &source_host, const abacus_facts &source, std::uint64_t room,
                           Stage<D> &stage, Reader<D> *without);
    void add(const Source &source, const std::uint64_t *vertex, Stage<D> &stage);
    typename Finder<D>::Options finder_options() const;

    const Host &host_;
    const abacus_thin_options options_;
    const Domain<D> domain_;
    const unsigned attributes_;
    const std::size_t vertex_words_, stride_;
    DueCells<D> due_, outside_;
    std::optional<abacus_thin_step> done_; // the last step, if its vertices are in the mesh
    std::optional<abacus_thin_step> found_;
    std::optional<RecordSort> chosen_;
    Arena<std::uint64_t> record_;
    Arena<std::int64_t> kept_; // in ascending order
    Arena<std::uint8_t> is_known_;
};

extern template class Thinning<2>;
extern template class Thinning<3>;

} // namespace abacus
