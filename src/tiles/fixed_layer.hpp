// The layer `fixed` of a vector tile that tells its lines apart.
#pragma once

#include "draw/picture.hpp"
#include "tiles/tile_window.hpp"

#include <span>

namespace abacus {

/// A feature for each line and kind. Edges end at the border of the extent's polygon.
Png fixed_layer(const Host &host, const abacus_facts &facts, const abacus_tile &tile,
                const abacus_extent &extent, std::span<const abacus_tile_edge> edges);

} // namespace abacus
