// What a walk needs: simplices that know their neighbours, and points that know where they
// are. The cache is such a topology, and so is, in tests, a triangulation of CGAL.
//
// A reference to a simplex or point is good until the next cross(), which may load pages.
#pragma once

#include "geometry/point.hpp"
#include "mesh/simplex.hpp"

#include <concepts>

namespace abacus {

template <class Mesh, int D>
concept Topology = requires(Mesh &mesh, const Mesh &still, Handle h, int facet, VertexIndex v) {
    { still.simplex(h) } -> std::convertible_to<const Simplex<D> &>;
    { still.point(v) } -> std::convertible_to<const Point<D> &>;
    /// The neighbour's side of a facet.
    { mesh.cross(h, facet) } -> std::same_as<Link>;
    /// Serves an interrupt, if there is one.
    mesh.poll();
};

} // namespace abacus
