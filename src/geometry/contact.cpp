// In the plane these are two edges, and orientations decide. In space these are two
// triangles, and the question depends on how many vertices they share. If they share an
// edge, they meet in more if and only if they are coplanar and on the same side of it. If
// they share one vertex, any further common point lies on a ray from that vertex through
// both triangles. The ray leaves one of them first, so the opposite edge of one meets the
// other.
#include "geometry/contact.hpp"

#include "geometry/cgal_points.hpp"
#include "geometry/predicates.hpp"

#include <CGAL/Intersections_3/Segment_3_Triangle_3.h>
#include <CGAL/Intersections_3/Triangle_3_Triangle_3.h>

#include <utility>

namespace abacus {

namespace {

using exact::cgal;
using exact::Kernel;

/// Brings common vertices to the front of both; returns how many there are.
template <int D> int align(Facet<D> &a, Facet<D> &b) {
    int common = 0;
    for (int i = 0; i < D; ++i)
        for (int j = common; j < D; ++j)
            if (*a[i] == *b[j]) {
                std::swap(a[i], a[common]);
                std::swap(b[j], b[common]);
                ++common;
                break;
            }
    return common;
}

/// Whether p, on the line through a and b, lies between them or at one.
bool between(const Point<2> &a, const Point<2> &b, const Point<2> &p) {
    return lexicographically_less<2>(a, b)
               ? !lexicographically_less<2>(p, a) && !lexicographically_less<2>(b, p)
               : !lexicographically_less<2>(p, b) && !lexicographically_less<2>(a, p);
}

} // namespace

bool meet_improperly(Facet<2> a, Facet<2> b) {
    const int common = align<2>(a, b);
    const Point<2> &p = *a[0], &q = *a[1], &r = *b[0], &s = *b[1];
    if (common == 1) // they meet in more than p if and only if both run the same way
        return orientation(p, q, s) == 0 &&
               lexicographically_less<2>(p, q) == lexicographically_less<2>(p, s);
    const int r_side = orientation(p, q, r), s_side = orientation(p, q, s);
    const int p_side = orientation(r, s, p), q_side = orientation(r, s, q);
    if (r_side * s_side < 0 && p_side * q_side < 0) return true;
    return (r_side == 0 && between(p, q, r)) || (s_side == 0 && between(p, q, s)) ||
           (p_side == 0 && between(r, s, p)) || (q_side == 0 && between(r, s, q));
}

bool meet_improperly(Facet<3> a, Facet<3> b) {
    const int common = align<3>(a, b);
    if (common == 2) {
        if (orientation(*a[0], *a[1], *a[2], *b[2]) != 0) return false;
        return Kernel().coplanar_orientation_3_object()(cgal(*a[0]), cgal(*a[1]), cgal(*a[2]),
                                                        cgal(*b[2])) == CGAL::POSITIVE;
    }
    const Kernel::Triangle_3 first(cgal(*a[0]), cgal(*a[1]), cgal(*a[2]));
    const Kernel::Triangle_3 second(cgal(*b[0]), cgal(*b[1]), cgal(*b[2]));
    if (common == 0) return CGAL::do_intersect(first, second);
    return CGAL::do_intersect(first, Kernel::Segment_3(cgal(*b[1]), cgal(*b[2]))) ||
           CGAL::do_intersect(second, Kernel::Segment_3(cgal(*a[1]), cgal(*a[2])));
}

} // namespace abacus
