// A convex polytope with rational corners, and linear functions: exact. It begins as a simplex, and
// is cut where such functions are negative.
//
// For files of unit `exact` alone (sources.mk).
#pragma once

#include "geometry/box.hpp"
#include "geometry/linear_piece.hpp"
#include "geometry/linear_system.hpp"
#include "geometry/polygon.hpp"
#include "geometry/rational.hpp"

#include <cmath>
#include <vector>

namespace abacus::exact {

template <int D> using RationalPoint = std::array<Rational, D>;

template <int D> RationalPoint<D> rational(const Point<D> &p) {
    RationalPoint<D> at;
    for (int axis = 0; axis < D; ++axis) at[axis] = Rational(p[axis]);
    return at;
}

/// A linear function of all points.
template <int D> struct LinearFunction {
    RationalPoint<D> gradient;
    Rational constant;

    Rational operator()(const RationalPoint<D> &at) const {
        Rational value = constant;
        for (int axis = 0; axis < D; ++axis) value += gradient[axis] * at[axis];
        return value;
    }
    void pass_through(const RationalPoint<D> &at, const Rational &value) {
        constant = 0;
        constant = value - (*this)(at);
    }
    void negate() {
        for (Rational &x : gradient) x = -x;
        constant = -constant;
    }
};

/// The function of a simplex, continued beyond it.
template <int D> LinearFunction<D> function_of(const Piece<D> &piece) {
    LinearSystem<Rational, D> system;
    const RationalPoint<D> origin = rational<D>(piece.corner[0]);
    for (int i = 0; i < D; ++i) {
        const RationalPoint<D> end = rational<D>(piece.corner[i + 1]);
        for (int axis = 0; axis < D; ++axis) system.matrix[i][axis] = end[axis] - origin[axis];
        system.right[i] = Rational(piece.value[i + 1]) - Rational(piece.value[0]);
    }
    const Rational whole = system.determinant(system.matrix);
    LinearFunction<D> function;
    for (int axis = 0; axis < D; ++axis)
        function.gradient[axis] = system.with_right_side(axis) / whole;
    function.pass_through(origin, Rational(piece.value[0]));
    return function;
}

/// A function that is 0 on a line or plane.
template <int D> LinearFunction<D> side_of(const std::array<const Point<D> *, D> &facet) {
    const RationalPoint<D> origin = rational<D>(*facet[0]);
    std::array<RationalPoint<D>, D - 1> way;
    for (int i = 0; i + 1 < D; ++i) {
        way[i] = rational<D>(*facet[i + 1]);
        for (int axis = 0; axis < D; ++axis) way[i][axis] -= origin[axis];
    }
    LinearFunction<D> side;
    if constexpr (D == 2)
        side.gradient = {-way[0][1], way[0][0]};
    else
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            side.gradient[i] = way[0][j] * way[1][k] - way[0][k] * way[1][j];
        }
    side.pass_through(origin, 0);
    return side;
}

/// The side of a bound on an axis.
template <int D> LinearFunction<D> side_of(int axis, double bound, bool is_lower) {
    LinearFunction<D> side;
    for (int i = 0; i < D; ++i) side.gradient[i] = i == axis ? 1 : 0;
    side.constant = -Rational(bound);
    if (!is_lower) side.negate();
    return side;
}

