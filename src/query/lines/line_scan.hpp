// The simplices that a line meets, in order, for profiles, rays and lines of sight.
//
// Only simplices count that have more than a point in common with the line, between its beginning
// and its end. Where the line runs in a facet, or along an edge, all simplices around it have the
// same piece of the line, and the first by comes_before() is taken: the one that Reader::locate()
// finds at every place in the interior of the piece. So the answer does not depend on the line's
// direction.
//
// In a Delaunay mesh the line is followed. It leaves a simplex through the interior of a facet or
// an edge, or through a vertex (geometry/line.hpp). Across a facet the neighbour is the next
// simplex. At an edge or a vertex all simplices around it are tested; those that the line enters by
// the same face continue it. If there are none, the line leaves the mesh and never returns, since
// the mesh is convex.
//
// A line that begins outside has to find the hull. The facets of the hull that its origin o sees,
// strictly from beyond, look from o like a subdivision of a convex figure, in which the direction
// of the line is a point to locate: by a walk from ghost to ghost across ridges that have the facet
// and the line on different sides, chosen at random, so that it ends. If it reaches a facet that o
// does not see, the plane of o and the ridge has the whole mesh on the other side, and the line
// misses the mesh. If the line meets the mesh, it does so first in a point x of a facet that o
// sees: for o is outside the cone that the facets around x form.
//
// In other meshes there may be holes and pieces, and no links across them. There pages are read in
// the order in which the line meets their boxes, and their simplices wait in a heap until no
// earlier one can be in a page still to be read. The order is exact: places on the line are
// compared in rational numbers where doubles do not decide.
//
// A polygon of the extent cuts the line first, exactly (geometry/polygon.hpp). Pieces end where its
// stretches do, by their parameters.
#pragma once

#include "geometry/line.hpp"
#include "host/memory_resource.hpp"
#include "query/locate/reader.hpp"

#include <memory_resource>
#include <vector>

namespace abacus {

/// A place where a line passes from one simplex to another, or its beginning, or its end.
template <int D> struct Crossing {
    /// A facet that contains the place, with the values of its corners; not for an end.
    std::array<Point<D>, D> corner;
    std::array<double, D> value;
    /// Weights of the corners: none negative, with the sum 1. The place is in the interior of the
    /// face of the corners whose weights are not 0.
    std::array<double, D> weight;
    bool is_end = true;
    double at = 0;    // the parameter of the line, ...
    double error = 0; // and a bound on its error

    Point<D> place() const;
    /// The weighted mean of the values; a corner without weight does not count.
    double mean() const;
    bool is_same_place(const Crossing &other) const;
    /// Whether the corners that count have the same values, at the same place.
    bool has_values_of(const Crossing &other) const;
};

/// The part of a line in a simplex.
template <int D> struct LinePiece {
    Crossing<D> enters, leaves;
    bool follows = false; // the piece before, without a gap
    bool jumps = false;   // ... but has other values there: the piece before is beyond a fault
    abacus_simplex simplex;
    std::array<double, D + 1> value; // of its corners, if a polygon may cut the piece
};

template <int D> class LineScan {
public:
    /// `attribute`: the number of the attribute whose values crossings get; negative: none.
    /// Simplices outside of the extent count as outside.
    LineScan(Reader<D> &reader, const Line<D> &line, int attribute = -1,
             const abacus_extent &extent = {})
        : reader_(reader), cache_(reader.cache()), line_(line), attribute_(attribute),
          extent_(without_polygon(extent)), area_(extent.area), memory_(cache_.host()) {
        cut_line();
    }
    LineScan(const LineScan &) = delete;
    LineScan &operator=(const LineScan &) = delete;

    /// Calls visit(piece) for all pieces in order, until it returns false. The reader must not be
    /// used meanwhile.
    void each(const std::function<bool(const LinePiece<D> &)> &visit);

private:
    using Piece = LinePiece<D>;

    /// The part of the line in a simplex; nothing for a ghost.
    std::optional<Piece> piece_in(Handle h) const;
    void fill(Crossing<D> &crossing, Handle h, const FacetPlace<D> &place) const;
    /// Keeps only the first of all simplices with the same piece in found_.
    void consider(Handle h, const Crossing<D> &enters);
    bool hand_out(Piece &piece);
    /// The parts of a piece in the stretches.
    bool hand_out_parts(const Piece &piece);
    bool hand_out_whole(Piece &piece);
    /// Finds the stretches of the line in the polygon.
    void cut_line();
    Crossing<D> crossing_at(const Piece &piece, double at, const Point<D> &place) const;

    void follow();
    void begin();
    void begin_outside();
    /// The simplices around the face of ghost or simplex h in which the crossing lies.
    void look_around(Handle h, const Crossing<D> &crossing);
    void go_on();
    void trim();

    void sweep();
    /// A parameter before which the line does not reach the box; infinite if it never does.
    double reaches(const Box<D> &box) const;
    int compare(const Piece &a, const Piece &b) const;
    /// Passes on those that begin before `least`; false if no more are wanted.
    bool hand_out_until(double least);

    Reader<D> &reader_;
    Cache<D> &cache_;
    const Line<D> line_;
    const int attribute_;
    const abacus_extent extent_;
    const abacus_area *const area_;
    HostMemory memory_;
    const std::function<bool(const Piece &)> *visit_ = nullptr;
    std::pmr::vector<Polygon::Stretch> stretches_{&memory_}; // if there is a polygon
    std::size_t stretch_ = 0;                                // the first that does not end before
    std::optional<Crossing<D>> left_;                        // the end of the last piece passed on
    // When the line is followed: the current piece, and its simplex.
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
