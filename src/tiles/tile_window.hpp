// Where a tile is in the plane of the map, and how fine the mesh is there.
#pragma once

#include "geometry/map_plane.hpp"
#include "keys/domain_of.hpp"

#include <abacus/tile.h>

namespace abacus {

inline constexpr std::int32_t most_zoom = 30;

/// Throws an Error (argument) if no place of the mesh can be on the globe.
void require_globe(const abacus_facts &facts);
/// Throws an Error (argument) if there is no such tile. The map is 2^doublings as wide as it is
/// high.
void require_tile(const abacus_tile &tile, std::int32_t finest, int doublings);

class TileWindow {
public:
    /// Throws an Error (argument) if there is no such tile, or no place of the mesh can be on the
    /// map.
    TileWindow(const abacus_tile &tile, const abacus_facts &facts);

    const MapPlane &plane() const { return plane_; }
    const Box<2> &box() const { return box_; }
    double side() const { return side_; }
    /// With a margin of so many sides.
    Box<2> wider(double margin) const;
    /// The least that a mesh's coordinates have in it, and the most.
    Box<2> in_mesh(double margin) const { return plane_.unproject(wider(margin)); }

    /// How many triangles of the mesh a square of this side has as a mean, anywhere in its domain:
    /// the same for all tiles of a zoom.
    double mean_triangles(const abacus_facts &facts, double side) const;

private:
    MapPlane plane_;
    Box<2> box_;
    double side_;
};

} // namespace abacus
