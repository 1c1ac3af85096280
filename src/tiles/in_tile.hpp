// What vector tiles are made with: places in units of the tile, and bytes.
#pragma once

#include "draw/picture.hpp"
#include "tiles/tile_window.hpp"
#include "tiles/vector_layer.hpp"

namespace abacus {

/// A place of the mesh in units of the tile.
inline Point<2> in_tile(const TileWindow &window, const Point<2> &p) {
    const Point<2> in_plane = window.plane().project(p);
    const double units = tile_extent / window.side();
    return {(in_plane[0] - window.box().lower[0]) * units,
            (window.box().upper[1] - in_plane[1]) * units};
}

inline Png as_png(const Host &host, const TileBuffer &bytes) {
    Png result(host);
    if (!bytes.empty())
        result.append(reinterpret_cast<const unsigned char *>(bytes.data()), bytes.size());
    return result;
}

} // namespace abacus
