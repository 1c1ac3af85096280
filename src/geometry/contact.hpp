// Whether two facets of a boundary meet as the facets of a complex may: in a common face,
// a vertex, an edge, or not at all. Exact.
#pragma once

#include "geometry/point.hpp"

#include <array>

namespace abacus {

/// The D vertices of a facet.
template <int D> using Facet = std::array<const Point<D> *, D>;

/// Whether the facets, neither flat and not both of the same vertices, have a point in
/// common that is in no common face. Equal vertices are known by their coordinates.
bool meet_improperly(Facet<2> a, Facet<2> b);
bool meet_improperly(Facet<3> a, Facet<3> b);

} // namespace abacus