/// A convex polytope with inner points, by its corners, each with a bit for every facet that it is
/// on.
template <int D> class Polytope {
public:
    explicit Polytope(const Piece<D> &simplex) {
        for (int i = 0; i <= D; ++i) {
            const unsigned all = (1U << (D + 1)) - 1;
            corners_.push_back({rational<D>(simplex.corner[i]), all & ~(1U << i)});
        }
        facets_ = D + 1;
    }

    /// Keeps where a function is not negative; false if nothing with inner points is left.
    bool cut(const LinearFunction<D> &side) {
        const std::uint32_t bit = std::uint32_t{1} << facets_++;
        std::vector<Rational> sides;
        bool is_any = false, is_all = true;
        for (const Corner &corner : corners_) {
            sides.push_back(side(corner.at));
            is_any = is_any || sides.back() > 0;
            is_all = is_all && sides.back() >= 0;
        }
        if (!is_any) return false;
        std::vector<Corner> kept;
        for (std::size_t i = 0; i < corners_.size(); ++i)
            if (sides[i] >= 0) {
                kept.push_back(corners_[i]);
                if (sides[i] == 0) kept.back().facets |= bit;
            }
        for (std::size_t i = 0; !is_all && i < corners_.size(); ++i)
            for (std::size_t j = 0; j < corners_.size(); ++j)
                if (sides[i] > 0 && sides[j] < 0 && is_edge(i, j))
                    kept.push_back(between(i, j, Rational(sides[i] / (sides[i] - sides[j])), bit));
        corners_.swap(kept);
        return true;
    }
    /// Keeps what lies in a simplex.
    bool cut(const Piece<D> &simplex) {
        for (int i = 0; i <= D; ++i) {
            std::array<const Point<D> *, D> facet;
            for (int j = 0; j < D; ++j) facet[j] = &simplex.corner[j + (j >= i)];
            LinearFunction<D> side = side_of<D>(facet);
            if (side(rational<D>(simplex.corner[i])) < 0) side.negate();
            if (!cut(side)) return false;
        }
        return true;
    }
    /// Keeps what lies in a box.
    bool cut(const Box<D> &box) {
        for (int axis = 0; axis < D; ++axis)
            for (const bool is_lower : {true, false}) {
                const double bound = is_lower ? box.lower[axis] : box.upper[axis];
                if (std::isfinite(bound) && !cut(side_of<D>(axis, bound, is_lower))) return false;
            }
        return true;
    }
    /// Keeps what lies in a part of a polygon.
    bool cut(const Polygon::Trapezoid &part) {
        const LinearFunction<2> below = side_of<2>(std::array{part.lower[0], part.lower[1]});
        LinearFunction<2> above = side_of<2>(std::array{part.upper[0], part.upper[1]});
        above.negate();
        return cut(side_of<2>(0, part.left, true)) && cut(side_of<2>(0, part.right, false)) &&
               cut(below) && cut(above);
    }
    template <class Visit> void each_corner(Visit visit) const {
        for (const Corner &corner : corners_) visit(corner.at);
    }
    /// Calls visit(corners) for simplices that make it up: the first corner with simplices of the
    /// facets that do not have it.
    template <class Visit> void each_simplex(Visit visit) const {
        std::vector<std::vector<std::size_t>> seen;
        for (unsigned facet = 0; facet < facets_; ++facet) {
            const std::uint32_t bit = std::uint32_t{1} << facet;
            std::vector<std::size_t> on;
            for (std::size_t i = 0; i < corners_.size(); ++i)
                if ((corners_[i].facets & bit) != 0) on.push_back(i);
            // A cut may only touch, or run along another one.
            if (on.size() < D || on[0] == 0 ||
                std::find(seen.begin(), seen.end(), on) != seen.end())
                continue;
            seen.push_back(on);
            each_of_facet(on, visit);
        }
    }

private:
    struct Corner {
        RationalPoint<D> at;
        std::uint32_t facets;
    };

    /// Two corners are the ends of an edge if no other one is on all facets that both are on.
    bool is_edge(std::size_t i, std::size_t j) const {
        const std::uint32_t common = corners_[i].facets & corners_[j].facets;
        for (std::size_t k = 0; k < corners_.size(); ++k)
            if (k != i && k != j && (corners_[k].facets & common) == common) return false;
        return true;
    }
    /// `on`: the corners of a facet.
    template <class Visit>
    void each_of_facet(const std::vector<std::size_t> &on, Visit visit) const {
        const auto at = [&](std::size_t i) -> const RationalPoint<D> & { return corners_[i].at; };
        if constexpr (D == 2)
            return visit(std::array{at(0), at(on[0]), at(on[1])});
        else
            for (std::size_t i = 1; i < on.size(); ++i)
                for (std::size_t j = i + 1; j < on.size(); ++j)
                    if (is_edge(on[i], on[j]))
                        visit(std::array{at(0), at(on[0]), at(on[i]), at(on[j])});
    }
    Corner between(std::size_t i, std::size_t j, const Rational &share, std::uint32_t bit) const {
        const Corner &a = corners_[i], &b = corners_[j];
        Corner corner{a.at, (a.facets & b.facets) | bit};
        for (int axis = 0; axis < D; ++axis) corner.at[axis] += share * (b.at[axis] - a.at[axis]);
        return corner;
    }

    std::vector<Corner> corners_;
    unsigned facets_; ///< of all cuts; there are at most 14
};

/// Calls visit(polytope) for the parts that a simplex has in common with another one, a box, and in
/// the plane a polygon, which may be null.
template <int D, class Visit>
void each_common_part(const Piece<D> &first, const Piece<D> &second, const Box<D> &box,
                      const Polygon *polygon, Visit visit) {
    Box<D> around;
    for (const Point<D> &p : first.corner) around.extend(p);
    if (!around.meets(box)) return;
    Polytope<D> common(first);
    const bool is_inside = box.contains(around.lower) && box.contains(around.upper);
    if (!common.cut(second) || (!is_inside && !common.cut(box))) return;
    if constexpr (D == 2)
        if (polygon != nullptr)
            return polygon->each_part(around, [&](const Polygon::Trapezoid &part) {
                Polytope<2> in_part = common;
                if (in_part.cut(part)) visit(in_part);
            });
    visit(common);
}

/// The first function less the second one, both continued beyond their simplices.
template <int D> LinearFunction<D> difference_of(const Piece<D> &first, const Piece<D> &second) {
    LinearFunction<D> difference = function_of<D>(first);
    const LinearFunction<D> less = function_of<D>(second);
    for (int axis = 0; axis < D; ++axis) difference.gradient[axis] -= less.gradient[axis];
    difference.constant -= less.constant;
    return difference;
}

} // namespace abacus::exact
