#include "quake.hpp"

#include "quake/quake_points.hpp"

#include <cstdint>
#include <memory>

namespace abacus::oracle {
namespace {

/// At most `limit` points of a set.
Points<3> points_of(int hundredths, std::size_t limit) {
    const auto generator = std::make_unique<QuakePoints>(hundredths / 100.0); // half a megabyte
    Points<3> points;
    QuakePoint point;
    while (points.size() < limit && generator->next(point))
        points.push_back({point.x, point.y, point.z});
    return points;
}

} // namespace

Points<3> quake(std::size_t size) {
    const auto count = [&](int hundredths) { return points_of(hundredths, 2 * size).size(); };
    // Sets grow with the frequency: `below` stays too small, `above` large enough.
    int below = 0, above = 1;
    while (count(above) < size) {
        below = above;
        above *= 2;
    }
    while (above - below > 1) {
        const int middle = (below + above) / 2;
        (count(middle) < size ? below : above) = middle;
    }
    const bool nearer_below = below > 0 && size - count(below) < count(above) - size;
    return points_of(nearer_below ? below : above, SIZE_MAX);
}

} // namespace abacus::oracle
