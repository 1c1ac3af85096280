#pragma once

#include <array>
#include <vector>

namespace abacus::oracle {

template <int D> using Coordinates = std::array<double, D>;
template <int D> using Points = std::vector<Coordinates<D>>;

} // namespace abacus::oracle
