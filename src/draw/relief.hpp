// Hill shading of a picture's heights, under a light from one side.
//
// A triangulated surface is flat within each triangle, so shading its true
// slopes shows facets instead of hills where triangles are larger than pixels.
// The heights are therefore smoothed, for the shading only, by about the local
// spacing of the vertices: nothing where triangles are smaller than a pixel,
// more where they are large. The filter is a recursive one run along rows and
// columns in both directions (the domain transform of Gastal and Oliveira,
// 2011): its cost does not depend on the radius, its strength may differ from
// pixel to pixel, and it stops at holes.
#pragma once

#include "draw/frame.hpp"
#include "draw/palette.hpp"
#include "host/arena.hpp"

namespace abacus {

class Relief {
public:
    /// `heights` are NaN where there is none; `spacings` are the distances between vertices, in
    /// pixels. One row of `width` after the other, top row first. `rise` turns a difference of
    /// neighbouring pixels' heights into a slope, along x and y. `light`: as that of a drawing.
    Relief(const Host &host, std::int32_t width, Arena<double> heights, Arena<float> spacings,
           const double (&rise)[2], const double (&light)[2]);

    /// Pixels from which on others do not change the light of one visibly.
    static constexpr std::int32_t reach = 96;

    /// Light that falls on a pixel; flat ground gives white.
    Color light(std::int32_t x, std::int32_t y) const;

private:
    std::size_t index(std::int32_t x, std::int32_t y) const {
        return static_cast<std::size_t>(y) * width_ + x;
    }
    void smooth();
    template <class Number, class Weight> void run(Arena<Number> &field, Weight &&weight);
    /// Between the pixels before and after one, which are `step` away.
    float slope(std::size_t at, std::ptrdiff_t step, bool before, bool after, double rise) const;

    const Host *host_;
    std::int32_t width_, height_;
    double rise_x_, rise_y_;
    float sun_east_, sun_north_, sun_up_;
    Arena<double> heights_;
    Arena<float> spacings_;
};

} // namespace abacus
