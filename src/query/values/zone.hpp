// The zone of a place: the simplices whose circumsphere contains it, as when it is inserted.
#pragma once

#include "mesh/cache.hpp"

#include <array>
#include <cstdint>

namespace abacus {

template <int D> struct ZoneSimplex {
    /// Beyond a facet on the rim of the zone, or a fixed one.
    static constexpr std::uint32_t not_seen = 0xffffffffu;

    std::array<VertexIndex, D + 1> vertex;
    std::array<std::uint32_t, D + 1> beyond; ///< numbers of simplices of the zone
};

/// Whether p, which the simplex contains or has in its circumsphere, is on a facet's line.
template <int D> bool is_on_facet(const Cache<D> &cache, Handle h, int facet, const Point<D> &p) {
    Corners<D> corners = cache.corners(cache.simplex(h));
    corners[facet] = &p;
    return orientation<D>(corners) == 0;
}

template <int D> double dot(const Point<D> &a, const Point<D> &b) {
    double sum = 0;
    for (int i = 0; i < D; ++i) sum += a[i] * b[i];
    return sum;
}
template <int D> Point<D> minus(Point<D> a, const Point<D> &b) {
    for (int i = 0; i < D; ++i) a[i] -= b[i];
    return a;
}

} // namespace abacus
