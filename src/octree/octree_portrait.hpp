// Draws a stored octree: its leaves as boxes, each with one value, or what a plane cuts of them. Of
// a window, or of a plane, only pages that have something to show are read, and a few on the way.
#pragma once

#include "draw/portrait.hpp"

#include <abacus/draw.h>

namespace abacus {

/// The picture of a quadtree as a PNG. Throws an Error (argument) if the drawing makes no sense for
/// it. Contours have no meaning for values that are the same all over a leaf: there are none.
Portrait draw_octree(const Host &host, const abacus_facts &facts, const abacus_drawing &drawing);

/// The same of a plane section of an octree.
Portrait draw_octree_section(const Host &host, const abacus_facts &facts,
                             const abacus_section &section, const abacus_drawing &drawing);

} // namespace abacus
