#include "draw/palette.hpp"

#include <algorithm>
#include <cmath>

namespace abacus {

namespace {

float decoded(std::uint32_t level) {
    const double s = (level & 255) / 255.0;
    return static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
}

double encoded(double light) {
    return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

struct Oklab {
    double lightness, a, b;
};

Oklab to_oklab(const Color &c) {
    const double l =
        std::cbrt(0.4122214708 * c.red + 0.5363325363 * c.green + 0.0514459929 * c.blue);
    const double m =
        std::cbrt(0.2119034982 * c.red + 0.6806995451 * c.green + 0.1073969566 * c.blue);
    const double s =
        std::cbrt(0.0883024619 * c.red + 0.2817188376 * c.green + 0.6299787005 * c.blue);
    return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
            1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
            0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

Color from_oklab(const Oklab &lab) {
    const double l = lab.lightness + 0.3963377774 * lab.a + 0.2158037573 * lab.b;
    const double m = lab.lightness - 0.1055613458 * lab.a - 0.0638541728 * lab.b;
    const double s = lab.lightness - 0.0894841775 * lab.a - 1.2914855480 * lab.b;
    const double l3 = l * l * l, m3 = m * m * m, s3 = s * s * s;
    const auto light = [](double x) { return static_cast<float>(std::clamp(x, 0.0, 1.0)); };
    return {light(4.0767416621 * l3 - 3.3077115913 * m3 + 0.2309699292 * s3),
            light(-1.2684380046 * l3 + 2.6097574011 * m3 - 0.3413193965 * s3),
            light(-0.0041960863 * l3 - 0.7034186147 * m3 + 1.7076147010 * s3)};
}

} // namespace

Color color(std::uint32_t rgb) { return {decoded(rgb >> 16), decoded(rgb >> 8), decoded(rgb)}; }

Palette::Palette(std::initializer_list<std::uint32_t> stops) {
    const auto last = static_cast<double>(stops.size() - 1);
    for (int i = 0; i < steps; ++i) {
        const double place = i * last / (steps - 1);
        const double before = std::min(std::floor(place), last - 1);
        const double share = place - before;
        const auto *stop = stops.begin() + static_cast<int>(before);
        const Oklab p = to_oklab(color(stop[0]));
        const Oklab q = to_oklab(color(stop[1]));
        ramp_[i] = from_oklab({p.lightness + (q.lightness - p.lightness) * share,
                               p.a + (q.a - p.a) * share, p.b + (q.b - p.b) * share});
    }
}

Palette Palette::terrain() {
    return {0x24564f, 0x3f7a58, 0x75a065, 0xb0bf78, 0xdfd193,
            0xdcb888, 0xcfa58d, 0xe3d2c8, 0xffffff};
}

Palette Palette::strata() {
    return {0xfdf3c4, 0xf8d384, 0xf0a65f, 0xde775a, 0xbb5772,
            0x8f5290, 0x6a5ba0, 0x5076a8, 0x5a9bb0};
}

Palette Palette::shore() {
    return {0x050b1c, 0x08193a, 0x0b2d5b, 0x0f4c78, 0x1b7489,
            0x4d9f95, 0xb9c184, 0xf8d27a, 0xfff5dc};
}

Palette Palette::viridis() {
    return {0x440154, 0x472d7b, 0x3b528b, 0x2c728e, 0x21908c,
            0x27ad81, 0x5dc863, 0xaadc32, 0xfde725};
}

Palette Palette::magma() {
    return {0x000004, 0x1d1147, 0x51127c, 0x822681, 0xb63679,
            0xe65164, 0xfb8861, 0xfec287, 0xfcfdbf};
}

Palette Palette::cividis() {
    return {0x00204d, 0x00336f, 0x39486b, 0x575c6d, 0x707173,
            0x8a8779, 0xa69d75, 0xc4b56c, 0xe4cf5b, 0xffea46};
}

Palette Palette::grey() { return {0x121212, 0xf6f6f6}; }

Palette Palette::diverging() {
    return {0x1d3a70, 0x2f69a8, 0x6fa3cf, 0xb9d3e6, 0xf5f4f2,
            0xf0c9b4, 0xdf8e6c, 0xbb4a3c, 0x7a1b2c};
}

Palette Palette::of(abacus_ramp ramp, abacus_ramp usual) {
    switch (ramp == ABACUS_RAMP_USUAL ? usual : ramp) {
    case ABACUS_RAMP_STRATA:
        return strata();
    case ABACUS_RAMP_VIRIDIS:
        return viridis();
    case ABACUS_RAMP_MAGMA:
        return magma();
    case ABACUS_RAMP_CIVIDIS:
        return cividis();
    case ABACUS_RAMP_GREY:
        return grey();
    case ABACUS_RAMP_DIVERGING:
        return diverging();
    default:
        return terrain();
    }
}

Encoder::Encoder() {
    for (int i = 0; i < steps; ++i)
        levels_[i] = static_cast<std::uint8_t>(
            std::floor(encoded(static_cast<double>(i) / (steps - 1)) * 255 + 0.5));
}

} // namespace abacus
