// A surface as a file of glTF 2.0: metres to the east, to the north and up from the centre of a
// tile, which the file names.
#pragma once

#include "draw/picture.hpp"
#include "tiles/tile_surface.hpp"

namespace abacus {

/// Without bytes if there is no triangle.
Png glb(const Host &host, const Arena<SurfaceCorner> &corners, const Box<2> &box,
        const TileFrame &frame);

} // namespace abacus
