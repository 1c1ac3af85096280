// Draws a stored mesh: streams its pages to the canvas, twice when the window or the
// range of values must be found first. For a window or a plane, only the pages that have something
// to show are read (range_scan.hpp).
#pragma once

#include "draw/portrait.hpp"
#include "mesh/page_format.hpp"

#include <abacus/draw.h>

namespace abacus {

/// The picture of a mesh of dimension 2 as a PNG. Throws an Error (argument) if the
/// drawing makes no sense for the mesh.
Portrait draw_mesh(const Host &host, const abacus_facts &facts, const abacus_drawing &drawing);

/// Adds the fixed edges and the borders of regions in the window of a drawing to its canvas, if it
/// wants them; what they go through is there.
void draw_fixed_edges(const Host &host, const abacus_facts &facts, const abacus_drawing &drawing,
                      Canvas &canvas);

/// Leaves only what is in the polygon of the drawing's extent, if it has one.
void leave_polygon(const abacus_drawing &drawing, Canvas &canvas);

/// The picture of a plane section of a mesh of dimension 3.
Portrait draw_section(const Host &host, const abacus_facts &facts, const abacus_section &section,
                      const abacus_drawing &drawing);

} // namespace abacus
