// Draws what is inside a stored mesh: streams its pages to the canvas of rays, twice when the room
// that the mesh takes in the picture must be found first.
#pragma once

#include "query/pictures/portrait.hpp"

#include <abacus/raycast.h>

namespace abacus {

/// The picture of a mesh of dimension 3. Throws an Error (argument) if the camera or the drawing
/// makes no sense for the mesh.
Portrait draw_rays(const Host &host, const abacus_facts &facts, const abacus_camera &camera,
                   const abacus_drawing &drawing);

} // namespace abacus
