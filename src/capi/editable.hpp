// Which meshes can be changed.
#pragma once

#include "host/host.hpp"

#include <abacus/facts.h>

namespace abacus {

/// Throws an Error (state) for a mesh that is not Delaunay: insertion and deletion rely on
/// empty circumspheres and a convex hull.
inline void require_editable(const abacus_facts &facts) {
    if (abacus_is_editable(facts.standing)) return;
    const auto delaunay = static_cast<abacus_delaunay>(facts.standing);
    throw Error(ABACUS_ERROR_STATE, abacus_delaunay_clause(delaunay),
                std::string(abacus_delaunay_reason(delaunay)) +
                    " The mesh was loaded by abacus_load() and cannot have other points.",
                "Triangulate its vertices anew, by abacus_load() with retriangulate => true or by "
                "abacus_triangulate().");
}

} // namespace abacus
