// A simplex of the zone of a place: those whose circumsphere contains it, as when it is inserted.
#pragma once

#include "mesh/simplex.hpp"

#include <array>
#include <cstdint>

namespace abacus {

template <int D> struct ZoneSimplex {
    /// Beyond a facet on the rim of the zone, or a fixed one.
    static constexpr std::uint32_t not_seen = 0xffffffffu;

    std::array<VertexIndex, D + 1> vertex;
    std::array<std::uint32_t, D + 1> beyond; ///< numbers of simplices of the zone
};

} // namespace abacus
