// Selects the simplices of a mesh that an outline goes around.
#pragma once

#include "geometry/ball.hpp"
#include "geometry/circumradius.hpp"
#include "mesh/cache.hpp"

#include <optional>

namespace abacus {

struct Kept {
    /// Simplices with a longer edge are left out, unless it is 0.
    double max_edge = 0;
    /// Simplices whose circumradius has a greater square are left out.
    std::optional<double> alpha;

    bool is_all() const { return max_edge == 0 && !alpha; }
};

template <int D> bool is_kept(const Kept &kept, const Cache<D> &cache, Handle h) {
    const Simplex<D> &s = cache.simplex(h);
    if (s.is_ghost()) return false;
    if (kept.is_all()) return true;
    const Corners<D> corners = cache.corners(s);
    for (int i = 0; kept.max_edge > 0 && i <= D; ++i)
        for (int j = 0; j < i; ++j)
            if (!is_within<D>(kept.max_edge, *corners[i], *corners[j])) return false;
    return !kept.alpha || has_circumsphere_within<D>(corners, *kept.alpha);
}

} // namespace abacus
