// Finds the simplices of the thinned mesh around vertices that are left out, and the worst of the
// vertices in each. One thread's.
//
// The worst vertex of a simplex so far is kept in a table of fixed size. Where two simplices want
// one place of it, the former is handed out as a candidate; so a simplex may have several, the
// worst one among them.
//
// Vertices outside of the thinned mesh belong to the ghosts whose facets they see. The worst of
// these is the one farthest from the facet's line or plane, of several the lexicographically least:
// it is a corner of the hull of all vertices.
#pragma once

#include "geometry/misfit.hpp"
#include "query/locate/reader.hpp"
#include "thin/candidate.hpp"

#include <optional>

namespace abacus {

template <int D> class Finder {
public:
    /// What to look for.
    enum class Aim {
        outside, ///< vertices outside of the mesh
        misfits, ///< vertices farther from its surface than the bound
        greatest ///< how far they are at most
    };
    struct Options {
        int attribute;            ///< of the thinned mesh
        double bound;             ///< greatest error
        std::size_t vertex_words; ///< of a vertex, as in a candidate
        std::size_t cache_bytes;
    };

    Finder(const Host &host, const abacus_facts &facts, const Options &options, Aim aim);

    /// Looks at a vertex; returns whether it is outside of the mesh.
    bool look(const std::uint64_t *vertex);
    /// Empties the table: what it had are candidates.
    void flush();
    /// Candidates, one after the other.
    Arena<std::uint64_t> &candidates() { return candidates_; }
    std::size_t stride() const { return Candidate<D>::head_words + vertex_words_; }
    double greatest() const { return greatest_; }

private:
    /// The worst vertex of a simplex.
    struct Place {
        Piece<D> piece; // a ghost: without the last corner
        bool is_taken, is_ghost;
        Magnitude misfit;
    };
    static constexpr std::size_t places = 1024;

    void look_outside(const std::uint64_t *vertex, const Point<D> &p, Handle ghost);
    void look_inside(const std::uint64_t *vertex, const Point<D> &p, Handle h);
    /// The simplex's misfits; of the one asked for last they are at hand.
    const Misfit<D> &misfits(Handle h);
    /// A vertex of a simplex, unless the place's is worse.
    void compete(Handle h, bool is_ghost, const Magnitude &misfit, const std::uint64_t *vertex);
    bool is_worse(const Place &place, const std::uint64_t *kept, const Magnitude &misfit,
                  const std::uint64_t *vertex) const;
    void hand_out(std::size_t number);
    std::uint64_t *kept(std::size_t number) { return vertices_.data() + number * vertex_words_; }

    const std::size_t vertex_words_;
    const int attribute_;
    const double bound_;
    const Aim aim_;
    Reader<D> reader_;
    Arena<Place> table_;
    Arena<std::uint64_t> vertices_, candidates_;
    double greatest_ = 0;
    Piece<D> piece_; // of the simplex looked at last
    Handle last_ = no_handle;
    std::uint64_t evictions_ = 0; // when it was
    std::optional<Misfit<D>> misfits_;
};

/// Whether of two vertices in one simplex the first comes first, being worse: decided exactly.
template <int D>
bool comes_first(const Piece<D> &piece, bool is_ghost, const std::uint64_t *vertex,
                 const std::uint64_t *other);

} // namespace abacus
