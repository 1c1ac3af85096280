#include "draw/frame.hpp"

#include "geometry/simplex_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace abacus {

namespace {

// The limits, in widths, of a height that follows from the window's shape. Beyond them a picture is
// a line, or takes many times the memory that its width suggests.
constexpr double flattest = 1.0 / 8;
constexpr std::int64_t tallest = 8;

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

} // namespace

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
    if (!std::isfinite(drawing.range[0]) || !std::isfinite(drawing.range[1]))
        throw_argument("range of the colours is not finite");
    if (!std::isfinite(drawing.exaggeration)) throw_argument("exaggeration is not finite");
    if (!(std::isfinite(drawing.light[0]) && drawing.light[1] >= 0 && drawing.light[1] <= 90))
        throw_argument("light is not above the horizon",
                       "It has a direction in degrees from north, and an altitude in degrees above "
                       "the horizon.",
                       "Give an altitude above 0 and at most 90.");
    if (!(std::isfinite(drawing.contour_interval) && drawing.contour_interval >= 0))
        throw_argument("interval of the contours is negative or not finite");
    if (!(drawing.extent.max_edge >= 0)) throw_argument("longest edge is negative or not a number");
}

std::int32_t height_of_shape(std::int32_t width, double shape) {
    const auto most = static_cast<double>(
        std::min({std::int64_t{max_side}, max_pixels / width, width * tallest}));
    const double least = std::max(1.0, std::floor(width * flattest));
    const double height = std::floor(width * shape + 0.5);
    // If there is no shape, the height is NaN.
    return static_cast<std::int32_t>(height >= least ? std::min(height, most) : least);
}

Extent::Extent(const abacus_drawing &drawing)
    : drawing_(drawing), whole_(shows_whole<2>(drawing)),
      low_(std::numeric_limits<double>::infinity()), high_(-low_) {
    check_drawing(drawing);
    if (!has_range(drawing) || drawing.attribute < 0) return;
    low_ = drawing.range[0];
    high_ = drawing.range[1];
}

/// Whether a patch covers a part of the window, or may do so because it is flat.
static bool is_seen(const Patch &patch, const Box<2> &around, const Box<2> &window) {
    bool is_within = true;
    for (int axis = 0; axis < 2; ++axis) {
        if (!(around.lower[axis] < window.upper[axis] && window.lower[axis] < around.upper[axis]))
            return false;
        is_within = is_within && window.lower[axis] <= around.lower[axis] &&
                    around.upper[axis] <= window.upper[axis];
    }
    if (is_within) return true;
    Point<2> corners[Patch::most];
    for (int i = 0; i < patch.corners; ++i) corners[i] = {patch.corner[i][0], patch.corner[i][1]};
    return !is_kept_apart(corners, patch.corners, window, false);
}

void Extent::add(const Patch &patch) {
    Box<2> around;
    for (int i = 0; i < patch.corners; ++i)
        around.extend(Point<2>{patch.corner[i][0], patch.corner[i][1]});
    if (!whole_ &&
        !is_seen(patch, around,
                 {{drawing_.lower[0], drawing_.lower[1]}, {drawing_.upper[0], drawing_.upper[1]}}))
        return;
    around_.extend(around);
    if (has_range(drawing_)) return;
    const double *value = patch.value, *end = value + patch.corners;
    if (!std::all_of(value, end, [](double v) { return std::isfinite(v); })) return;
    low_ = std::min(low_, *std::min_element(value, end));
    high_ = std::max(high_, *std::max_element(value, end));
}

abacus_drawing Extent::drawing() const {
    abacus_drawing result = drawing_;
    for (int axis = 0; whole_ && axis < 2; ++axis) {
        const bool any = around_.lower[axis] < around_.upper[axis];
        result.lower[axis] = any ? around_.lower[axis] : 0;
        result.upper[axis] = any ? around_.upper[axis] : 1;
    }
    if (result.height == 0) {
        const double shape = (result.upper[1] * 0.5 - result.lower[1] * 0.5) /
                             (result.upper[0] * 0.5 - result.lower[0] * 0.5);
        // Half of the least double is 0, so such a window has no shape.
        result.height = height_of_shape(result.width, shape);
    }
    return result;
}

Scale::Scale(double low, double high) : origin_(low * 0.5), factor_(1 / (high * 0.5 - origin_)) {
    // An extent below the normal range of doubles counts as a point.
    if (!std::isfinite(factor_)) factor_ = 0;
}

Frame::Frame(const abacus_drawing &drawing, std::int32_t margin)
    : width_(drawing.width), height_(drawing.height), margin_(margin),
      x_(drawing.lower[0], drawing.upper[0]), y_(drawing.lower[1], drawing.upper[1]) {}

} // namespace abacus
