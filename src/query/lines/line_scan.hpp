// The simplices that a line meets, in order: profiles, rays and lines of sight ask for them.
//
// Only those count that have more than a point in common with the line, between its beginning and
// its end; what touches in a point does not. Where the line runs in a facet, or along an edge, all
// simplices around that have the same piece of it, and the first by comes_before() is taken: the
// one that Reader::locate() finds at every place in the inside of the piece. So the answer does not
// depend on the line's direction.
//
// In a Delaunay mesh the line is followed. It leaves a simplex in the inside of a facet, an edge or
// a vertex (geometry/line.hpp). Across a facet the neighbour is the next one. At an edge or a
// vertex all simplices around are gone through; those go on that are entered by the same face. If
// there are none the line leaves the mesh, and never comes back, since that is convex.
//
// A line that begins outside has to find the hull. The facets of the hull that its origin o sees,
// strictly from beyond, look from o like a subdivision of a convex figure, in which the direction
// of the line is a point to be located: by a walk from ghost to ghost across ridges that have the
// facet and the line on different sides, chosen at random, so that it ends. If it comes to a facet
// that o does not see, the plane of o and the ridge has all of the mesh on the other side, and the
// line passes the mesh by. If the line meets the mesh then first in a point x that is in a facet
// which o sees: for o is outside of the cone that the facets around x make up.
//
// In other meshes there may be holes and pieces, and no links across them. There pages are read in
// the order in which the line comes to their boxes, and their simplices wait in a heap, until it is
// sure that none that comes earlier is in a page to be read. The order is exact: places on the line
// are compared in rational numbers where doubles do not decide.
#pragma once

#include "geometry/line.hpp"
#include "host/memory_resource.hpp"
#include "query/locate/reader.hpp"

#include <memory_resource>
#include <vector>

namespace abacus {

/// A place where a line passes from one simplex to another, or its beginning, or its end.
template <int D> struct Crossing {
    /// A facet that has the place in it, with the values of its corners; not of an end.
    std::array<Point<D>, D> corner;
    std::array<double, D> value;
    /// Of the corners: none negative, with the sum 1. The place is in the inside of the face of
    /// those that are not 0.
    std::array<double, D> weight;
    bool is_end = true;
    double at = 0;    // the parameter of the line, ...
    double error = 0; // and a bound on its error

    Point<D> place() const;
    /// The mean of the values by weight; a corner without weight does not count.
    double mean() const;
    bool is_same_place(const Crossing &other) const;
    /// Whether the corners that count have the same values, at the same place.
    bool has_values_of(const Crossing &other) const;
};

/// What a simplex has of a line.
template <int D> struct LinePiece {
    Crossing<D> enters, leaves;
    bool follows = false; // the piece before, without a gap
    bool jumps = false;   // ... and has other values there: the piece before is beyond a fault
    abacus_simplex simplex;
};

template <int D> class LineScan {
public:
    /// `attribute`: the number of the one that crossings get values of; negative: none. Simplices
    /// with an edge longer than max_edge count as outside.
    LineScan(Reader<D> &reader, const Line<D> &line, int attribute = -1,
             double max_edge = no_max_edge)
        : reader_(reader), cache_(reader.cache()), line_(line), attribute_(attribute),
          max_edge_(max_edge), memory_(cache_.host()) {}
    LineScan(const LineScan &) = delete;
    LineScan &operator=(const LineScan &) = delete;

    /// Calls visit(piece) for all pieces in order, until it returns false. The reader must not be
    /// used meanwhile.
    void each(const std::function<bool(const LinePiece<D> &)> &visit);

private:
    using Piece = LinePiece<D>;

    /// What a simplex has of the line; nothing of a ghost.
    std::optional<Piece> piece_in(Handle h) const;
    void fill(Crossing<D> &crossing, Handle h, const FacetPlace<D> &place) const;
    /// Keeps the first of all that have the same piece, in found_.
    void consider(Handle h, const Crossing<D> &enters);
    bool hand_out(Piece &piece);

    void follow();
    void begin();
    void begin_outside();
    /// The simplices around the face of ghost or simplex h in which the crossing lies.
    void look_around(Handle h, const Crossing<D> &crossing);
    void go_on();
    void trim();

    void sweep();
    /// A parameter that the line does not come to the box before; infinite if it never does.
    double reaches(const Box<D> &box) const;
    int compare(const Piece &a, const Piece &b) const;
    /// Hands out those that begin before `least`; false if no more are wanted.
    bool hand_out_until(double least);

    Reader<D> &reader_;
    Cache<D> &cache_;
    const Line<D> line_;
    const int attribute_;
    const double max_edge_;
    HostMemory memory_;
    const std::function<bool(const Piece &)> *visit_ = nullptr;
    std::optional<Crossing<D>> left_; // where the piece handed out last ends
    // A line that is followed: the piece at hand, and its simplex.
    std::optional<Piece> found_;
    Handle at_ = no_handle;
    // In a sweep: a heap.
    std::pmr::vector<Piece> ahead_{&memory_};
};

extern template struct Crossing<2>;
extern template struct Crossing<3>;
extern template class LineScan<2>;
extern template class LineScan<3>;

} // namespace abacus
