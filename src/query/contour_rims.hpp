// The rim of what contours are made of: edges that have a triangle on one side only, since the mesh
// ends there, or the other triangle was left out.
//
// A page gives the edges that have one triangle there. Sorted, those of all pages that have
// another one elsewhere come in pairs. What is left bounds bands, in pieces between the levels that
// it crosses.
//
// Where two pieces meet at a vertex the rim goes on. As a rule one edge leads there and one leads
// away. At some vertices the rim passes several times: the triangles there are in several fans. An
// edge that leads there ends a fan, and the rim goes on with the edge that begins the same fan. It
// is the first one from there clockwise, decided exactly. At the end of a fault it comes back along
// the other side of the fault, after a full turn.
#pragma once

#include "host/arena.hpp"
#include "query/contour_pieces.hpp"

namespace abacus {

class ContourRims {
public:
    ContourRims(const Host &host, const ContourWindow &window, const ContourLevels &levels,
                std::size_t memory);

    /// An edge, with the triangle to its left.
    void add(const ContourPoint &from, double value_from, const ContourPoint &to, double value_to);
    /// No more come. Adds the pieces of those that have no triangle to their right.
    void finish(ContourPieces &pieces);

private:
    /// An edge at one of its ends.
    struct Spoke {
        ContourPoint other;
        double value, other_value;
    };

    void find_spokes();
    void go_on(const ContourPoint &vertex, ContourPieces &pieces) const;
    const Spoke &next_clockwise(const Point<2> &vertex, const Spoke &from) const;
    void add_pieces(const ContourPoint &vertex, const Spoke &from, const Spoke &to,
                    ContourPieces &pieces) const;

    const ContourWindow &window_;
    const ContourLevels &levels_;
    // Ends of edges: place, id.
    static constexpr std::size_t end_words = 3, edge_words = 2 * end_words + 3;
    RecordSort edges_;  // the lesser end, the greater, whether it leads there, values
    RecordSort spokes_; // vertex, whether it leads away, the other end, values
    Arena<Spoke> arrive_, leave_;
};

} // namespace abacus
