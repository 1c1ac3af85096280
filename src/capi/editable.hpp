// Which meshes can be changed.
#pragma once

#include "host/host.hpp"

#include <abacus/header.h>

namespace abacus {

/// Throws an Error (state) for a mesh that is not Delaunay: insertion and deletion rely on
/// empty circumspheres and a convex hull.
inline void require_editable(const abacus_header &header) {
    if (header.not_delaunay == 0) return;
    throw Error(ABACUS_ERROR_STATE, "the mesh is not a Delaunay triangulation",
                "It was loaded by abacus_load() and can be read, not changed.",
                "Triangulate its vertices anew, or load a changed triangulation under another "
                "name.");
}

} // namespace abacus
