// Draws a stored mesh: streams its pages to the canvas, twice when the window or the
// range of values must be found first. Pages outside the window, or that the plane does
// not meet, are skipped by their boxes.
#pragma once

#include "draw/canvas.hpp"
#include "mesh/page_format.hpp"

#include <abacus/draw.h>

namespace abacus {

/// The picture of a mesh of dimension 2 as a PNG. Throws an Error (argument) if the
/// drawing makes no sense for the mesh.
Png draw_mesh(const Host &host, const abacus_header &header, const abacus_drawing &drawing);

/// The same of a plane section of a mesh of dimension 3.
Png draw_section(const Host &host, const abacus_header &header, const abacus_section &section,
                 const abacus_drawing &drawing);

} // namespace abacus
