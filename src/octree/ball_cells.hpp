// The cells of a closed ball on an octree's grid. Exact.
//
// An octant has its lower sides and, except at the end of the domain, not its upper ones. So where
// its place nearest to the center is on an upper side, it comes as near as one likes to that
// distance but does not reach it: then the ball must have that place inside, not on its sphere.
#pragma once

#include "geometry/ball.hpp"
#include "octree/grid.hpp"

namespace abacus {

template <int D> class BallCells {
public:
    BallCells(const Grid<D> &grid, const Ball<D> &ball) : grid_(grid), ball_(ball) {}

    bool meets(const Octant<D> &octant) const {
        const Cell<D> at = octant.cell();
        const Box<D> box = grid_.box(at, octant.edge());
        const Point<D> nearest = box.nearest(ball_.center);
        bool is_reached = true;
        for (int i = 0; i < D; ++i)
            if (nearest[i] == box.upper[i] && at[i] + octant.edge() != axis_cells<D>)
                is_reached = false;
        return ball_.side(nearest) < is_reached;
    }
    bool contains(const Octant<D> &octant) const {
        const Box<D> box = grid_.box(octant);
        for (int i = 0; i < Octant<D>::children; ++i)
            if (!ball_.contains(box.corner(i))) return false;
        return true;
    }
    /// The first cell on the curve, from `from` on; domain_cells if there is none.
    std::uint64_t next(std::uint64_t from) const { return next_cell<D>(*this, from); }

private:
    const Grid<D> grid_;
    const Ball<D> ball_;
};

} // namespace abacus
