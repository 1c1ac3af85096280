#include "draw/canvas.hpp"

#include "draw/captions.hpp"
#include "draw/relief.hpp"

#include <algorithm>
#include <cmath>

namespace abacus {

namespace {

// Width of the edges of a large patch, pixels.
constexpr double full_width = 1.0;
// Radius of the inscribed circle, in pixels, at which the width has halved.
constexpr double half_radius = 2.0;
// Below this radius edges are not drawn one by one: their ink is a tone.
constexpr double tone_radius = 0.6;
// Width of contours, pixels, and of each fifth where these have values; and the most contours of a
// range: more could not be distinguished.
constexpr double contour_width = 1.0, index_width = 1.75;
constexpr int index_every = 5;
constexpr int most_contours = 1000;

// A triangle with an inscribed circle of radius r has a perimeter of 2 area / r. For other patches
// this ratio defines r. A patch has half the width of its edges on its own side, so edges of width
// w cover w / r of it. With this width that is at most full_width / half_radius for any patch.
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
    double twice = 0;
    for (int i = 2; i < p.corners; ++i) twice += std::fabs(p.turn(0, i - 1, i));
    return 0.5 * twice;
}

/// The values at a patch's corners as a function of the position.
class Ramp {
public:
    Ramp(const Patch &p, const double (&value)[Patch::most])
        : start_{p.corner[0][0], p.corner[0][1]}, at_start_(value[0]) {
        // Three corners determine it; those of the largest triangle do so best.
        int c = 2;
        for (int i = 3; i < p.corners; ++i)
            if (std::fabs(p.turn(0, i - 1, i)) > std::fabs(p.turn(0, c - 1, c))) c = i;
        const int b = c - 1;
        const double scale = 1 / p.turn(0, b, c);
        const double ux = p.corner[b][0] - start_[0], uy = p.corner[b][1] - start_[1];
        const double wx = p.corner[c][0] - start_[0], wy = p.corner[c][1] - start_[1];
        const double du = value[b] - at_start_, dw = value[c] - at_start_;
        slope_[0] = (du * wy - dw * uy) * scale;
        slope_[1] = (dw * ux - du * wx) * scale;
        low_ = *std::min_element(value, value + p.corners);
        high_ = *std::max_element(value, value + p.corners);
    }
    /// The centres of pixels on the outline may lie outside. Their values stay within those of the
    /// corners.
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

/// The same for a height, which has no range.
double bounded_height(double value) { return std::fmin(std::fmax(value, -1e270), 1e270); }

// Shares below the resolution of the coverage must not be inflated to a patch.
constexpr double most_density = 1e6;

} // namespace

std::int32_t Canvas::margin_of(const abacus_drawing &drawing) {
    return is_shaded(drawing) ? Relief::reach : 2; // half of a line, and its inaccuracy
}

Canvas::Canvas(const Host &host, const abacus_drawing &drawing, double low, double high,
               std::int32_t margin)
    : host_(&host), drawing_(Extent(drawing).drawing()), low_(low), high_(high), margin_(margin),
      width_(drawing_.width + 2 * margin), height_(drawing_.height + 2 * margin),
      frame_(drawing_, margin), range_(low, high), raster_(host, width_, height_),
      overlay_(host, drawing_, width_, height_), pixels_(host),
      labels_(host, width_, height_, margin, drawing_.contour_interval), path_(host),
      contours_(host), heights_(host) {
    const bool has_contours = drawing_.contour_interval > 0 && has_values();
    if (has_contours && !((high / 2 - low / 2) / drawing_.contour_interval < most_contours / 2))
        throw Error(ABACUS_ERROR_ARGUMENT, "contours are too close to one another",
                    "More than " + std::to_string(most_contours) + " lie within the range.",
                    "Give a greater interval, or a narrower range.");
    if (has_contours && drawing_.contour_labels != 0) {
        if (has_legend())
            labels_.keep_free(
                legend_box(drawing_.width, drawing_.height, low_, high_, drawing_.legend));
        if (drawing_.scale_bar != nullptr)
            labels_.keep_free(scale_bar_box(drawing_.width, drawing_.height, drawing_.scale_bar));
    }
    // Row by row, since memory for all of a large picture takes most of a second.
    const std::size_t all = static_cast<std::size_t>(width_) * height_;
    pixels_.reserve(all);
    if (has_contours) contours_.reserve(all);
    if (is_shaded()) heights_.reserve(all);
    for (std::int32_t y = 0; y < height_; ++y) {
        host_->poll();
        std::fill_n(pixels_.extend(width_), width_, Pixel{});
        if (has_contours) std::fill_n(contours_.extend(width_), width_, 0.0f);
        if (is_shaded()) std::fill_n(heights_.extend(width_), width_, 0.0);
    }
}

inline void Canvas::deposit(std::int32_t x, std::int32_t y, double covered, double count,
                            Shown shown, double ink) {
    const std::size_t at = static_cast<std::size_t>(y) * width_ + x;
    Pixel &pixel = pixels_[at];
    const double value = std::clamp(shown.value, 0.0, 1.0); // NaN stays
    pixel.covered += static_cast<float>(covered);
    pixel.count += static_cast<float>(count);
    if (value == value) {
        pixel.valued += static_cast<float>(covered);
        pixel.value += static_cast<float>(covered * value);
        if (!heights_.empty()) heights_[at] += covered * shown.height;
    }
    pixel.ink += static_cast<float>(ink);
}

bool Canvas::place(Patch &patch, Box<2> &box) const {
    for (int i = 0; i < patch.corners; ++i) {
        patch.corner[i][0] = frame_.x(patch.corner[i][0]);
        patch.corner[i][1] = frame_.y(patch.corner[i][1]);
        box.extend({patch.corner[i][0], patch.corner[i][1]});
    }
    return box.upper[0] > 0 && box.lower[0] < width_ && box.upper[1] > 0 && box.lower[1] < height_;
}

void Canvas::add_edges(const Patch &patch) {
    host_->poll();
    Patch p = patch;
    Box<2> box;
    if (place(p, box)) overlay_.edges(p, raster_);
}

void Canvas::add(const Patch &patch) {
    host_->poll(); // a page may have patches that cover the picture many times over by their edges
    Patch p = patch;
    Box<2> box;
    if (!place(p, box)) return;
    bool has_value = has_values();
    for (int i = 0; i < p.corners; ++i) has_value = has_value && std::isfinite(patch.value[i]);
    if (overlay_.is_needed()) overlay_.edges(p, raster_);
    if (!contours_.empty() && has_value) contour(p, patch.value);

    Shown mean{0, 0};
    double heights[Patch::most];
    for (int i = 0; i < p.corners; ++i) {
        p.value[i] = !has_value ? NAN : low_ < high_ ? bounded(range_(patch.value[i])) : 0.5;
        heights[i] = has_value ? bounded_height(patch.value[i]) : 0;
        mean.value += p.value[i] / p.corners;
        mean.height += heights[i] / p.corners;
    }
    const double area = area_of(p);
    // In huge meshes, most patches lie within one pixel.
    const double x = std::floor(box.lower[0]), y = std::floor(box.lower[1]);
    if (x >= 0 && y >= 0 && box.upper[0] <= x + 1 && box.upper[1] <= y + 1) {
        const double count = p.spacing > 0 ? area * density(p.spacing) : 1;
        const auto column = static_cast<std::int32_t>(x), row = static_cast<std::int32_t>(y);
        deposit(column, row, area, count, mean, drawing_.edges ? area * edge_tone(0) : 0);
        overlay_.tint(static_cast<std::size_t>(row) * width_ + column, p.region, area);
        return;
    }
    fill(p, heights, area, p.spacing > 0 ? density(p.spacing) : std::min(1 / area, most_density));
}

double Canvas::density(double spacing) const {
    // There are two triangles for each vertex.
    const double x = spacing * frame_.pixels_per_unit(0), y = spacing * frame_.pixels_per_unit(1);
    const double density = 2 / (x * y);
    return density < most_density ? density : most_density; // also if it is NaN
}

void Canvas::fill(const Patch &patch, const double (&heights)[Patch::most], double area,
                  double density) {
    const double radius = 2 * area / perimeter(patch);
    const bool is_outlined = drawing_.edges && radius > tone_radius;
    if (is_outlined) outline(patch, edge_width(radius));
    if (!(area > 0)) return;

    const double tone = drawing_.edges && !is_outlined ? edge_tone(radius) : 0;
    const Ramp value(patch, patch.value), height(patch, heights);
    raster_.fill(patch, [&](std::int32_t x, std::int32_t y, double covered) {
        const Shown shown{value(x + 0.5, y + 0.5), height(x + 0.5, y + 0.5)};
        deposit(x, y, covered, covered * density, shown, covered * tone);
        overlay_.tint(static_cast<std::size_t>(y) * width_ + x, patch.region, covered);
    });
}

void Canvas::outline(const Patch &p, double width) {
    // The neighbour across each edge draws the other half of the line.
    const auto ink = [&](std::int32_t x, std::int32_t y, double covered) {
        pixels_[static_cast<std::size_t>(y) * width_ + x].ink += static_cast<float>(covered * 0.5);
    };
    for (int i = 0, j = p.corners - 1; i < p.corners; j = i++)
        raster_.line(p.corner[j], p.corner[i], width, ink);
}

// A corner at a level counts as above it. So only the patch below draws a level along an edge.
void Canvas::contour(const Patch &p, const double (&values)[Patch::most]) {
    const double interval = drawing_.contour_interval;
    const double *const end = values + p.corners;
    const double least = std::max(*std::min_element(values, end), low_);
    const double most = std::min(*std::max_element(values, end), high_);
    const auto ink = [&](std::int32_t x, std::int32_t y, double covered) {
        contours_[static_cast<std::size_t>(y) * width_ + x] += static_cast<float>(covered);
    };
    const double first = std::floor(least / interval);
    const double count = std::floor(most / interval) - first; // levels in the range, and one below
    for (int n = 0; n <= count; ++n) {
        const double level = (first + n) * interval;
        double at[2][2];
        int crossings = 0;
        for (int i = 0, j = p.corners - 1; i < p.corners; j = i++) {
            const bool is_above = values[i] >= level;
            if (is_above == (values[j] >= level) || crossings == 2) continue;
            const int a = is_above ? j : i, b = is_above ? i : j; // upwards
            const double share = (level - values[a]) / (values[b] - values[a]);
            for (int axis = 0; axis < 2; ++axis)
                at[crossings][axis] = std::lerp(p.corner[a][axis], p.corner[b][axis], share);
            ++crossings;
        }
        const bool is_index =
            drawing_.contour_labels != 0 && std::fmod(first + n, index_every) == 0;
        if (crossings == 2) raster_.line(at[0], at[1], is_index ? index_width : contour_width, ink);
        host_->poll();
    }
}

Arena<double> Canvas::labelled_levels() const {
    Arena<double> levels(*host_);
    if (contours_.empty() || drawing_.contour_labels == 0) return levels;
    const double interval = drawing_.contour_interval;
    const double first = std::ceil(low_ / interval / index_every);
    const double count = std::floor(high_ / interval / index_every) - first;
    for (int n = 0; n <= count; ++n) levels.push_back((first + n) * index_every * interval);
    return levels;
}

void Canvas::label(double value, std::span<const Point<2>> path) {
    path_.clear();
    for (const Point<2> &p : path) path_.push_back({frame_.x(p[0]), frame_.y(p[1])});
    labels_.add(value, {path_.data(), path_.size()});
}

void Canvas::leave_only(
    const std::function<void(const std::function<void(const Patch &)> &)> &each) {
    Arena<float> kept(*host_); // the share of each pixel
    kept.reserve(pixels_.size());
    for (std::int32_t y = 0; y < height_; ++y) {
        host_->poll();
        std::fill_n(kept.extend(width_), width_, 0.0f);
    }
    each([&](const Patch &patch) {
        Patch p = patch;
        if (Box<2> box; !place(p, box)) return;
        raster_.fill(p, [&](std::int32_t x, std::int32_t y, double covered) {
            kept[static_cast<std::size_t>(y) * width_ + x] += static_cast<float>(covered);
        });
    });
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        if (i % width_ == 0) host_->poll();
        const float share = std::min(kept[i], 1.0f);
        Pixel &pixel = pixels_[i];
        for (float *sum : {&pixel.covered, &pixel.count, &pixel.valued, &pixel.value, &pixel.ink})
            *sum *= share;
        if (!contours_.empty()) contours_[i] *= share;
        if (!heights_.empty()) heights_[i] *= share;
        overlay_.leave(i, share);
    }
}

bool Canvas::is_blank() const {
    for (std::int32_t y = 0; y < drawing_.height; ++y)
        for (std::int32_t x = 0; x < drawing_.width; ++x)
            if (pixels_[index(x, y)].covered > 0) return false;
    return true;
}

Png Canvas::png(const Palette &palette, double unit) {
    labels_.each_pixel(raster_, [&](std::int32_t x, std::int32_t y, double covered) {
        contours_[static_cast<std::size_t>(y) * width_ + x] *= static_cast<float>(1 - covered);
    });
    Picture picture = drawing_.attribute >= 0 ? values(palette) : mesh();
    labels_.paint(picture);
    if (has_legend()) add_legend(picture, palette, low_, high_, drawing_.legend);
    if (drawing_.scale_bar != nullptr)
        add_scale_bar(picture, frame_.pixels_per_unit(0) * unit, drawing_.scale_bar);
    return picture.png();
}

} // namespace abacus
