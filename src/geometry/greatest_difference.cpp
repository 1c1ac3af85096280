#include "geometry/greatest_difference.hpp"

#include "geometry/linear_system.hpp"
#include "geometry/misfit.hpp"
#include "geometry/rational.hpp"

#include <cmath>
#include <vector>

namespace abacus {

namespace {

using exact::Rational;

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
    bool cut(const Box<D> &box) {
        for (int axis = 0; axis < D; ++axis)
            for (const bool is_lower : {true, false}) {
                const double bound = is_lower ? box.lower[axis] : box.upper[axis];
                if (std::isfinite(bound) && !cut(side_of<D>(axis, bound, is_lower))) return false;
            }
        return true;
    }
    template <class Visit> void each_corner(Visit visit) const {
        for (const Corner &corner : corners_) visit(corner.at);
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
    Corner between(std::size_t i, std::size_t j, const Rational &share, std::uint32_t bit) const {
        const Corner &a = corners_[i], &b = corners_[j];
        Corner corner{a.at, (a.facets & b.facets) | bit};
        for (int axis = 0; axis < D; ++axis) corner.at[axis] += share * (b.at[axis] - a.at[axis]);
        return corner;
    }

    std::vector<Corner> corners_;
    unsigned facets_; ///< of all cuts; there are at most 14
};

// ---- Bounds in doubles -------------------------------------------------------------------

/// |a - b|, rounded up.
double most_between(double a, double b) {
    const double difference = a - b, rest = a - difference;
    const double rounded = (a - (difference + rest)) + (rest - b); // Knuth's TwoSum
    return rounded == 0
               ? std::fabs(difference)
               : std::nextafter(std::fabs(difference), std::numeric_limits<double>::infinity());
}

template <int D> double most_by_range(const Piece<D> &first, const Piece<D> &second) {
    const auto [low, high] = std::minmax_element(first.value.begin(), first.value.end());
    const auto [least, most] = std::minmax_element(second.value.begin(), second.value.end());
    return std::max(most_between(*high, *least), most_between(*low, *most));
}

/// Of the function of one, continued, and that of another one at its corners.
template <int D> double most_at_corners(const Piece<D> &continued, const Piece<D> &piece) {
    const Misfit<D> misfit(continued);
    double most = 0;
    for (int i = 0; i <= D; ++i) {
        const Point<D> &p = piece.corner[i];
        const auto *same = std::find(continued.corner.begin(), continued.corner.end(), p);
        most = std::max(most, same != continued.corner.end()
                                  ? most_between(continued.value[same - continued.corner.begin()],
                                                 piece.value[i])
                                  : misfit.most(misfit.of(p, piece.value[i])));
    }
    return most;
}

} // namespace

// ---- The greatest so far -----------------------------------------------------------------

template <int D> struct GreatestDifference<D>::State {
    /// Whether a pair may have a greater difference, or as great a one at a place before.
    bool may_matter(const Piece<D> &first, const Piece<D> &second) const {
        if (!is_any) return true;
        double most = most_by_range<D>(first, second);
        if (!(most < known)) most = std::min(most, most_at_corners<D>(first, second));
        if (!(most < known)) most = std::min(most, most_at_corners<D>(second, first));
        if (most != known) return !(most < known);
        return size == Rational(known) && may_be_before(first, second);
    }
    void look_at(const RationalPoint<D> &at, const Rational &difference) {
        const Rational absolute = CGAL::abs(difference);
        if (is_any && absolute < size) return;
        if (is_any && absolute == size && (place < at || (place == at && !(difference > greatest))))
            return;
        is_any = true;
        greatest = difference;
        size = absolute;
        place = at;
        known = exact::nearest_double(size);
        if (!std::isfinite(known) || Rational(known) > size) known = std::nextafter(known, 0);
    }

    bool is_any = false;
    Rational greatest, size; ///< the latter without sign
    RationalPoint<D> place;
    double known = 0; ///< the greatest double that is not greater than `size`

private:
    bool may_be_before(const Piece<D> &first, const Piece<D> &second) const {
        Box<D> box, other;
        for (const Point<D> &p : first.corner) box.extend(p);
        for (const Point<D> &p : second.corner) other.extend(p);
        for (int axis = 0; axis < D; ++axis) {
            const Rational least(std::max(box.lower[axis], other.lower[axis]));
            if (least != place[axis]) return least < place[axis];
        }
        return true;
    }
};

template <int D> GreatestDifference<D>::GreatestDifference() : state_(std::make_unique<State>()) {}
template <int D> GreatestDifference<D>::~GreatestDifference() = default;

template <int D>
void GreatestDifference<D>::add(const Piece<D> &first, const Piece<D> &second, const Box<D> &box,
                                const Polygon *polygon) {
    Box<D> around;
    for (const Point<D> &p : first.corner) around.extend(p);
    if (!around.meets(box) || !state_->may_matter(first, second)) return;
    Polytope<D> common(first);
    const bool is_inside = box.contains(around.lower) && box.contains(around.upper);
    if (!common.cut(second) || (!is_inside && !common.cut(box))) return;
    LinearFunction<D> difference = function_of<D>(first);
    const LinearFunction<D> less = function_of<D>(second);
    for (int axis = 0; axis < D; ++axis) difference.gradient[axis] -= less.gradient[axis];
    difference.constant -= less.constant;
    const auto look = [&](const RationalPoint<D> &at) { state_->look_at(at, difference(at)); };
    if constexpr (D == 2)
        if (polygon != nullptr)
            return polygon->each_part(around, [&](const Polygon::Trapezoid &part) {
                Polytope<2> in_part = common;
                LinearFunction<2> below = side_of<2>(std::array{part.lower[0], part.lower[1]}),
                                  above = side_of<2>(std::array{part.upper[0], part.upper[1]});
                above.negate();
                if (in_part.cut(side_of<2>(0, part.left, true)) &&
                    in_part.cut(side_of<2>(0, part.right, false)) && in_part.cut(below) &&
                    in_part.cut(above))
                    in_part.each_corner(look);
            });
    common.each_corner(look);
}

template <int D> bool GreatestDifference<D>::is_any() const { return state_->is_any; }

template <int D> typename GreatestDifference<D>::Result GreatestDifference<D>::result() const {
    Result result{exact::nearest_double(state_->greatest), {}};
    for (int axis = 0; axis < D; ++axis)
        result.place[axis] = exact::nearest_double(state_->place[axis]);
    return result;
}

template class GreatestDifference<2>;
template class GreatestDifference<3>;

} // namespace abacus
