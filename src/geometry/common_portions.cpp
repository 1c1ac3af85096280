#include "geometry/common_portions.hpp"

#include "geometry/distance.hpp"
#include "geometry/polytope.hpp"

#include <algorithm>

namespace abacus::exact {

namespace {

/// Least powers of two: those of the least measures and values of doubles. What is smaller is lost
/// beside anything else.
template <int D> constexpr int least_measure = -1074 * D;
constexpr int least_value = -1074;

template <int D>
Portion<D> portion_of(const std::array<RationalPoint<D>, D + 1> &corner,
                      const LinearFunction<D> &difference) {
    typename LinearSystem<Rational, D>::Matrix edges;
    for (int i = 0; i < D; ++i)
        for (int axis = 0; axis < D; ++axis) edges[i][axis] = corner[i + 1][axis] - corner[0][axis];
    constexpr int simplices_of_a_box = D == 2 ? 2 : 6;
    const ScaledNumber size = scaled(
        Rational(CGAL::abs(LinearSystem<Rational, D>::determinant(edges)) / simplices_of_a_box));
    Portion<D> portion{size.value, {}, std::max(size.exponent, least_measure<D>), least_value};
    portion.measure = std::ldexp(size.value, size.exponent - portion.of_measure);
    std::array<ScaledNumber, D + 1> value;
    for (int i = 0; i <= D; ++i) {
        value[i] = scaled(difference(corner[i]));
        if (value[i].value != 0) portion.of_values = std::max(portion.of_values, value[i].exponent);
    }
    for (int i = 0; i <= D; ++i)
        portion.value[i] = std::ldexp(value[i].value, value[i].exponent - portion.of_values);
    return portion;
}

} // namespace

template <int D>
void each_common_portion(const Piece<D> &first, const Piece<D> &second, const Box<D> &box,
                         const Polygon *polygon,
                         const std::function<void(const Portion<D> &)> &visit) {
    const LinearFunction<D> difference = difference_of<D>(first, second);
    each_common_part<D>(first, second, box, polygon, [&](const Polytope<D> &part) {
        part.each_simplex([&](const std::array<RationalPoint<D>, D + 1> &corner) {
            visit(portion_of<D>(corner, difference));
        });
    });
}

double steepness(const Piece<2> &piece) {
    const LinearFunction<2> function = function_of<2>(piece);
    return length(
        Point<3>{1, nearest_double(function.gradient[0]), nearest_double(function.gradient[1])});
}

template void each_common_portion<2>(const Piece<2> &, const Piece<2> &, const Box<2> &,
                                     const Polygon *,
                                     const std::function<void(const Portion<2> &)> &);
template void each_common_portion<3>(const Piece<3> &, const Piece<3> &, const Box<3> &,
                                     const Polygon *,
                                     const std::function<void(const Portion<3> &)> &);

} // namespace abacus::exact
