#include "tiles/mesh_tile.hpp"

#include "tiles/glb.hpp"
#include "tiles/quantized_mesh.hpp"

namespace abacus {

namespace {

/// The tile of a square map in the mesh's coordinates. That of degrees is twice as wide as high: it
/// is the lower half of a square, whose tiles of the next zoom it has.
abacus_tile in_square(const abacus_facts &facts, const abacus_tile &tile,
                      const abacus_tile_mesh_kind &kind) {
    const bool has_degrees = kind.plane == ABACUS_TILE_DEGREES;
    if (has_degrees) require_globe(facts);
    require_tile(tile, most_zoom - has_degrees, has_degrees);
    abacus_tile square = tile;
    square.is_geographic = 0;
    const std::int32_t rows = std::int32_t{1} << tile.zoom;
    if (kind.from_south != 0) square.y = rows - 1 - tile.y;
    if (has_degrees) {
        ++square.zoom;
        square.y += rows;
        square.lower[0] = -180;
        square.lower[1] = -90;
        square.side = 360;
    }
    return square;
}

} // namespace

Png mesh_tile(const Host &host, const abacus_facts &facts, const abacus_tile &tile,
              const abacus_tile_mesh_kind &kind, const abacus_tile_memory &memory) {
    const TileWindow window(in_square(facts, tile, kind), facts);
    const TileFrame frame(kind.plane);
    const Arena<SurfaceCorner> corners =
        tile_surface(host, facts, window.box(), frame, kind.attribute, memory);
    const auto write = kind.format == ABACUS_TILE_GLB ? glb : quantized_mesh;
    return write(host, corners, window.box(), frame);
}

} // namespace abacus
