#include "geometry/crossing.hpp"

#include "geometry/rational.hpp"

namespace abacus {

CrossingPlace crossing_place(const Point<2> &a, const Point<2> &b, const Point<2> &c,
                             const Point<2> &d) {
    using exact::Rational;
    const auto difference = [](const Point<2> &to, const Point<2> &from, int axis) {
        return Rational(to[axis]) - Rational(from[axis]);
    };
    const Rational ux = difference(b, a, 0), uy = difference(b, a, 1);
    const Rational vx = difference(d, c, 0), vy = difference(d, c, 1);
    const Rational along =
        (difference(c, a, 0) * vy - difference(c, a, 1) * vx) / (ux * vy - uy * vx);
    const Rational exactly[2] = {Rational(a[0]) + along * ux, Rational(a[1]) + along * uy};
    CrossingPlace crossing{{}, true};
    for (int axis = 0; axis < 2; ++axis) {
        crossing.place[axis] = exact::nearest_double(exactly[axis]) + 0.0; // -0.0 is +0.0
        crossing.is_exact = crossing.is_exact && Rational(crossing.place[axis]) == exactly[axis];
    }
    return crossing;
}

} // namespace abacus
