#include "draw/contour_labels.hpp"

#include "draw/captions.hpp"
#include "draw/letters.hpp"

#include <cairo.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

namespace abacus {

namespace {

// In heights of a capital: the room around a value, the length of line with one value, how far the
// line may be from the middle of the value, and the distance of places that are tried.
constexpr double pad = 0.6, stretch = 40, most_bend = 0.3, try_step = 0.5;
// A line much longer than the value, as it turns back, is no straight one.
constexpr double least_chord = 0.9;

double distance_of(const Point<2> &a, const Point<2> &b) {
    return std::hypot(b[0] - a[0], b[1] - a[1]);
}

} // namespace

std::string contour_text(double value, double interval) {
    std::array<char, 64> text;
    double rounded = value;
    for (const int digits : {12, 13, 14, 15, 16, 17}) {
        const auto end =
            std::to_chars(text.begin(), text.end(), value + 0.0, std::chars_format::general, digits)
                .ptr;
        std::from_chars(text.data(), end, rounded);
        if (std::fabs(rounded - value) <= interval / 1000) break;
    }
    const bool is_long = rounded != 0 && !(std::fabs(rounded) >= 1e-5 && std::fabs(rounded) < 1e17);
    const auto end = std::to_chars(text.begin(), text.end(), rounded,
                                   is_long ? std::chars_format::general : std::chars_format::fixed)
                         .ptr;
    return {text.data(), end};
}

ContourLabels::ContourLabels(const Host &host, std::int32_t width, std::int32_t height,
                             std::int32_t margin, double interval)
    : host_(host), width_(width), height_(height), margin_(margin), interval_(interval),
      letters_(8 * caption_scale(width - 2 * margin, height - 2 * margin)),
      half_height_(letters_ * 0.5 + letters_ * 0.4), cell_(letters_ * 0.5),
      columns_(static_cast<std::int32_t>(width / cell_) + 1), labels_(host), steps_(host),
      taken_(host) {}

void ContourLabels::make_cells() {
    if (!taken_.empty()) return;
    taken_.resize((static_cast<std::size_t>(height_ / cell_) + 1) * columns_);
    std::fill(taken_.begin(), taken_.end(), 0);
}

void ContourLabels::keep_free(const Box<2> &box) {
    make_cells();
    const auto cell = [&](double at, std::int32_t size) {
        return static_cast<std::int32_t>(std::clamp<double>(at + margin_, 0, size) / cell_);
    };
    for (std::int32_t row = cell(box.lower[1], height_); row <= cell(box.upper[1], height_); ++row)
        for (std::int32_t column = cell(box.lower[0], width_); column <= cell(box.upper[0], width_);
             ++column)
            taken_[static_cast<std::size_t>(row) * columns_ + column] = 1;
}

/// Keeps places a pixel apart, and the ends.
void ContourLabels::measure(std::span<const Point<2>> path) {
    steps_.clear();
    for (std::size_t i = 0; i < path.size(); ++i) {
        if (i % 4096 == 0) host_.poll();
        if (steps_.empty()) {
            steps_.push_back({path[i], 0});
            continue;
        }
        const double step = distance_of(steps_.back().at, path[i]);
        if (step >= 1 || (i + 1 == path.size() && step > 0))
            steps_.push_back({path[i], steps_.back().along + step});
    }
}

/// The place at a distance from the beginning; `hint` is a step before it, and then the last such.
Point<2> ContourLabels::place(double along, std::size_t &hint) const {
    while (hint + 2 < steps_.size() && steps_[hint + 1].along <= along) ++hint;
    const Step &from = steps_[hint], &to = steps_[hint + 1];
    const double share = std::clamp((along - from.along) / (to.along - from.along), 0.0, 1.0);
    return {std::lerp(from.at[0], to.at[0], share), std::lerp(from.at[1], to.at[1], share)};
}

/// How far the line is from a straight one between two distances, at most; infinite if it turns
/// back. Sets the place of the label.
double ContourLabels::bend(double from, double to, Label &label) const {
    const auto first = static_cast<std::size_t>(
        std::upper_bound(steps_.begin(), steps_.end(), from,
                         [](double along, const Step &step) { return along < step.along; }) -
        steps_.begin());
    std::size_t hint = first == 0 ? 0 : first - 1;
    const Point<2> a = place(from, hint);
    const std::size_t begin = hint;
    const Point<2> b = place(to, hint);
    const double chord = distance_of(a, b);
    if (!(chord >= least_chord * (to - from))) return INFINITY;
    const Point<2> way{(b[0] - a[0]) / chord, (b[1] - a[1]) / chord};
    double least = 0, most = 0;
    for (std::size_t i = begin + 1; i <= hint; ++i) {
        const double off = (steps_[i].at[1] - a[1]) * way[0] - (steps_[i].at[0] - a[0]) * way[1];
        least = std::fmin(least, off);
        most = std::fmax(most, off);
    }
    // The value lies in the middle of what the line takes, and is read from the left, or upwards.
    const double off = least / 2 + most / 2;
    const bool is_turned = way[0] < 0 || (way[0] == 0 && way[1] > 0);
    label.direction = is_turned ? Point<2>{-way[0], -way[1]} : way;
    label.middle = {a[0] / 2 + b[0] / 2 - way[1] * off, a[1] / 2 + b[1] / 2 + way[0] * off};
    return most / 2 - least / 2;
}

/// Calls visit(cell) for those under a label, until it returns false.
template <class Visit> bool ContourLabels::each_cell(const Label &label, Visit visit) const {
    const int along = static_cast<int>(std::ceil(2 * label.half / cell_));
    const int across = static_cast<int>(std::ceil(2 * half_height_ / cell_));
    for (int i = 0; i <= along; ++i)
        for (int k = 0; k <= across; ++k) {
            const Point<2> p =
                label.at(label.half * (2.0 * i / along - 1), half_height_ * (2.0 * k / across - 1));
            const auto column = static_cast<std::int32_t>(p[0] / cell_);
            const auto row = static_cast<std::int32_t>(p[1] / cell_);
            if (!visit(static_cast<std::size_t>(row) * columns_ + column)) return false;
        }
    return true;
}

/// Whether it is in the picture as a whole, and nothing is there.
bool ContourLabels::is_free(const Label &label) const {
    for (const double along : {-label.half, label.half})
        for (const double across : {-half_height_, half_height_}) {
            const Point<2> p = label.at(along, across);
            if (!(p[0] >= margin_ && p[0] <= width_ - margin_ && p[1] >= margin_ &&
                  p[1] <= height_ - margin_))
                return false;
        }
    return each_cell(label, [&](std::size_t cell) { return taken_[cell] == 0; });
}

void ContourLabels::take(const Label &label) {
    each_cell(label, [&](std::size_t cell) {
        taken_[cell] = 1;
        return true;
    });
    labels_.push_back(label);
}

void ContourLabels::add(double value, std::span<const Point<2>> path) {
    measure(path);
    const double total = steps_.empty() ? 0 : steps_.back().along;
    const double half = text_width(contour_text(value, interval_), letters_) / 2 + pad * letters_;
    if (!(total >= 3 * half)) return; // too short to be seen beside its value
    make_cells();
    const double count = std::fmax(1, std::floor(total / (stretch * letters_)));
    for (double n = 0; n < count; ++n) {
        const double begin = total / count * n, end = total / count * (n + 1);
        Label best{};
        double least = INFINITY;
        for (int i = 0;; ++i) {
            host_.poll();
            const double middle = begin + half + i * try_step * letters_;
            if (middle + half > end) break;
            Label label{value, {}, {}, half};
            const double found = bend(middle - half, middle + half, label);
            if (found > most_bend * letters_ || !(found < least) || !is_free(label)) continue;
            least = found;
            best = label;
        }
        if (least < INFINITY) take(best);
    }
}

void ContourLabels::paint(Picture &picture) const {
    if (labels_.empty()) return;
    picture.paint([&](cairo_t *pen) {
        for (const Label &label : labels_) {
            host_.poll();
            const std::string text = contour_text(label.value, interval_);
            cairo_identity_matrix(pen);
            cairo_translate(pen, label.middle[0] - margin_, label.middle[1] - margin_);
            cairo_rotate(pen, std::atan2(label.direction[1], label.direction[0]));
            const double left = -text_width(text, letters_) / 2;
            cairo_set_source_rgba(pen, 1, 1, 1, 0.65); // so that it can be read on dark colours
            draw_text(pen, left, letters_ / 2, text, letters_, halo_width);
            cairo_set_source_rgb(pen, 0x1c / 255.0, 0x2a / 255.0, 0x2c / 255.0);
            draw_text(pen, left, letters_ / 2, text, letters_);
        }
    });
}

} // namespace abacus
