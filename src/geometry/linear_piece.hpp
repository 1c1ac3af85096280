// A simplex with a linear function.
#pragma once

#include "geometry/point.hpp"

namespace abacus {

/// A simplex, and a function that is linear in it by its values at the corners.
template <int D> struct Piece {
    std::array<Point<D>, D + 1> corner;
    std::array<double, D + 1> value;
};

} // namespace abacus
