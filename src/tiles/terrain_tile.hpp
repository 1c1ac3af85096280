// A tile of a mesh as heights: a picture whose colours are numbers.
#pragma once

#include "draw/picture.hpp"
#include "tiles/tile_window.hpp"

namespace abacus {

/// Throws an Error (argument) if there is no such tile. `beyond`: how many heights, of all pixels,
/// the encoding does not hold; they are its least or its greatest.
Png terrain_tile(const Host &host, const abacus_facts &facts, const abacus_tile &tile,
                 const abacus_tile_terrain_kind &kind, const abacus_tile_memory &memory,
                 std::uint64_t &beyond);

} // namespace abacus
