// If the corners do not decide, the facets do. The point of a facet nearest to the centre is a
// corner, lies within an edge, or, in space, within the facet itself. Which case it is, and the
// distance, are computed in rational numbers without any division.
#include "geometry/ball.hpp"

#include <CGAL/Exact_rational.h>

namespace abacus::exact {

namespace {

using Rational = CGAL::Exact_rational;
template <int D> using Vector = std::array<Rational, D>;

template <int D> Vector<D> between(const Point<D> &from, const Point<D> &to) {
    Vector<D> v;
    for (int i = 0; i < D; ++i) v[i] = Rational(to[i]) - Rational(from[i]);
    return v;
}

template <int D> Rational dot(const Vector<D> &a, const Vector<D> &b) {
    Rational sum = 0;
    for (int i = 0; i < D; ++i) sum += a[i] * b[i];
    return sum;
}

Vector<3> cross(const Vector<3> &a, const Vector<3> &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Whether the ball meets the triangle in a point that is nearest to its centre and on no edge.
bool meets_inside(const std::array<const Point<3> *, 3> &facet, const Ball<3> &ball) {
    const Vector<3> normal =
        cross(between<3>(*facet[0], *facet[1]), between<3>(*facet[0], *facet[2]));
    for (int i = 0; i < 3; ++i) {
        const Point<3> &from = *facet[i], &to = *facet[(i + 1) % 3];
        if (dot<3>(normal, cross(between<3>(from, to), between<3>(from, ball.center))) <= 0)
            return false;
    }
    const Rational height = dot<3>(normal, between<3>(*facet[0], ball.center));
    const Rational radius = ball.radius;
    return height * height <= radius * radius * dot<3>(normal, normal);
}

} // namespace

template <int D> int side(const Ball<D> &ball, const Point<D> &p) {
    const Vector<D> to_p = between<D>(ball.center, p);
    const Rational radius = ball.radius, square = dot<D>(to_p, to_p), most = radius * radius;
    return square < most ? -1 : square > most;
}

template <int D> bool meets_edge(const Point<D> &a, const Point<D> &b, const Ball<D> &ball) {
    const Vector<D> edge = between<D>(a, b), to_center = between<D>(a, ball.center);
    const Rational along = dot<D>(edge, to_center), length = dot<D>(edge, edge);
    if (along <= 0 || along >= length) return false;
    const Rational radius = ball.radius;
    return dot<D>(to_center, to_center) * length - along * along <= radius * radius * length;
}

template <int D> bool meets_facet(const Corners<D> &corners, const Ball<D> &ball) {
    for (int i = 0; i <= D; ++i)
        for (int j = 0; j < i; ++j)
            if (meets_edge<D>(*corners[i], *corners[j], ball)) return true;
    if constexpr (D == 3)
        for (int i = 0; i < 4; ++i)
            if (meets_inside({corners[(i + 1) % 4], corners[(i + 2) % 4], corners[(i + 3) % 4]},
                             ball))
                return true;
    return false;
}

template int side<2>(const Ball<2> &, const Point<2> &);
template int side<3>(const Ball<3> &, const Point<3> &);
template bool meets_edge<2>(const Point<2> &, const Point<2> &, const Ball<2> &);
template bool meets_edge<3>(const Point<3> &, const Point<3> &, const Ball<3> &);
template bool meets_facet<2>(const Corners<2> &, const Ball<2> &);
template bool meets_facet<3>(const Corners<3> &, const Ball<3> &);

} // namespace abacus::exact
