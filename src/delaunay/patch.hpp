// A part of a triangulation in the plane that is made anew within its boundary: where a segment has
// been put through triangles, or a vertex has been taken out of a constrained mesh. Its pieces
// (pieces.hpp) become simplices of the mesh at the end.
#pragma once

#include "delaunay/delaunay.hpp"
#include "delaunay/pieces.hpp"

namespace abacus {

class Patch : private Pieces {
public:
    using Pieces::add;
    using Pieces::fill_chain;
    using Pieces::fill_fan;
    using Pieces::fill_funnel;
    using Pieces::fill_star;
    using Pieces::join;
    using Pieces::set_region;
    using Pieces::Side;
    using Pieces::unknown;

    explicit Patch(Delaunay<2> &mesh);

    void begin();
    /// An edge of a simplex that stays. Both its sides must be cached.
    Side outside(Link edge);
    /// Both sides of an edge with the part on either side, for two edges of a chain.
    std::array<Side, 2> inside(Fixed how);

    /// Flips edges, then creates the simplices. Returns how many.
    std::size_t finish();
    /// Creates the simplices as they are. Calls visit(a, b) for both ends of each edge between two
    /// pieces of which one is among the first `pieces`.
    template <class Visit> void finish_as_is(std::size_t pieces, Visit visit) {
        join_pairs();
        const Pieces &all = *this;
        for (std::size_t n = 0; n < pieces; ++n)
            for (int i = 0; i < 3; ++i) {
                const Side beyond = all[n].beyond[i];
                if (is_outside(beyond) || piece_of(beyond) < n) continue;
                visit(all[n].vertex[(i + 1) % 3], all[n].vertex[(i + 2) % 3]);
            }
        create_all();
    }

private:
    struct Pair { // of what outside() has numbered
        std::array<Side, 2> side;
        Fixed how;
    };

    /// Makes the pairs of inside() edges of pieces.
    void join_pairs();
    void create_all();

    Delaunay<2> &mesh_;
    Arena<Link> outer_; // of what is outside; `unset` of pairs
    Arena<Pair> pairs_;
    Arena<Handle> created_;
};

} // namespace abacus
