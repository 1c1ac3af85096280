// What is drawn over a mesh on request: the regions of its triangles as tints, each in a colour of
// its own with its border, and fixed edges.
//
// As on the canvas, each pixel keeps sums, so the order of drawing does not matter. A fixed edge is
// drawn from either side, half of it each, and shows in full if only one side is drawn.
#pragma once

#include "draw/palette.hpp"
#include "draw/raster.hpp"

namespace abacus {

class Overlay {
public:
    /// In pixels, a margin included.
    Overlay(const Host &host, const abacus_drawing &drawing, std::int32_t width,
            std::int32_t height);

    bool is_needed() const { return has_regions() || has_lines(); }
    /// A part of a pixel is in a region; 0: in none.
    void tint(std::size_t at, std::uint32_t region, double covered);
    /// The fixed edges of a patch, in pixels.
    void edges(const Patch &patch, const Raster &raster);
    /// Leaves only so much of a pixel.
    void leave(std::size_t at, float share);
    /// The colour of a pixel of which so much is covered.
    Color over(const Color &below, std::size_t at, float covered) const;

private:
    struct Tint {
        Color color;  // sum over the shares in regions
        float share;  // ... of the pixel
        float border; // share under their edges
    };

    bool has_regions() const { return !tints_.empty(); }
    bool has_lines() const { return !lines_.empty(); }

    const std::size_t width_;
    Arena<Tint> tints_;  // empty unless wanted
    Arena<float> lines_; // shares under fixed edges; the same
};

} // namespace abacus
