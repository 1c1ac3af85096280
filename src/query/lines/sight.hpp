// Whether one place is seen from another over a terrain: a mesh in the plane with a height at every
// vertex.
//
// Over a triangle both the terrain and the line of sight are linear. So the terrain rises above the
// line somewhere only if it does where the line crosses an edge or a vertex, or at its ends. There
// the heights are compared: in doubles with a bound on the error, and in rational numbers where
// that does not decide. An end that stands on the terrain has the terrain's height there exactly.
// So a line of sight that touches the terrain, or runs in it, is distinguished from a blocked one.
#pragma once

#include "query/lines/line_scan.hpp"

#include <abacus/lines.h>

namespace abacus {

/// Ground without a finite height blocks nothing, and neither do triangles outside of the
/// extent.
abacus_sight look(Reader<2> &reader, std::uint32_t attribute, const abacus_sight_end &observer,
                  const abacus_sight_end &target, const abacus_extent &extent = {});

} // namespace abacus
