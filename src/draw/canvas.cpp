#include "draw/canvas.hpp"

#include <algorithm>
#include <cmath>

namespace abacus {

namespace {

// Width of the edges of a large patch, pixels.
constexpr double full_width = 1.0;
// Radius of the inscribed circle, in pixels, at which the width has halved.
constexpr double half_radius = 2.0;
// Below this radius edges are no longer told apart: their ink is a tone.
constexpr double tone_radius = 0.6;

// A triangle with an inscribed circle of radius r has a perimeter of 2 area / r, and
// by that ratio r is defined for other patches; with half an edge's width on its own
// side, edges of width w cover w / r of it. With this width that is at most
// full_width / half_radius, for any patch.
double edge_width(double radius) { return full_width * radius / (radius + half_radius); }

double edge_tone(double radius) { return full_width / (radius + half_radius); }

double distance(const double (&a)[2], const double (&b)[2]) {
    const double x = a[0] - b[0], y = a[1] - b[1];
    return std::sqrt(x * x + y * y);
}

double perimeter(const Patch &p) {
    double sum = 0;
    for (int i = 0, j = p.corners - 1; i < p.corners; j = i++)
        sum += distance(p.corner[j], p.corner[i]);
    return sum;
}

double area_of(const Patch &p) {
    return 0.5 * (std::fabs(p.turn(0, 1, 2)) + (p.corners == 4 ? std::fabs(p.turn(0, 2, 3)) : 0));
}

/// The value of a patch as a function of the position.
class Ramp {
public:
    explicit Ramp(const Patch &p) : start_{p.corner[0][0], p.corner[0][1]}, at_start_(p.value[0]) {
        // Three corners tell all of it; of a quadrilateral the larger half tells it
        // best.
        const bool second =
            p.corners == 4 && std::fabs(p.turn(0, 2, 3)) > std::fabs(p.turn(0, 1, 2));
        const int b = second ? 2 : 1, c = b + 1;
        const double scale = 1 / p.turn(0, b, c);
        const double ux = p.corner[b][0] - start_[0], uy = p.corner[b][1] - start_[1];
        const double wx = p.corner[c][0] - start_[0], wy = p.corner[c][1] - start_[1];
        const double du = p.value[b] - at_start_, dw = p.value[c] - at_start_;
        slope_[0] = (du * wy - dw * uy) * scale;
        slope_[1] = (dw * ux - du * wx) * scale;
        low_ = *std::min_element(p.value, p.value + p.corners);
        high_ = *std::max_element(p.value, p.value + p.corners);
    }
    /// Pixels on the outline, whose centres may lie outside, stay within the values of
    /// the corners.
    double operator()(double x, double y) const {
        const double at = at_start_ + slope_[0] * (x - start_[0]) + slope_[1] * (y - start_[1]);
        // NaN passes both comparisons unchanged.
        return at < low_ ? low_ : at > high_ ? high_ : at;
    }

private:
    double start_[2], at_start_, slope_[2], low_, high_;
};

/// A value far beyond the range stays far, but differences and products stay finite.
double bounded(double value) { return std::fmin(std::fmax(value, -1e30), 1e30); }

// Shares below the resolution of the coverage must not be blown up to a patch.
constexpr double most_density = 1e6;

} // namespace

Canvas::Canvas(const Host &host, const abacus_drawing &drawing, double low, double high)
    : host_(&host), drawing_(Extent(drawing).drawing()), low_(low), high_(high), frame_(drawing_),
      range_(low, high), raster_(host, drawing_.width, drawing_.height), pixels_(host) {
    // Row by row, since memory for all of a large picture takes most of a second.
    pixels_.reserve(static_cast<std::size_t>(drawing_.width) * drawing_.height);
    for (std::int32_t y = 0; y < drawing_.height; ++y) {
        host_->poll();
        std::fill_n(pixels_.extend(drawing_.width), drawing_.width, Pixel{});
    }
}

inline void Canvas::deposit(std::int32_t x, std::int32_t y, double covered, double count,
                            double value, double ink) {
    Pixel &pixel = pixels_[static_cast<std::size_t>(y) * drawing_.width + x];
    value = std::clamp(value, 0.0, 1.0); // NaN stays
    pixel.covered += static_cast<float>(covered);
    pixel.count += static_cast<float>(count);
    if (value == value) {
        pixel.valued += static_cast<float>(covered);
        pixel.value += static_cast<float>(covered * value);
    }
    pixel.ink += static_cast<float>(ink);
}

void Canvas::add(const Patch &patch) {
    host_->poll(); // a page may have patches that cover the picture many times over by their edges
    Patch p = patch;
    double left = 1e30, right = -1e30, top = 1e30, bottom = -1e30;
    bool has_value = has_values();
    for (int i = 0; i < p.corners; ++i) {
        const double x = p.corner[i][0] = frame_.x(patch.corner[i][0]);
        const double y = p.corner[i][1] = frame_.y(patch.corner[i][1]);
        left = std::min(left, x);
        right = std::max(right, x);
        top = std::min(top, y);
        bottom = std::max(bottom, y);
        has_value = has_value && std::isfinite(patch.value[i]);
    }
    if (!(right > 0 && left < drawing_.width && bottom > 0 && top < drawing_.height)) return;

    double mean = 0;
    for (int i = 0; i < p.corners; ++i) {
        p.value[i] = !has_value ? NAN : low_ < high_ ? bounded(range_(patch.value[i])) : 0.5;
        mean += p.value[i] / p.corners;
    }
    const double area = area_of(p);
    // In huge meshes, most patches lie within one pixel.
    const double x = std::floor(left), y = std::floor(top);
    if (x >= 0 && y >= 0 && right <= x + 1 && bottom <= y + 1) {
        const double count = p.spacing > 0 ? area * density(p.spacing) : 1;
        deposit(static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), area, count, mean,
                drawing_.edges ? area * edge_tone(0) : 0);
        return;
    }
    fill(p, area, p.spacing > 0 ? density(p.spacing) : std::min(1 / area, most_density));
}

