#include "draw/overlay.hpp"

#include <array>

namespace abacus {

namespace {

// Pixels.
constexpr double hard_width = 2, soft_width = 1, border_width = 1.5;

// How much of a region's colour its triangles get.
constexpr float tint_strength = 0.4f;

/// The colours of regions by their numbers: those of M. Okabe and K. Ito (2008), which the
/// colour-blind can tell apart, but for black.
const Color &color_of(std::uint32_t region) {
    static const std::array colors = {color(0x56b4e9), color(0xe69f00), color(0x009e73),
                                      color(0xcc79a7), color(0xf0e442), color(0xd55e00),
                                      color(0x0072b2)};
    return colors[(region - 1) % colors.size()];
}

/// Whole if half of a line is drawn.
float line_opacity(float ink) { return std::min(2 * ink, 1.0f); }

} // namespace

Overlay::Overlay(const Host &host, const abacus_drawing &drawing, std::int32_t width,
                 std::int32_t height)
    : width_(static_cast<std::size_t>(width)), tints_(host), lines_(host) {
    const std::size_t all = width_ * static_cast<std::size_t>(height);
    if (drawing.regions != 0) tints_.reserve(all);
    if (drawing.lines != 0) lines_.reserve(all);
    for (std::int32_t y = 0; y < height; ++y) {
        host.poll();
        if (drawing.regions != 0) std::fill_n(tints_.extend(width_), width_, Tint{});
        if (drawing.lines != 0) std::fill_n(lines_.extend(width_), width_, 0.0f);
    }
}

void Overlay::tint(std::size_t at, std::uint32_t region, double covered) {
    if (!has_regions() || region == 0) return;
    Tint &tint = tints_[at];
    tint.color = tint.color + color_of(region) * static_cast<float>(covered);
    tint.share += static_cast<float>(covered);
}

void Overlay::edges(const Patch &patch, const Raster &raster) {
    const auto place = [&](std::int32_t x, std::int32_t y) {
        return static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(x);
    };
    for (int i = 0, j = patch.corners - 1; i < patch.corners; j = i++) {
        if (patch.edge[i] == Patch::Edge::free) continue;
        const double width = patch.edge[i] == Patch::Edge::hard ? hard_width : soft_width;
        if (has_lines())
            raster.line(patch.corner[j], patch.corner[i], width,
                        [&](std::int32_t x, std::int32_t y, double covered) {
                            lines_[place(x, y)] += static_cast<float>(covered * 0.5);
                        });
        if (has_regions() && patch.region != 0)
            raster.line(patch.corner[j], patch.corner[i], border_width,
                        [&](std::int32_t x, std::int32_t y, double covered) {
                            tints_[place(x, y)].border += static_cast<float>(covered * 0.5);
                        });
    }
}

void Overlay::leave(std::size_t at, float share) {
    if (has_regions()) {
        Tint &tint = tints_[at];
        tint = {tint.color * share, tint.share * share, tint.border * share};
    }
    if (has_lines()) lines_[at] *= share;
}

Color Overlay::over(const Color &below, std::size_t at, float covered) const {
    const Color line = color(0xe0314b);
    Color result = below;
    if (has_regions() && tints_[at].share > 0) {
        const Tint &tint = tints_[at];
        const Color own = tint.color * (1 / tint.share);
        const float share = std::min(tint.share / covered, 1.0f);
        result = mix(result, own, tint_strength * share);
        result = mix(result, own, line_opacity(tint.border) * share);
    }
    return has_lines() ? mix(result, line, line_opacity(lines_[at])) : result;
}

} // namespace abacus
