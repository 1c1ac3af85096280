// Questions whose answers need empty circumspheres.
#pragma once

#include "query/locate/reader.hpp"

#include <string>

namespace abacus {

inline constexpr char fixed_edges[] = "The mesh has lines, whose edges are fixed.";

/// Throws if the mesh is not Delaunay. `needs`: the beginning of the message; `hint`: what to do if
/// the mesh was loaded.
template <int D>
void require_delaunay(const Reader<D> &reader, const std::string &needs, const std::string &hint) {
    if (reader.is_delaunay()) return;
    if (reader.is_convex())
        throw Error(ABACUS_ERROR_STATE, needs + " a Delaunay mesh", fixed_edges,
                    "Use a mesh of the same points without lines.");
    throw Error(ABACUS_ERROR_STATE, needs + " a Delaunay mesh", {}, hint);
}

} // namespace abacus
