// Triangles whose corners are numbered vertices, in an order that depends on these alone.
#pragma once

#include "tiles/tile_surface.hpp"

namespace abacus {

/// Where a corner is in the file: corners at one place are one vertex.
using PlaceInFile = std::array<double, 3>;

struct WeldedSurface {
    Arena<PlaceInFile> vertices; // in the order in which the triangles name them
    Arena<Point<3>> normals;     // of length 1, or 0
    Arena<std::array<std::uint32_t, 3>> triangles;
};

/// Triangles two of whose corners are one vertex vanish. So no other triangle loses its neighbour.
WeldedSurface weld(const Host &host, const Arena<SurfaceCorner> &corners,
                   const Arena<PlaceInFile> &places);

} // namespace abacus
