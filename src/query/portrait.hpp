// Draws a stored mesh: streams its pages to the canvas, twice when the window or the
// range of values must be found first. Pages outside the window are skipped by their
// boxes.
#pragma once

#include "cache/page_format.hpp"
#include "draw/canvas.hpp"

namespace abacus {

/// The picture as a PNG. Throws an Error (argument) if the drawing makes no sense for
/// the mesh, whose dimension is 2.
Png draw_mesh(const Host &host, const abacus_header &header, const abacus_drawing &drawing);

} // namespace abacus
