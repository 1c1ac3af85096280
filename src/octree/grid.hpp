// The grid of an octree's finest cells over its domain, a box of any shape.
//
// Where the lines of the grid are is rounded, once: line() says it, and everything else compares
// with that. So a place lies in the octant whose lines are around it, to the last bit. Octants have
// their lower sides and not their upper ones, except at the upper end of the domain.
#pragma once

#include "keys/domain_of.hpp"
#include "octree/octant.hpp"

#include <abacus/facts.h>

#include <algorithm>
#include <cmath>

namespace abacus {

template <int D> class Grid {
public:
    explicit Grid(const abacus_form &form) : domain_(domain_box<D>(form)) {}

    /// The coordinate of a line, 0 to axis_cells; never less than that of the line before.
    double line(int axis, std::uint64_t i) const {
        const double lower = domain_.lower[axis], upper = domain_.upper[axis];
        if (i == axis_cells<D>) return upper;
        const double share = std::ldexp(static_cast<double>(i), -code_bits<D>);
        return std::min(lower + (upper - lower) * share, upper);
    }
    /// The cell that has a place; false outside the domain.
    bool find(const Point<D> &place, Cell<D> &cell) const {
        for (int i = 0; i < D; ++i) {
            if (!(domain_.lower[i] <= place[i] && place[i] <= domain_.upper[i])) return false;
            cell[i] = find(i, place[i]);
        }
        return true;
    }
    /// The cells that a box meets; false if there are none.
    bool find(const Box<D> &places, CellBox<D> &cells) const {
        for (int i = 0; i < D; ++i) {
            const double lower = places.lower[i], upper = places.upper[i];
            if (!(lower <= upper && lower <= domain_.upper[i] && domain_.lower[i] <= upper))
                return false;
            cells.least[i] = find(i, std::max(lower, domain_.lower[i]));
            cells.greatest[i] = find(i, std::min(upper, domain_.upper[i]));
        }
        return true;
    }
    /// The cell of the place of the domain that is nearest to one.
    Cell<D> nearest_cell(const Point<D> &place) const {
        Cell<D> cell;
        find(domain_.nearest(place), cell);
        return cell;
    }
    /// An octant's box, its upper sides included.
    Box<D> box(const Octant<D> &octant) const { return box(octant.cell(), octant.edge()); }
    /// By its least cell, and how many cells an edge has.
    Box<D> box(const Cell<D> &at, std::uint64_t edge) const {
        Box<D> box;
        for (int i = 0; i < D; ++i) {
            box.lower[i] = line(i, at[i]);
            box.upper[i] = line(i, at[i] + edge);
        }
        return box;
    }
    Point<D> center(const Octant<D> &octant) const {
        const Box<D> b = box(octant);
        Point<D> p;
        for (int i = 0; i < D; ++i) p[i] = b.lower[i] + (b.upper[i] - b.lower[i]) / 2;
        return p;
    }
    /// The longest edge of octants of a level.
    double edge(int level) const {
        double longest = 0;
        for (int i = 0; i < D; ++i)
            longest = std::max(longest, domain_.upper[i] - domain_.lower[i]);
        return std::ldexp(longest, -level);
    }

private:
    /// The last cell that begins at or below x, which is within the domain.
    std::uint32_t find(int axis, double x) const {
        const double lower = domain_.lower[axis], upper = domain_.upper[axis];
        const double share = (x - lower) / (upper - lower);
        const auto guess = static_cast<std::uint64_t>(std::clamp(
            std::ldexp(share, code_bits<D>), 0.0, static_cast<double>(axis_cells<D> - 1)));
        if (line(axis, guess) <= x && (guess + 1 == axis_cells<D> || x < line(axis, guess + 1)))
            return static_cast<std::uint32_t>(guess);
        std::uint64_t least = 0, end = axis_cells<D>; // the answer is in [least, end)
        while (end - least > 1) {
            const std::uint64_t middle = least + (end - least) / 2;
            (line(axis, middle) <= x ? least : end) = middle;
        }
        return static_cast<std::uint32_t>(least);
    }

    Box<D> domain_;
};

} // namespace abacus
