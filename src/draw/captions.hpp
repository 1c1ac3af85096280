// What tells a picture's scale: the values of its colours, a length.
#pragma once

#include "draw/palette.hpp"
#include "draw/picture.hpp"
#include "geometry/box.hpp"

#include <string>

namespace abacus {

/// Sizes grow with the picture, so that a caption remains readable.
double caption_scale(std::int32_t width, std::int32_t height);
/// The least number of 1, 2 or 5 times a power of ten that is not below x, which is positive.
double round_step(double x);
/// A multiple of such a step, with no more digits than it needs.
std::string number_text(double value, double step);

/// What a legend takes of a picture of this size, in pixels.
Box<2> legend_box(std::int32_t width, std::int32_t height, double low, double high,
                  const char *title);
/// What a scale bar takes at most, whatever its length.
Box<2> scale_bar_box(std::int32_t width, std::int32_t height, const char *unit);
/// Adds the colours from the one of `low` to the one of `high`, with values beside them and a title
/// above them, at the lower right.
void add_legend(Picture &picture, const Palette &palette, double low, double high,
                const char *title);
/// Adds a length of so many pixels a unit, at the lower left.
void add_scale_bar(Picture &picture, double pixels_per_unit, const char *unit);

} // namespace abacus
