// Integer points that lie exactly on one circle or sphere about the origin: rounding does not
// decide which points are cospherical, and every in-sphere test among them is 0.
#pragma once

#include "coordinates.hpp"
#include "random.hpp"

namespace abacus::oracle {

/// At most `size` distinct points (2D: at most 524,288), in random order.
template <int D> Points<D> exact_sphere(std::size_t size, Random &random);

} // namespace abacus::oracle
