// Selects the simplices of a mesh that an outline goes around.
#pragma once

#include "geometry/circumradius.hpp"
#include "query/pages/extent.hpp"

#include <optional>

namespace abacus {

struct Kept {
    /// Others are left out.
    abacus_extent extent{};
    /// Simplices whose circumradius has a greater square are left out.
    std::optional<double> alpha;

    bool is_all() const { return abacus::is_all(extent) && !alpha; }
};

template <int D> bool is_kept(const Kept &kept, const Cache<D> &cache, Handle h) {
    const Simplex<D> &s = cache.simplex(h);
    if (s.is_ghost()) return false;
    if (kept.is_all()) return true;
    const Corners<D> corners = cache.corners(s);
    if (!is_in<D>(kept.extent, cache.region(h), corners)) return false;
    return !kept.alpha || has_circumsphere_within<D>(corners, *kept.alpha);
}

} // namespace abacus
