#include "tiles/tile_window.hpp"

namespace abacus {

void require_globe(const abacus_facts &facts) {
    if (facts.form.has_domain != 0 && (facts.form.lower[1] > 90 || facts.form.upper[1] < -90))
        MapPlane(true).project({facts.form.lower[0], facts.form.lower[1]});
}

void require_tile(const abacus_tile &tile, std::int32_t finest, int doublings) {
    if (tile.zoom < 0 || tile.zoom > finest)
        throw Error(ABACUS_ERROR_ARGUMENT, "zoom of the tile is out of range",
                    "It is " + std::to_string(tile.zoom) + "; it must be from 0 to " +
                        std::to_string(finest) + ".");
    const std::int64_t rows = std::int64_t{1} << tile.zoom, columns = rows << doublings;
    if (tile.x >= 0 && tile.x < columns && tile.y >= 0 && tile.y < rows) return;
    const std::string range = doublings == 0 ? "x and y are from 0 to " + std::to_string(rows - 1)
                                             : "x is from 0 to " + std::to_string(columns - 1) +
                                                   " and y from 0 to " + std::to_string(rows - 1);
    throw Error(ABACUS_ERROR_ARGUMENT, "there is no such tile",
                "Tile " + std::to_string(tile.zoom) + "/" + std::to_string(tile.x) + "/" +
                    std::to_string(tile.y) + " does not exist: at this zoom " + range + ".");
}

TileWindow::TileWindow(const abacus_tile &tile, const abacus_facts &facts)
    : plane_(tile.is_geographic != 0) {
    if (tile.is_geographic != 0) require_globe(facts);
    require_tile(tile, most_zoom, 0);
    const std::int64_t tiles = std::int64_t{1} << tile.zoom;
    const double lower[2] = {tile.is_geographic != 0 ? -180 : tile.lower[0],
                             tile.is_geographic != 0 ? -180 : tile.lower[1]};
    const double side = tile.is_geographic != 0 ? 360 : tile.side;
    if (!(side > 0 && std::isfinite(lower[0] + side) && std::isfinite(lower[1] + side)))
        throw Error(ABACUS_ERROR_ARGUMENT, "the map of the world has no area, or is not finite");
    // Sides shared by tiles are exactly the same numbers.
    const auto place = [&](int axis, std::int64_t n) {
        return lower[axis] + side * (static_cast<double>(n) / static_cast<double>(tiles));
    };
    box_ = {{place(0, tile.x), place(1, tiles - tile.y - 1)},
            {place(0, tile.x + 1), place(1, tiles - tile.y)}};
    side_ = side / static_cast<double>(tiles);
}

Box<2> TileWindow::wider(double margin) const {
    Box<2> box = box_;
    for (int axis = 0; axis < 2; ++axis) {
        box.lower[axis] -= margin * side_;
        box.upper[axis] += margin * side_;
    }
    return box;
}

double TileWindow::mean_triangles(const abacus_facts &facts, double side) const {
    if (facts.form.has_domain == 0) return 0;
    double area = 1;
    for (int axis = 0; axis < 2; ++axis) {
        double lower = facts.form.lower[axis], upper = facts.form.upper[axis];
        if (axis == 1 && plane_.is_geographic()) {
            lower = MapPlane::mercator(lower);
            upper = MapPlane::mercator(upper);
        }
        area *= std::fmax(upper - lower, 1e-300) / side;
    }
    return static_cast<double>(facts.census.simplices) / area;
}

} // namespace abacus
