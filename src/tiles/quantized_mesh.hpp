// A surface as a tile of quantized-mesh 1.0, with normals.
//
// Places are 0 to 32767 from west to east and from south to north, in longitude and latitude; so
// readers place them. Heights are 0 to 32767 from the least to the greatest of the tile. Only what
// lies on a border exactly is at 0 or 32767 of its axis, so borders of neighbours have the same
// places along them.
#pragma once

#include "draw/picture.hpp"
#include "tiles/tile_surface.hpp"

namespace abacus {

/// Without bytes if there is no corner.
Png quantized_mesh(const Host &host, const Arena<SurfaceCorner> &corners, const Box<2> &box,
                   const TileFrame &frame);

} // namespace abacus
