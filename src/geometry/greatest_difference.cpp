#include "geometry/greatest_difference.hpp"

#include "geometry/misfit.hpp"
#include "geometry/polytope.hpp"

#include <cmath>
#include <optional>

namespace abacus {

namespace {

using exact::Rational;
using exact::RationalPoint;

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
    if (!state_->may_matter(first, second)) return;
    std::optional<exact::LinearFunction<D>> difference;
    exact::each_common_part<D>(first, second, box, polygon, [&](const exact::Polytope<D> &part) {
        if (!difference) difference = exact::difference_of<D>(first, second);
        part.each_corner(
            [&](const RationalPoint<D> &at) { state_->look_at(at, (*difference)(at)); });
    });
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