double Canvas::density(double spacing) const {
    // Two triangles a vertex.
    const double x = spacing * frame_.pixels_per_unit(0), y = spacing * frame_.pixels_per_unit(1);
    const double density = 2 / (x * y);
    return density < most_density ? density : most_density; // also where there is no number
}

void Canvas::fill(const Patch &patch, double area, double density) {
    const double radius = 2 * area / perimeter(patch);
    const bool is_outlined = drawing_.edges && radius > tone_radius;
    if (is_outlined) outline(patch, edge_width(radius));
    if (!(area > 0)) return;

    const double tone = drawing_.edges && !is_outlined ? edge_tone(radius) : 0;
    const Ramp value(patch);
    raster_.fill(patch, [&](std::int32_t x, std::int32_t y, double covered) {
        deposit(x, y, covered, covered * density, value(x + 0.5, y + 0.5), covered * tone);
    });
}

void Canvas::outline(const Patch &p, double width) {
    // The neighbour across each edge draws the other half of the line.
    const auto ink = [&](std::int32_t x, std::int32_t y, double covered) {
        pixels_[static_cast<std::size_t>(y) * drawing_.width + x].ink +=
            static_cast<float>(covered * 0.5);
    };
    for (int i = 0, j = p.corners - 1; i < p.corners; j = i++)
        raster_.line(p.corner[j], p.corner[i], width, ink);
}

bool Canvas::is_blank() const {
    return std::none_of(pixels_.begin(), pixels_.end(),
                        [](const Pixel &p) { return p.covered > 0; });
}

Png Canvas::png(const Palette &palette) const {
    return (drawing_.attribute >= 0 ? values(palette) : mesh()).png();
}

} // namespace abacus
