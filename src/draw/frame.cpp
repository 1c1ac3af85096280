#include "draw/frame.hpp"

#include <algorithm>
#include <limits>

namespace abacus {

namespace {

[[noreturn]] void throw_argument(const std::string &message, std::string detail = {},
                                 std::string hint = {}) {
    throw Error(ABACUS_ERROR_ARGUMENT, message, std::move(detail), std::move(hint));
}

void check_side(const char *name, std::int32_t side, std::int32_t least) {
    if (side < least || side > max_side)
        throw_argument("picture " + std::string(name) + " is out of range",
                       "It is " + std::to_string(side) + "; it must be from " +
                           std::to_string(least) + " to " + std::to_string(max_side) + ".");
}

void check_drawing(const abacus_drawing &drawing) {
    check_side("width", drawing.width, 1);
    check_side("height", drawing.height, 0);
    if (std::int64_t{drawing.width} * drawing.height > max_pixels)
        throw_argument("picture is too large",
                       std::to_string(drawing.width) + " by " + std::to_string(drawing.height) +
                           " pixels are more than " + std::to_string(max_pixels) + ".",
                       "Draw the mesh in several windows.");
    for (int axis = 0; axis < 2; ++axis)
        if (!std::isfinite(drawing.lower[axis]) || !std::isfinite(drawing.upper[axis]))
            throw_argument("window of the picture is not finite");
    if (!std::isfinite(drawing.exaggeration)) throw_argument("exaggeration is not finite");
    if (!(drawing.max_edge >= 0)) throw_argument("longest edge is negative or not a number");
}

} // namespace

Extent::Extent(const abacus_drawing &drawing)
    : drawing_(drawing), whole_(shows_whole<2>(drawing)),
      low_(std::numeric_limits<double>::infinity()), high_(-low_) {
    check_drawing(drawing);
    for (int axis = 0; axis < 2; ++axis) {
        lower_[axis] = low_;
        upper_[axis] = high_;
    }
}

void Extent::add(const Patch &patch) {
    double lower[2], upper[2];
    for (int axis = 0; axis < 2; ++axis) {
        lower[axis] = upper[axis] = patch.corner[0][axis];
        for (int i = 1; i < patch.corners; ++i) {
            lower[axis] = std::min(lower[axis], patch.corner[i][axis]);
            upper[axis] = std::max(upper[axis], patch.corner[i][axis]);
        }
        if (!whole_ && !(lower[axis] < drawing_.upper[axis] && upper[axis] > drawing_.lower[axis]))
            return;
    }
    for (int axis = 0; axis < 2; ++axis) {
        lower_[axis] = std::min(lower_[axis], lower[axis]);
        upper_[axis] = std::max(upper_[axis], upper[axis]);
    }
    const double *value = patch.value, *end = value + patch.corners;
    if (!std::all_of(value, end, [](double v) { return std::isfinite(v); })) return;
    low_ = std::min(low_, *std::min_element(value, end));
    high_ = std::max(high_, *std::max_element(value, end));
}

abacus_drawing Extent::drawing() const {
    abacus_drawing result = drawing_;
    for (int axis = 0; whole_ && axis < 2; ++axis) {
        const bool any = lower_[axis] < upper_[axis];
        result.lower[axis] = any ? lower_[axis] : 0;
        result.upper[axis] = any ? upper_[axis] : 1;
    }
    if (result.height == 0) {
        const double shape = (result.upper[1] * 0.5 - result.lower[1] * 0.5) /
                             (result.upper[0] * 0.5 - result.lower[0] * 0.5);
        const auto most =
            static_cast<double>(std::min<std::int64_t>(max_side, max_pixels / result.width));
        const double height = std::floor(result.width * shape + 0.5);
        // A window of the least double is nothing when halved, and has no shape.
        result.height = static_cast<std::int32_t>(height >= 1 ? std::min(height, most) : 1);
    }
    return result;
}

Scale::Scale(double low, double high) : origin_(low * 0.5), factor_(1 / (high * 0.5 - origin_)) {
    // Extents below the normal range of doubles: a point, as far as a picture goes.
    if (!std::isfinite(factor_)) factor_ = 0;
}

Frame::Frame(const abacus_drawing &drawing)
    : width_(drawing.width), height_(drawing.height), x_(drawing.lower[0], drawing.upper[0]),
      y_(drawing.lower[1], drawing.upper[1]) {}

} // namespace abacus
