// A tile of a mesh as a picture.
//
// Where the mesh is so fine that a pixel has several triangles, drawing all of them would take as
// long as the mesh is large. So then each pixel shows the triangle at its centre alone: the centres
// are sorted along the curve, and only the pages that have one are read. Which of the two is done
// depends on the mesh and the zoom. So tiles side by side fit.
#pragma once

#include "query/pictures/portrait.hpp"

#include <abacus/tile.h>

namespace abacus {

/// Throws an Error (argument) if there is no such tile, or it cannot be drawn.
Portrait draw_picture_tile(const Host &host, const abacus_facts &facts, const abacus_tile &tile,
                           const abacus_drawing &drawing, const abacus_tile_memory &memory);

} // namespace abacus
