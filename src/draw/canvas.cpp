#include "draw/canvas.hpp"

#include <algorithm>
#include <cmath>

namespace abacus {

namespace {

// Width of the edges of a large triangle, pixels.
constexpr double full_width = 1.0;
// Radius of the inscribed circle, in pixels, at which the width has halved.
constexpr double half_radius = 2.0;
// Below this radius edges are no longer told apart: their ink is a tone.
constexpr double tone_radius = 0.6;

// A triangle with an inscribed circle of radius r has a perimeter of 2 area / r;
// with half an edge's width on its own side, edges of width w cover w / r of it.
// With this width that is at most full_width / half_radius, for any triangle.
double edge_width(double radius) { return full_width * radius / (radius + half_radius); }

double edge_tone(double radius) { return full_width / (radius + half_radius); }

bool has_value(const TriangleValues &value) {
    return std::isfinite(value[0]) && std::isfinite(value[1]) && std::isfinite(value[2]);
}

double distance(const double (&a)[2], const double (&b)[2]) {
    const double x = a[0] - b[0], y = a[1] - b[1];
    return std::sqrt(x * x + y * y);
}

} // namespace

Canvas::Canvas(const Host &host, const abacus_drawing &drawing, double low, double high)
    : host_(&host), drawing_(Extent(drawing).drawing()), low_(low), high_(high), frame_(drawing_),
      range_(low, high), raster_(host, drawing_.width, drawing_.height), pixels_(host) {
    pixels_.resize(static_cast<std::size_t>(drawing_.width) * drawing_.height);
    std::fill(pixels_.begin(), pixels_.end(), Pixel{});
}

inline void Canvas::deposit(std::int32_t x, std::int32_t y, double covered, double count,
                            double value, double ink) {
    Pixel &pixel = pixels_[static_cast<std::size_t>(y) * drawing_.width + x];
    pixel.covered += static_cast<float>(covered);
    pixel.count += static_cast<float>(count);
    if (value == value) {
        pixel.valued += static_cast<float>(covered);
        pixel.value += static_cast<float>(covered * value);
    }
    pixel.ink += static_cast<float>(ink);
}

void Canvas::triangle(const TriangleCorners &corner, const TriangleValues &value) {
    const TriangleCorners p = {{frame_.x(corner[0][0]), frame_.y(corner[0][1])},
                       {frame_.x(corner[1][0]), frame_.y(corner[1][1])},
                       {frame_.x(corner[2][0]), frame_.y(corner[2][1])}};
    const double left = std::min({p[0][0], p[1][0], p[2][0]});
    const double right = std::max({p[0][0], p[1][0], p[2][0]});
    const double top = std::min({p[0][1], p[1][1], p[2][1]});
    const double bottom = std::max({p[0][1], p[1][1], p[2][1]});
    if (!(right > 0 && left < drawing_.width && bottom > 0 && top < drawing_.height)) return;
    if (is_too_long(drawing_, corner)) return;

    TriangleValues v = {NAN, NAN, NAN};
    if (has_values() && has_value(value))
        for (int i = 0; i < 3; ++i) v[i] = low_ < high_ ? range_(value[i]) : 0.5;
    const double area = 0.5 * std::fabs((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) -
                                        (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]));

    // In huge meshes, most triangles lie within one pixel.
    const double x = std::floor(left), y = std::floor(top);
    if (x >= 0 && y >= 0 && right <= x + 1 && bottom <= y + 1) {
        deposit(static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), area, 1,
                (v[0] + v[1] + v[2]) / 3, drawing_.edges ? area * edge_tone(0) : 0);
        return;
    }
    fill(p, v, area);
}

void Canvas::fill(const TriangleCorners &p, const TriangleValues &value, double area) {
    const double perimeter = distance(p[0], p[1]) + distance(p[1], p[2]) + distance(p[2], p[0]);
    const double radius = 2 * area / perimeter;
    const bool is_outlined = drawing_.edges && radius > tone_radius;
    if (is_outlined) outline(p, edge_width(radius));
    if (!(area > 0)) return;

    const double tone = drawing_.edges && !is_outlined ? edge_tone(radius) : 0;
    // Shares below the resolution of the coverage must not be blown up to a triangle.
    const double density = std::min(1 / area, 1e6);
    // The value is linear over the plane; pixels on the outline, whose centres may
    // lie outside, stay within the values of the corners.
    const double scale = 0.5 / area;
    const double ux = p[1][0] - p[0][0], uy = p[1][1] - p[0][1];
    const double wx = p[2][0] - p[0][0], wy = p[2][1] - p[0][1];
    const double turn = ux * wy - wx * uy > 0 ? scale : -scale;
    const double du = value[1] - value[0], dw = value[2] - value[0];
    const double slope_x = (du * wy - dw * uy) * turn;
    const double slope_y = (dw * ux - du * wx) * turn;
    const double low = std::min({value[0], value[1], value[2]});
    const double high = std::max({value[0], value[1], value[2]});
    raster_.triangle(p, [&](std::int32_t x, std::int32_t y, double covered) {
        const double at = value[0] + slope_x * (x + 0.5 - p[0][0]) + slope_y * (y + 0.5 - p[0][1]);
        // NaN passes both comparisons unchanged.
        const double bounded = at < low ? low : at > high ? high : at;
        deposit(x, y, covered, covered * density, bounded, covered * tone);
    });
}

void Canvas::outline(const TriangleCorners &p, double width) {
    // The neighbour across each edge draws the other half of the line.
    const auto ink = [&](std::int32_t x, std::int32_t y, double covered) {
        pixels_[static_cast<std::size_t>(y) * drawing_.width + x].ink +=
            static_cast<float>(covered * 0.5);
    };
    for (int i = 0, j = 2; i < 3; j = i++) raster_.line(p[j], p[i], width, ink);
}

Png Canvas::png() const { return (drawing_.attribute >= 0 ? terrain() : mesh()).png(); }

} // namespace abacus
