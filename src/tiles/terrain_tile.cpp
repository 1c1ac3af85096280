#include "tiles/terrain_tile.hpp"

#include "draw/frame.hpp"
#include "tiles/tile_samples.hpp"

namespace abacus {

namespace {

constexpr double greatest_steps = 0xffffff;

/// Height in steps of 1/256 above -32768, as red, green and blue; heights beyond are at the end.
std::uint32_t colour_of(double height, std::uint64_t &beyond) {
    const double steps = std::floor((height + 32768) * 256 + 0.5);
    if (steps < 0 || steps > greatest_steps) ++beyond;
    return static_cast<std::uint32_t>(std::clamp(steps, 0.0, greatest_steps));
}

} // namespace

Png terrain_tile(const Host &host, const abacus_facts &facts, const abacus_tile &tile,
                 const abacus_tile_terrain_kind &kind, const abacus_tile_memory &memory,
                 std::uint64_t &beyond) {
    const TileWindow window(tile, facts);
    if (kind.width < 1 || kind.width > max_side || !std::isfinite(kind.fill))
        throw Error(ABACUS_ERROR_ARGUMENT, "size or fill of the tile is out of range");
    const auto width = static_cast<std::uint32_t>(kind.width);
    ValueRaster<2> rows = tile_samples(host, facts, window, window.box(), width,
                                       {kind.attribute, kind.extent}, memory);
    beyond = 0;
    Picture picture(host, kind.width, kind.width, false);
    for (std::int32_t y = 0; y < kind.width; ++y) {
        const double *const values = rows.next();
        for (std::uint32_t x = 0; x < width; ++x)
            picture.row(y)[x] = colour_of(std::isnan(values[x]) ? kind.fill : values[x], beyond);
    }
    return picture.png();
}

} // namespace abacus
