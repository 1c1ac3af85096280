// The surface of a mesh in a tile, as triangles.
//
// A tile with few triangles has all of them, cut at its borders. A tile with many has a grid of
// samples instead. Tiles of both kinds fit, since what lies on a border depends on the border
// alone: all that the mesh has there or, if that is much, samples. A tile with a border of samples
// is a grid itself; other borders of a grid are joined to it by strips.
#pragma once

#include "tiles/tile_cut.hpp"
#include "tiles/tile_frame.hpp"
#include "tiles/tile_window.hpp"

#include "host/arena.hpp"

namespace abacus {

/// So many triangles of the mesh, and pieces of a border, a tile takes. Readers count vertices in
/// 16 bits, with two more for each edge on the border.
inline constexpr std::size_t most_surface_triangles = 16384, most_border_pieces = 1000;
static_assert(3 * most_surface_triangles + 4 * 2 * most_border_pieces + 2 * 4 * most_border_pieces <
              65536);

struct SurfaceCorner {
    Point<2> at; // in the mesh
    double height;
    Point<3> normal; // in the frame, of any length
    std::uint8_t borders;
};

/// Formats of terrain have 32-bit floats.
[[noreturn]] void throw_beyond_floats(const SurfaceCorner &corner);

/// Three corners a triangle, counterclockwise as seen from above, in no particular order.
Arena<SurfaceCorner> tile_surface(const Host &host, const abacus_facts &facts, const Box<2> &box,
                                  const TileFrame &frame, std::uint32_t attribute,
                                  const abacus_tile_memory &memory);

} // namespace abacus
