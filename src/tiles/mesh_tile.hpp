// A tile of a mesh as terrain of triangles.
#pragma once

#include "draw/picture.hpp"
#include "tiles/tile_window.hpp"

namespace abacus {

/// Throws an Error (argument) if there is no such tile. Without bytes if it has no triangle.
Png mesh_tile(const Host &host, const abacus_facts &facts, const abacus_tile &tile,
              const abacus_tile_mesh_kind &kind, const abacus_tile_memory &memory);

} // namespace abacus
