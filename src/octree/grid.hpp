// The grid of an octree's finest cells over its domain, a box of any shape.
//
// Where the lines of the grid are is rounded, once: line() says it, and everything else compares
// with that. So a place lies in the octant whose lines are around it, to the last bit. Octants have
// their lower sides and not their upper ones, except at the upper end of the domain.
#pragma once

#include "geometry/point.hpp"
#include "octree/octant.hpp"

#include <abacus/header.h>

#include <algorithm>
#include <cmath>

namespace abacus {

template <int D> class Grid {
public:
    explicit Grid(const abacus_header &header) {
        std::copy_n(header.lower, D, lower_.begin());
        std::copy_n(header.upper, D, upper_.begin());
    }

    /// The coordinate of a line, 0 to axis_cells; never less than that of the line before.
    double line(int axis, std::uint64_t i) const {
        if (i == axis_cells<D>) return upper_[axis];
        const double share = std::ldexp(static_cast<double>(i), -code_bits<D>);
        return std::min(lower_[axis] + (upper_[axis] - lower_[axis]) * share, upper_[axis]);
    }
    /// The cell that has a place; false outside the domain.
    bool find(const Point<D> &place, Cell<D> &cell) const {
        for (int i = 0; i < D; ++i) {
            if (!(lower_[i] <= place[i] && place[i] <= upper_[i])) return false;
            cell[i] = find(i, place[i]);
        }
        return true;
    }
    /// The cells that a box meets; false if there are none.
    bool find(const Point<D> &lower, const Point<D> &upper, CellBox<D> &box) const {
        for (int i = 0; i < D; ++i) {
            if (!(lower[i] <= upper[i] && lower[i] <= upper_[i] && lower_[i] <= upper[i]))
                return false;
            box.least[i] = find(i, std::max(lower[i], lower_[i]));
            box.greatest[i] = find(i, std::min(upper[i], upper_[i]));
        }
        return true;
    }
    /// The place of the domain that is nearest to one, and its cell.
    Point<D> clamp(const Point<D> &place) const {
        Point<D> p;
        for (int i = 0; i < D; ++i) p[i] = std::clamp(place[i], lower_[i], upper_[i]);
        return p;
    }
    Cell<D> nearest_cell(const Point<D> &place) const {
        Cell<D> cell;
        find(clamp(place), cell);
        return cell;
    }
    Point<D> lower(const Octant<D> &octant) const {
        const Cell<D> at = octant.cell();
        Point<D> p;
        for (int i = 0; i < D; ++i) p[i] = line(i, at[i]);
        return p;
    }
    Point<D> upper(const Octant<D> &octant) const {
        const Cell<D> at = octant.cell();
        Point<D> p;
        for (int i = 0; i < D; ++i) p[i] = line(i, at[i] + octant.edge());
        return p;
    }
    Point<D> center(const Octant<D> &octant) const {
        const Point<D> a = lower(octant), b = upper(octant);
        Point<D> p;
        for (int i = 0; i < D; ++i) p[i] = a[i] + (b[i] - a[i]) / 2;
        return p;
    }
    /// The longest edge of octants of a level.
    double edge(int level) const {
        double longest = 0;
        for (int i = 0; i < D; ++i) longest = std::max(longest, upper_[i] - lower_[i]);
        return std::ldexp(longest, -level);
    }

private:
    /// The last cell that begins at or below x, which is within the domain.
    std::uint32_t find(int axis, double x) const {
        const double share = (x - lower_[axis]) / (upper_[axis] - lower_[axis]);
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

    Point<D> lower_, upper_;
};

} // namespace abacus
