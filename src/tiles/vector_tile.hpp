// A tile of a mesh as a Mapbox vector tile.
//
// A tile with few triangles has all of them: layers of triangles, of vertices, of contours through
// these triangles, of fixed edges, and of the edges of the hull. A tile with many would be too
// large, and would take as long as the mesh is large. It has contours between samples of a grid,
// which tiles share at their seams, and the hull; it reads the pages that have a sample. If the
// mesh has lines, all pages of the tile are read for its fixed edges.
#pragma once

#include "draw/picture.hpp"
#include "tiles/tile_lines.hpp"
#include "tiles/tile_window.hpp"

namespace abacus {

/// What a tile may have, in bytes, and in triangles with all of their corners.
inline constexpr std::size_t most_tile_bytes = 500000;
inline constexpr std::size_t most_tile_triangles = 4096;

/// The share of a side that is kept around a tile.
inline constexpr double vector_margin = double{tile_buffer} / tile_extent;

struct VectorTile {
    Png bytes; // a tile's, not a PNG's
    bool has_triangles;
};

/// Throws an Error (argument) if there is no such tile.
VectorTile vector_tile(const Host &host, const abacus_facts &facts, const abacus_tile &tile,
                       const abacus_tile_vector_kind &kind, const abacus_tile_words &words,
                       const abacus_tile_memory &memory);

} // namespace abacus
