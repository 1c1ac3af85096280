// A picture of what is streamed: once, or twice when the window or the range of values must be
// found first.
#pragma once

#include "draw/canvas.hpp"

namespace abacus {

struct Portrait {
    Png png;
    bool is_blank; // nothing is seen
};

/// The same drawing of a wider window: with the margin of its canvas, in pixels.
abacus_drawing widened(const abacus_drawing &drawing, std::int32_t margin);

/// `stream(picture)` adds all patches to a picture, an Extent or a Canvas; `unit` is the unit of
/// coordinates in the picture. Throws an Error (argument) if there is no such attribute.
template <class Stream>
Portrait draw_patches(const Host &host, const abacus_facts &facts, const abacus_drawing &drawing,
                      std::int32_t margin, abacus_ramp usual, double unit, Stream stream) {
    if (drawing.attribute >=
        static_cast<std::int32_t>(facts.columns.attributes + facts.columns.labels))
        throw Error(ABACUS_ERROR_ARGUMENT, "there is no such attribute");
    Extent extent(drawing);
    if (Extent::is_needed(drawing)) stream(extent);
    Canvas canvas(host, extent.drawing(), extent.low(), extent.high(), margin);
    stream(canvas);
    return {canvas.png(Palette::of(drawing.ramp, usual), unit), canvas.is_blank()};
}

} // namespace abacus
