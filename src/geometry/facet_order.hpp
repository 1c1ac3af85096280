// The corners of a simplex's facets in a fixed order: with the corner opposite behind them the
// order is even. So of a positively oriented simplex a facet's corners, and behind them a point on
// the side where the simplex is, are positively oriented.
#pragma once

#include <array>

namespace abacus {

template <int D> inline constexpr std::array<std::array<int, D>, D + 1> facet_order{};
template <>
inline constexpr std::array<std::array<int, 2>, 3> facet_order<2>{{{1, 2}, {2, 0}, {0, 1}}};
template <>
inline constexpr std::array<std::array<int, 3>, 4> facet_order<3>{
    {{1, 3, 2}, {0, 2, 3}, {1, 0, 3}, {0, 1, 2}}};

} // namespace abacus
