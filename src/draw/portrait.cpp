#include "draw/portrait.hpp"

#include <limits>

namespace abacus {

abacus_drawing widened(const abacus_drawing &drawing, std::int32_t margin) {
    abacus_drawing wider = Extent(drawing).drawing(); // with its height
    const double sizes[2] = {wider.width + 0.0, wider.height + 0.0};
    constexpr double most = std::numeric_limits<double>::max();
    for (int axis = 0; axis < 2; ++axis) {
        const double pixel =
            (wider.upper[axis] / sizes[axis] - wider.lower[axis] / sizes[axis]) * margin;
        wider.lower[axis] = std::max(wider.lower[axis] - pixel, -most);
        wider.upper[axis] = std::min(wider.upper[axis] + pixel, most);
    }
    return wider;
}

} // namespace abacus
