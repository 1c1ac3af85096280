// Colours: ramps that look even to the eye, mixed as light mixes.
#pragma once

#include <abacus/draw.h>

#include <array>
#include <cstdint>
#include <initializer_list>

namespace abacus {

/// Red, green and blue in linear light, 0 to 1.
struct Color {
    float red, green, blue;

    friend Color operator+(const Color &a, const Color &b) {
        return {a.red + b.red, a.green + b.green, a.blue + b.blue};
    }
    friend Color operator*(const Color &a, float f) { return {a.red * f, a.green * f, a.blue * f}; }
    friend Color operator*(const Color &a, const Color &b) {
        return {a.red * b.red, a.green * b.green, a.blue * b.blue};
    }
};

inline Color mix(const Color &a, const Color &b, float share) {
    return a * (1 - share) + b * share;
}

/// The colour written 0xrrggbb, as on the web (sRGB).
Color color(std::uint32_t rgb);

/// A ramp through evenly spaced colours. Between them it runs straight in Oklab
/// (B. Ottosson, 2020), so that equal steps look equal and nothing turns grey on
/// the way, as mixing in sRGB would make it.
class Palette {
public:
    Palette(std::initializer_list<std::uint32_t> stops);
    /// `t` from 0 to 1.
    const Color &operator()(float t) const {
        const float step = t > 0 ? (t < 1 ? t : 1) * (steps - 1) : 0;
        return ramp_[static_cast<int>(step + 0.5f)];
    }

    /// The one that a drawing names; `usual` if it leaves that open.
    static Palette of(abacus_ramp ramp, abacus_ramp usual);

    /// Heights: valley green, through meadow and straw, to bare rock and snow.
    static Palette terrain();
    /// Values inside the earth: soft and slow to hard and fast.
    static Palette strata();
    /// Density of a mesh: night water, through shoals, to lit shore.
    static Palette shore();

    /// Even in lightness, and told apart by the colour-blind: those of matplotlib, by S. van der
    /// Walt, N. Smith and E. Firing (2015, CC0), here as a few of their colours; cividis by J.
    /// Nuñez, C. Anderton and R. Renslow (2018).
    static Palette viridis();
    static Palette magma();
    static Palette cividis();
    static Palette grey();
    /// Values on both sides of a middle: blue, through white, to red; as dark at one end as at the
    /// other.
    static Palette diverging();

private:
    static constexpr int steps = 2048;
    std::array<Color, steps> ramp_;
};

/// Linear light to 0xrrggbb.
class Encoder {
public:
    Encoder();
    std::uint32_t operator()(const Color &c) const {
        return level(c.red) << 16 | level(c.green) << 8 | level(c.blue);
    }

private:
    std::uint32_t level(float light) const {
        return light > 0 ? levels_[static_cast<int>((light < 1 ? light : 1) * (steps - 1) + 0.5f)]
                         : 0;
    }

    static constexpr int steps = 8192;
    std::array<std::uint8_t, steps> levels_;
};

} // namespace abacus
