#include "geometry/distance.hpp"

#include "geometry/cgal_points.hpp"

namespace abacus::exact {

template <int D> int compare_distance(const Point<D> &p, const Point<D> &a, const Point<D> &b) {
    if constexpr (D == 2)
        return Kernel().compare_distance_2_object()(cgal(p), cgal(a), cgal(b));
    else
        return Kernel().compare_distance_3_object()(cgal(p), cgal(a), cgal(b));
}

template int compare_distance<2>(const Point<2> &, const Point<2> &, const Point<2> &);
template int compare_distance<3>(const Point<3> &, const Point<3> &, const Point<3> &);

} // namespace abacus::exact
