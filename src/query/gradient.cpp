#include "query/gradient.hpp"

#include "geometry/linear_system.hpp"

#include <algorithm>

namespace abacus {

template <int D> Point<D> gradient_in(const abacus_simplex &simplex, const double *values) {
    return solve<D>([&]<class T>() {
        LinearSystem<T, D> system;
        for (int i = 0; i < D; ++i) {
            for (int axis = 0; axis < D; ++axis)
                system.matrix[i][axis] =
                    T(simplex.corner[i + 1][axis]) - T(simplex.corner[0][axis]);
            system.right[i] = T(values[i + 1]) - T(values[0]);
        }
        return system;
    });
}

template <int D>
bool gradient_at(Reader<D> &reader, const abacus_interpolation &what, const Point<D> &p,
                 double *gradient) {
    abacus_simplex simplex;
    CornerValues carried(what.attribute, 1);
    if (!reader.locate(p, simplex, &carried, what.max_edge)) return false;
    std::array<double, D + 1> values;
    bool is_finite = true;
    for (int i = 0; i <= D; ++i) {
        values[i] = carried.value(i, 0);
        is_finite = is_finite && std::isfinite(values[i]);
    }
    Point<D> result;
    result.fill(NAN);
    if (is_finite) result = gradient_in<D>(simplex, values.data());
    std::copy(result.begin(), result.end(), gradient);
    return true;
}

template Point<2> gradient_in<2>(const abacus_simplex &, const double *);
template Point<3> gradient_in<3>(const abacus_simplex &, const double *);
template bool gradient_at<2>(Reader<2> &, const abacus_interpolation &, const Point<2> &, double *);
template bool gradient_at<3>(Reader<3> &, const abacus_interpolation &, const Point<3> &, double *);

} // namespace abacus
