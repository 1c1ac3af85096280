// An attribute at points of a tile, evenly spaced on the map.
#pragma once

#include "query/places/value_raster.hpp"
#include "tiles/tile_window.hpp"

namespace abacus {

struct SampledValue {
    std::uint32_t attribute;
    abacus_extent extent;
};

/// Row by row, `width` a row and as many rows, at the centres of the pixels of `box`.
inline ValueRaster<2> tile_samples(const Host &host, const abacus_facts &facts,
                                   const TileWindow &window, const Box<2> &box, std::uint32_t width,
                                   const SampledValue &value, const abacus_tile_memory &memory) {
    abacus_raster raster{};
    for (int axis = 0; axis < 2; ++axis) {
        raster.lower[axis] = box.lower[axis];
        raster.upper[axis] = box.upper[axis];
    }
    raster.width = raster.height = width;
    raster.is_geographic = window.plane().is_geographic();
    abacus_interpolation how{};
    how.attributes = 1;
    how.attribute[0] = value.attribute;
    how.extent = value.extent;
    return {host, facts, raster, how, memory.sort, memory.cache};
}

} // namespace abacus
