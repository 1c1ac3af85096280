#include "draw/captions.hpp"

#include "draw/letters.hpp"

#include <cairo.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

namespace abacus {

namespace {

double scale_of(const Picture &picture) { return caption_scale(picture.width(), picture.height()); }

double letter_height(double scale) { return 9 * scale; }

void choose(cairo_t *pen, std::uint32_t rgb, double alpha = 1) {
    cairo_set_source_rgba(pen, (rgb >> 16 & 255) / 255.0, (rgb >> 8 & 255) / 255.0,
                          (rgb & 255) / 255.0, alpha);
}

void choose_ink(cairo_t *pen) { choose(pen, 0x1c2a2c); }

/// A light background for the caption.
void panel(cairo_t *pen, double x, double y, double width, double height) {
    choose(pen, 0xffffff, 0.82);
    cairo_rectangle(pen, std::floor(x), std::floor(y), std::ceil(width), std::ceil(height));
    cairo_fill(pen);
}

} // namespace

double caption_scale(std::int32_t width, std::int32_t height) {
    return std::clamp(std::min(width, height) / 500.0, 0.8, 4.0);
}

double round_step(double x) {
    const double power = std::pow(10.0, std::floor(std::log10(x)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (power * factor >= x) return power * factor;
    return power * 10;
}

std::string number_text(double value, double step) {
    char text[64];
    std::to_chars_result result{};
    if (std::fabs(value) < 1e9 && step > 1e-7) {
        const int digits = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
        const double rounded = std::round(value / step) * step;
        result =
            std::to_chars(text, std::end(text), rounded + 0.0, std::chars_format::fixed, digits);
    } else {
        result = std::to_chars(text, std::end(text), value, std::chars_format::general, 4);
    }
    return {text, result.ptr};
}

void add_legend(Picture &picture, const Palette &palette, double low, double high,
                const char *title) {
    const double s = scale_of(picture), letters = letter_height(s), margin = 10 * s, pad = 8 * s;
    const double bar_height = std::min(150 * s, picture.height() * 0.6), bar_width = 14 * s;
    const double extent = high / 2 - low / 2;
    const double step = extent > 0 ? round_step(extent / 2.5) : std::max(std::fabs(low), 1e-300);
    std::vector<double> values;
    if (extent > 0)
        for (double n = std::ceil(low / step), end = n + 12; n < end && n * step <= high; ++n)
            values.push_back(n * step);
    else
        values.push_back(low);
    double text = 0;
    for (const double value : values)
        text = std::max(text, text_width(number_text(value, step), letters));
    const std::string_view heading(title);
    const double head = heading.empty() ? 0 : letters * 1.3 + pad;
    const double width = 2 * pad + std::max(bar_width + 8 * s + text, text_width(heading, letters));
    const double height = 2 * pad + head + bar_height;
    const double left = picture.width() - margin - width, top = picture.height() - margin - height;
    const Encoder encode;
    picture.paint([&](cairo_t *pen) {
        panel(pen, left, top, width, height);
        choose_ink(pen);
        draw_text(pen, left + pad, top + pad + letters, heading, letters);
        const double x = std::floor(left + pad), y = std::floor(top + pad + head);
        const int rows = std::max(1, static_cast<int>(bar_height));
        for (int row = 0; row < rows; ++row) {
            const double share = rows > 1 ? 1 - row / (rows - 1.0) : 0.5;
            choose(pen, encode(palette(static_cast<float>(extent > 0 ? share : 0.5))));
            cairo_rectangle(pen, x, y + row, std::ceil(bar_width), 1);
            cairo_fill(pen);
        }
        choose_ink(pen);
        for (const double value : values) {
            const double share = extent > 0 ? (value / 2 - low / 2) / extent : 0.5;
            const double at = y + (1 - share) * (rows - 1) + 0.5;
            cairo_rectangle(pen, x + std::ceil(bar_width), at - 0.5 * s, 4 * s, s);
            cairo_fill(pen);
            draw_text(pen, x + bar_width + 8 * s, at + letters / 2, number_text(value, step),
                      letters);
        }
    });
}

void add_scale_bar(Picture &picture, double pixels_per_unit, const char *unit) {
    const double s = scale_of(picture), letters = letter_height(s), margin = 10 * s, pad = 8 * s;
    const double most = picture.width() * 0.3 / pixels_per_unit;
    if (!(most > 0 && std::isfinite(most))) return; // coordinates at the limits of doubles
    const double length = round_step(most * 0.4);   // at most 2.5 times that
    std::string text = number_text(length, length);
    if (*unit != '\0') text += ' ' + std::string(unit);
    const double bar = length * pixels_per_unit;
    const double width = 2 * pad + std::max(bar, text_width(text, letters));
    const double height = 2 * pad + letters * 1.6 + 5 * s;
    const double left = margin, top = picture.height() - margin - height;
    picture.paint([&](cairo_t *pen) {
        panel(pen, left, top, width, height);
        choose_ink(pen);
        draw_text(pen, left + pad, top + pad + letters, text, letters);
        const double y = top + height - pad;
        cairo_set_line_width(pen, 1.5 * s);
        cairo_set_line_cap(pen, CAIRO_LINE_CAP_BUTT);
        cairo_move_to(pen, left + pad, y - 5 * s);
        cairo_line_to(pen, left + pad, y);
        cairo_line_to(pen, left + pad + bar, y);
        cairo_line_to(pen, left + pad + bar, y - 5 * s);
        cairo_stroke(pen);
    });
}

} // namespace abacus
