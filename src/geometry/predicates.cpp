// The exact ends of the predicates, on CGAL's filtered kernel (LGPL): interval
// arithmetic first, then exact numbers.
#include "geometry/predicates.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace abacus::exact {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_2 cgal(const Point<2> &p) { return {p[0], p[1]}; }
Kernel::Point_3 cgal(const Point<3> &p) { return {p[0], p[1], p[2]}; }

template <int D> int unperturbed_in_sphere(const Corners<D> &c, const Point<D> &p) {
    if constexpr (D == 2)
        return Kernel().side_of_oriented_circle_2_object()(cgal(*c[0]), cgal(*c[1]), cgal(*c[2]),
                                                           cgal(p));
    else
        return Kernel().side_of_oriented_sphere_3_object()(cgal(*c[0]), cgal(*c[1]), cgal(*c[2]),
                                                           cgal(*c[3]), cgal(p));
}

} // namespace

int orientation(const Point<2> &a, const Point<2> &b, const Point<2> &c) {
    return Kernel().orientation_2_object()(cgal(a), cgal(b), cgal(c));
}

int orientation(const Point<3> &a, const Point<3> &b, const Point<3> &c, const Point<3> &d) {
    return Kernel().orientation_3_object()(cgal(a), cgal(b), cgal(c), cgal(d));
}

template <int D> int in_sphere(const Corners<D> &corners, const Point<D> &p) {
    const int side = unperturbed_in_sphere<D>(corners, p);
    if (side != 0) return side;
    for (const Point<D> *corner : corners)
        if (*corner == p) return 0;

    // On the sphere. The lifted points move up by infinitesimals, the
    // lexicographically largest by the largest; the sign is that of the first
    // coefficient, in this order, that is not zero: for p itself that of the
    // positive simplex, negated; for a corner that of the simplex with p in its place.
    std::array<int, D + 2> order; // index of a corner; D + 1 stands for p
    for (int i = 0; i < D + 2; ++i) order[i] = i;
    const auto point = [&](int i) -> const Point<D> & { return i <= D ? *corners[i] : p; };
    std::sort(order.begin(), order.end(),
              [&](int i, int j) { return lexicographically_less<D>(point(j), point(i)); });
    for (const int i : order) {
        if (i == D + 1) return -1;
        Corners<D> replaced = corners;
        replaced[i] = &p;
        if (const int sign = abacus::orientation<D>(replaced)) return sign;
    }
    return -1; // not reached: p itself is in the order
}

int in_hull_facet(const Corners<3> &corners, const Point<3> &p) {
    const auto coplanar_orientation = [](const Corners<3> &c) {
        return static_cast<int>(
            Kernel().coplanar_orientation_3_object()(cgal(*c[0]), cgal(*c[1]), cgal(*c[2])));
    };
    const int side = Kernel().coplanar_side_of_bounded_circle_3_object()(
        cgal(*corners[0]), cgal(*corners[1]), cgal(*corners[2]), cgal(p));
    if (side != 0) return side;
    for (int i = 0; i < 3; ++i)
        if (*corners[i] == p) return 0;

    // On the circle: as in in_sphere(), with areas in the plane for volumes. Their sign
    // depends on the side from which the plane is seen, hence the product.
    const int facing = coplanar_orientation(corners);
    std::array<int, 4> order{0, 1, 2, 3}; // 3 stands for p
    const auto point = [&](int i) -> const Point<3> & { return i < 3 ? *corners[i] : p; };
    std::sort(order.begin(), order.end(),
              [&](int i, int j) { return lexicographically_less<3>(point(j), point(i)); });
    for (const int i : order) {
        if (i == 3) return -1;
        Corners<3> replaced = corners;
        replaced[i] = &p;
        if (const int sign = coplanar_orientation(replaced)) return sign * facing;
    }
    return -1; // not reached: p itself is in the order
}

template int in_sphere<2>(const Corners<2> &, const Point<2> &);
template int in_sphere<3>(const Corners<3> &, const Point<3> &);

} // namespace abacus::exact
