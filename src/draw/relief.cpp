#include "draw/relief.hpp"

#include "draw/arithmetic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace abacus {

namespace {

// Sunlight is a little warm and skylight, which fills the shadows, a little blue.
constexpr Color sunlight{1.04f, 1.0f, 0.92f};
constexpr Color skylight{0.90f, 1.0f, 1.18f};
constexpr float sky_share = 0.34f;

constexpr double most_smoothing = 16; // pixels
constexpr int passes = 3;

bool is_height(double h) { return h == h; }

/// Steeper than a picture can show; its square is still a float.
float bounded_slope(double slope) {
    return static_cast<float>(std::fmin(std::fmax(slope, -1e12), 1e12));
}

/// The share that a pixel takes over from its neighbour, depending on the spacing of the vertices.
/// It comes from a table, since each pixel asks sixteen times. Between entries the error is too
/// small to be seen in a picture.
class Feedback {
public:
    explicit Feedback(double part) {
        for (int i = 1; i <= entries; ++i)
            shares_[i] =
                static_cast<float>(std::exp(-1.41421356 / (most_smoothing * part * i / entries)));
        shares_[entries + 1] = shares_[entries];
    }
    float operator()(float spacing) const {
        if (!(spacing > 1)) return 0;
        const float at = std::min((spacing - 1) * scale, static_cast<float>(entries));
        const int i = static_cast<int>(at);
        return shares_[i] + (at - static_cast<float>(i)) * (shares_[i + 1] - shares_[i]);
    }

private:
    static constexpr int entries = 4096;
    static constexpr float scale = static_cast<float>(0.6 * entries / most_smoothing);

    float shares_[entries + 2] = {};
};

} // namespace

Relief::Relief(const Host &host, std::int32_t width, Arena<double> heights, Arena<float> spacings,
               const double (&rise)[2], const double (&light)[2])
    : host_(&host), width_(width), height_(static_cast<std::int32_t>(heights.size() / width)),
      rise_x_(finite(rise[0])), rise_y_(finite(rise[1])), heights_(std::move(heights)),
      spacings_(std::move(spacings)) {
    const bool is_given = light[1] > 0;
    const double azimuth = (is_given ? light[0] : 315) * (std::numbers::pi / 180);
    const double altitude = (is_given ? light[1] : 45) * (std::numbers::pi / 180);
    sun_east_ = static_cast<float>(std::sin(azimuth) * std::cos(altitude));
    sun_north_ = static_cast<float>(std::cos(azimuth) * std::cos(altitude));
    sun_up_ = static_cast<float>(std::sin(altitude));
    smooth();
}

void Relief::smooth() {
    // Spacing first: where it jumps, so would the smoothness, and that would show as
    // a crack in the hill.
    const Arena<float> &spacing = spacings_;
    const Feedback whole(1);
    run(spacings_,
        [&](std::size_t p, std::size_t q) { return whole(std::max(spacing[p], spacing[q])); });
    // Several narrow passes come close to a bell; their variances sum to that of one.
    const double norm = std::sqrt(3.0 / (std::pow(4.0, passes) - 1));
    for (int i = 1; i <= passes; ++i) {
        const Feedback feedback(norm * std::pow(2.0, passes - i));
        run(heights_, [&](std::size_t p, std::size_t q) {
            return feedback((spacing[p] + spacing[q]) * 0.5f);
        });
    }
}

template <class Number, class Weight> void Relief::run(Arena<Number> &field, Weight &&weight) {
    const auto feed = [&](std::size_t p, std::size_t q) {
        if (!is_height(heights_[p]) || !is_height(heights_[q])) return;
        const float w = weight(p, q);
        field[p] += w * (field[q] - field[p]);
    };
    const auto width = static_cast<std::size_t>(width_);
    for (std::int32_t y = 0; y < height_; ++y) {
        host_->poll();
        const std::size_t row = index(0, y);
        for (std::size_t x = 1; x < width; ++x) feed(row + x, row + x - 1);
        for (std::size_t x = width; x-- > 1;) feed(row + x - 1, row + x);
        for (std::size_t x = 0; y > 0 && x < width; ++x) feed(row + x, row + x - width);
    }
    for (std::int32_t y = height_ - 1; y-- > 0;) {
        host_->poll();
        const std::size_t row = index(0, y);
        for (std::size_t x = 0; x < width; ++x) feed(row + x, row + x + width);
    }
}

float Relief::slope(std::size_t at, std::ptrdiff_t step, bool before, bool after,
                    double rise) const {
    const double here = heights_[at];
    before = before && is_height(heights_[at - step]);
    after = after && is_height(heights_[at + step]);
    const double from = before ? heights_[at - step] : here;
    const double to = after ? heights_[at + step] : here;
    return bounded_slope((before && after ? (to - from) * 0.5 : to - from) * rise);
}

Color Relief::light(std::int32_t x, std::int32_t y) const {
    const std::size_t at = index(x, y);
    if (!is_height(heights_[at])) return {1, 1, 1};
    const float east = slope(at, 1, x > 0, x + 1 < width_, rise_x_);
    const float south = slope(at, width_, y > 0, y + 1 < height_, rise_y_);
    const float up = 1 / std::sqrt(1 + east * east + south * south);
    const float sun =
        std::max(0.0f, (sun_up_ - sun_east_ * east + sun_north_ * south) * up) / sun_up_;
    const float sky = (1 + up) * 0.5f;
    return sunlight * (sun * (1 - sky_share)) + skylight * (sky * sky_share);
}

} // namespace abacus
