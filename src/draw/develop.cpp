// From sums to colours: the two styles of a canvas. All mixing is done in linear
// light, where half of white and half of black is what a half-covered pixel
// sends to the eye; only the last step encodes it for the screen.

#include "draw/canvas.hpp"
#include "draw/relief.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace abacus {

namespace {

/// Lines give way to each other where they crowd: almost linear for one line,
/// never above 1.
float opacity(float ink) { return ink / std::cbrt(1 + ink * ink * ink); }

/// Fits the palette to the densities of a picture: a histogram of their logarithms, which may lose
/// a little at both ends.
class Exposure {
public:
    void add(float density) {
        ++counts_[bin(density)];
        ++total_;
    }

    void fit() {
        low_ = quantile(0.002);
        high_ = quantile(0.9997);
        // A mesh of even density keeps even colours.
        const float missing = least_range - (high_ - low_);
        if (missing > 0) {
            low_ -= missing * 0.5f;
            high_ += missing * 0.5f;
        }
    }
    /// Fits it to a mean density, so that adjacent pictures have the same colours.
    void fit(double mean) {
        const float middle = static_cast<float>(bin(static_cast<float>(mean))) / per_octave;
        low_ = middle - least_range / 2;
        high_ = middle + least_range / 2;
    }
    /// Place in the palette.
    float operator()(float density) const {
        return (static_cast<float>(bin(density)) / per_octave - low_) / (high_ - low_);
    }

private:
    static constexpr int octaves = 64, per_octave = 64;
    static constexpr float least_range = 7;

    static int bin(float density) {
        const float place = (std::log2(density) + octaves / 2) * per_octave;
        return static_cast<int>(std::clamp(place, 0.0f, octaves * per_octave - 1.0f));
    }
    float quantile(double share) const {
        std::uint64_t passed = 0;
        int i = 0;
        while (i < octaves * per_octave - 1 && passed + counts_[i] <= share * total_)
            passed += counts_[i++];
        return static_cast<float>(i) / per_octave;
    }

    std::uint64_t counts_[octaves * per_octave] = {};
    std::uint64_t total_ = 0;
    float low_ = 0, high_ = 1;
};

// How much of a pixel must be covered to have a density of its own.
constexpr float least_covered = 1e-4f;

/// From the colour of a partly covered pixel to the pixel, over the ground or over nothing.
class Finish {
public:
    Finish(const Color &ground, bool is_transparent)
        : ground_(ground), is_transparent_(is_transparent) {}

    std::uint32_t operator()(const Color &tint, float covered) const {
        const float share = covered > least_covered ? std::min(covered, 1.0f) : 0;
        if (!is_transparent_) return encode_(share > 0 ? mix(ground_, tint, share) : ground_);
        const auto alpha = static_cast<std::uint32_t>(share * 255 + 0.5f);
        const std::uint32_t rgb = encode_(tint);
        const auto part = [&](int shift) {
            return ((rgb >> shift & 255) * alpha + 127) / 255 << shift;
        };
        return alpha << 24 | part(16) | part(8) | part(0);
    }

private:
    const Color ground_;
    const bool is_transparent_;
    const Encoder encode_;
};

} // namespace

Picture Canvas::mesh() const {
    const Palette palette = Palette::shore();
    const Color ground = color(0x03060f);
    const Color light = color(0xfff6df);
    const Finish finish(ground, drawing_.transparent != 0);
    Picture picture(*host_, drawing_.width, drawing_.height, drawing_.transparent != 0);
    Exposure exposure;
    for (std::int32_t y = 0; y < drawing_.height && !(drawing_.density > 0); ++y) {
        host_->poll();
        const Pixel *pixel = &pixels_[index(0, y)];
        for (const Pixel *const end = pixel + drawing_.width; pixel != end; ++pixel)
            if (pixel->covered > least_covered) exposure.add(pixel->count / pixel->covered);
    }
    if (drawing_.density > 0)
        exposure.fit(drawing_.density);
    else
        exposure.fit();
    for (std::int32_t y = 0; y < drawing_.height; ++y) {
        host_->poll();
        const Pixel *pixel = &pixels_[index(0, y)];
        std::uint32_t *row = picture.row(y);
        for (std::int32_t x = 0; x < drawing_.width; ++x, ++pixel) {
            Color tint = ground;
            if (pixel->covered > least_covered) {
                const float t = exposure(pixel->count / pixel->covered);
                // Lines glow in the colour of somewhat finer triangles.
                const Color line = mix(palette(t + 0.22f), light, 0.1f + 0.15f * t);
                tint = mix(palette(t), line, 0.8f * opacity(pixel->ink));
                tint = overlay_.over(tint, index(x, y), pixel->covered);
            }
            row[x] = finish(tint, pixel->covered);
        }
    }
    return picture;
}

/// The relief of the values themselves, whatever the range of the colours is.
Relief Canvas::relief() {
    Arena<float> spacings(*host_);
    spacings.resize(heights_.size());
    const Pixel *pixel = pixels_.begin();
    for (std::size_t i = 0; i < heights_.size(); ++i, ++pixel) {
        if (i % static_cast<std::size_t>(width_) == 0) host_->poll();
        const bool is_land = pixel->valued > least_covered;
        heights_[i] = is_land ? heights_[i] / pixel->valued : NAN;
        // There are two triangles for each vertex.
        spacings[i] = is_land ? std::sqrt(2 * pixel->covered / pixel->count) : 0;
    }
    const double rise[2] = {drawing_.exaggeration * frame_.pixels_per_unit(0),
                            drawing_.exaggeration * frame_.pixels_per_unit(1)};
    return {*host_, width_, std::move(heights_), std::move(spacings), rise, drawing_.light};
}

Picture Canvas::values(const Palette &palette) {
    const Color unknown = color(0xcfccc6);
    const Color ink = color(0x1c2a2c);
    const Finish finish(color(0xf4f1ea), drawing_.transparent != 0);
    Picture picture(*host_, drawing_.width, drawing_.height, drawing_.transparent != 0);
    std::optional<Relief> shading;
    if (is_shaded()) shading.emplace(relief());
    for (std::int32_t y = 0; y < drawing_.height; ++y) {
        host_->poll();
        const Pixel *pixel = &pixels_[index(0, y)];
        std::uint32_t *row = picture.row(y);
        for (std::int32_t x = 0; x < drawing_.width; ++x, ++pixel) {
            Color tint = unknown;
            if (pixel->covered > least_covered) {
                if (pixel->valued > least_covered)
                    tint = mix(unknown, palette(pixel->value / pixel->valued),
                               std::min(pixel->valued / pixel->covered, 1.0f));
                if (shading) tint = tint * shading->light(x + margin_, y + margin_);
                tint = mix(tint, ink, 0.5f * opacity(pixel->ink));
                if (!contours_.empty())
                    tint = mix(tint, ink, 0.8f * opacity(contours_[index(x, y)]));
                tint = overlay_.over(tint, index(x, y), pixel->covered);
            }
            row[x] = finish(tint, pixel->covered);
        }
    }
    return picture;
}

} // namespace abacus
