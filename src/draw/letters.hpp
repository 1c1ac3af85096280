// Letters for a few words in a picture: strokes, so that no font need be installed, and a picture
// is the same wherever it is drawn.
#pragma once

#include <string_view>

typedef struct _cairo cairo_t;

namespace abacus {

/// How wide a text is where capitals are so high; it is in UTF-8.
double text_width(std::string_view text, double height);
// Widths of strokes, in heights of a capital; that of a halo around them.
inline constexpr double stroke_width = 0.15, halo_width = 0.5;

/// Draws a text with its baseline there, from x on, in the colour that is set. What it has no
/// letter for becomes a box.
void draw_text(cairo_t *pen, double x, double baseline, std::string_view text, double height,
               double width = stroke_width);

} // namespace abacus
