// The parts that two simplices have in common, with the difference of their linear functions:
// exact, and each number is rounded once. For simplices so flat that doubles would not do.
#pragma once

#include "geometry/box.hpp"
#include "geometry/linear_piece.hpp"
#include "geometry/polygon.hpp"
#include "geometry/portion.hpp"

#include <functional>

namespace abacus::exact {

/// Calls visit(portion) for portions that make up what is in both simplices, in a box, and in the
/// plane in a polygon, which may be null. The values are those of the first function less those of
/// the second.
template <int D>
void each_common_portion(const Piece<D> &first, const Piece<D> &second, const Box<D> &box,
                         const Polygon *polygon,
                         const std::function<void(const Portion<D> &)> &visit);
/// How many times larger a surface is than the triangle below it.
double steepness(const Piece<2> &piece);

extern template void each_common_portion<2>(const Piece<2> &, const Piece<2> &, const Box<2> &,
                                            const Polygon *,
                                            const std::function<void(const Portion<2> &)> &);
extern template void each_common_portion<3>(const Piece<3> &, const Piece<3> &, const Box<3> &,
                                            const Polygon *,
                                            const std::function<void(const Portion<3> &)> &);

} // namespace abacus::exact
