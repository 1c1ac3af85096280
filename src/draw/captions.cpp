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

// Of a caption, by the scale: what is around it, and inside.
double caption_margin(double scale) { return 10 * scale; }
double padding(double scale) { return 8 * scale; }

// Of a legend.
double bar_width(double scale) { return 14 * scale; }
double text_gap(double scale) { return 8 * scale; }
double bar_height(std::int32_t picture_height, double scale) {
    return std::min(150 * scale, picture_height * 0.6);
}
double head_height(std::string_view heading, double scale) {
    return heading.empty() ? 0 : letter_height(scale) * 1.3 + padding(scale);
}

/// Of the picture's width, for a scale bar.
constexpr double most_bar = 0.3;

/// The numbers beside the colours of a legend.
struct LegendValues {
    LegendValues(double low, double high)
        : extent(high / 2 - low / 2),
          step(extent > 0 ? round_step(extent / 2.5) : std::max(std::fabs(low), 1e-300)) {
        if (extent > 0)
            for (double n = std::ceil(low / step), end = n + 12; n < end && n * step <= high; ++n)
                all.push_back(n * step);
        else
            all.push_back(low);
    }

    double extent, step; ///< half of the range
    std::vector<double> all;
};

Box<2> box_at(double x, double y, double width, double height) {
    return {{x, y}, {x + width, y + height}};
}

void choose(cairo_t *pen, std::uint32_t rgb, double alpha = 1) {
    cairo_set_source_rgba(pen, (rgb >> 16 & 255) / 255.0, (rgb >> 8 & 255) / 255.0,
                          (rgb & 255) / 255.0, alpha);
}

void choose_ink(cairo_t *pen) { choose(pen, 0x1c2a2c); }

/// A light background for the caption.
void panel(cairo_t *pen, const Box<2> &box) {
    choose(pen, 0xffffff, 0.82);
    cairo_rectangle(pen, std::floor(box.lower[0]), std::floor(box.lower[1]),
                    std::ceil(box.upper[0] - box.lower[0]), std::ceil(box.upper[1] - box.lower[1]));
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

Box<2> legend_box(std::int32_t picture_width, std::int32_t picture_height, double low, double high,
                  const char *title) {
    const double s = caption_scale(picture_width, picture_height), letters = letter_height(s);
    const LegendValues values(low, high);
    double text = 0;
    for (const double value : values.all)
        text = std::max(text, text_width(number_text(value, values.step), letters));
    const std::string_view heading(title);
    const double width =
        2 * padding(s) + std::max(bar_width(s) + text_gap(s) + text, text_width(heading, letters));
    const double height = 2 * padding(s) + head_height(heading, s) + bar_height(picture_height, s);
    return box_at(picture_width - caption_margin(s) - width,
                  picture_height - caption_margin(s) - height, width, height);
}

void add_legend(Picture &picture, const Palette &palette, double low, double high,
                const char *title) {
    const double s = scale_of(picture), letters = letter_height(s);
    const LegendValues values(low, high);
    const std::string_view heading(title);
    const Box<2> box = legend_box(picture.width(), picture.height(), low, high, title);
    const Encoder encode;
    picture.paint([&](cairo_t *pen) {
        panel(pen, box);
        choose_ink(pen);
        draw_text(pen, box.lower[0] + padding(s), box.lower[1] + padding(s) + letters, heading,
                  letters);
        const double x = std::floor(box.lower[0] + padding(s)),
                     y = std::floor(box.lower[1] + padding(s) + head_height(heading, s));
        const int rows = std::max(1, static_cast<int>(bar_height(picture.height(), s)));
        for (int row = 0; row < rows; ++row) {
            const double share = rows > 1 ? 1 - row / (rows - 1.0) : 0.5;
            choose(pen, encode(palette(static_cast<float>(values.extent > 0 ? share : 0.5))));
            cairo_rectangle(pen, x, y + row, std::ceil(bar_width(s)), 1);
            cairo_fill(pen);
        }
        choose_ink(pen);
        for (const double value : values.all) {
            const double share = values.extent > 0 ? (value / 2 - low / 2) / values.extent : 0.5;
            const double at = y + (1 - share) * (rows - 1) + 0.5;
            cairo_rectangle(pen, x + std::ceil(bar_width(s)), at - 0.5 * s, 4 * s, s);
            cairo_fill(pen);
            draw_text(pen, x + bar_width(s) + text_gap(s), at + letters / 2,
                      number_text(value, values.step), letters);
        }
    });
}

Box<2> scale_bar_box(std::int32_t picture_width, std::int32_t picture_height, const char *unit) {
    const double s = caption_scale(picture_width, picture_height), letters = letter_height(s);
    const double text = text_width("0.0000005 " + std::string(unit), letters); // the longest number
    const double height = 2 * padding(s) + letters * 1.6 + 5 * s;
    return box_at(caption_margin(s), picture_height - caption_margin(s) - height,
                  2 * padding(s) + std::max(most_bar * picture_width, text), height);
}

void add_scale_bar(Picture &picture, double pixels_per_unit, const char *unit) {
    const double s = scale_of(picture), letters = letter_height(s);
    const double most = picture.width() * most_bar / pixels_per_unit;
    if (!(most > 0 && std::isfinite(most))) return; // coordinates at the limits of doubles
    const double length = round_step(most * 0.4);   // at most 2.5 times that
    std::string text = number_text(length, length);
    if (*unit != '\0') text += ' ' + std::string(unit);
    const double bar = length * pixels_per_unit;
    Box<2> box = scale_bar_box(picture.width(), picture.height(), unit);
    box.upper[0] = box.lower[0] + 2 * padding(s) + std::max(bar, text_width(text, letters));
    const double left = box.lower[0] + padding(s), y = box.upper[1] - padding(s);
    picture.paint([&](cairo_t *pen) {
        panel(pen, box);
        choose_ink(pen);
        draw_text(pen, left, box.lower[1] + padding(s) + letters, text, letters);
        cairo_set_line_width(pen, 1.5 * s);
        cairo_set_line_cap(pen, CAIRO_LINE_CAP_BUTT);
        cairo_move_to(pen, left, y - 5 * s);
        cairo_line_to(pen, left, y);
        cairo_line_to(pen, left + bar, y);
        cairo_line_to(pen, left + bar, y - 5 * s);
        cairo_stroke(pen);
    });
}

} // namespace abacus
