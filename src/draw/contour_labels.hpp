// Values written on contours: along a line where it is nearly straight, upright, and apart from one
// another. Lines end where a value begins.
//
// A line gets a value in each stretch of some length, in the order in which lines come. So where
// values are depends on the lines and the picture alone.
#pragma once

#include "draw/picture.hpp"
#include "draw/raster.hpp"
#include "geometry/box.hpp"
#include "host/arena.hpp"

#include <span>
#include <string>

namespace abacus {

/// A contour's value, a multiple of the interval, with as many digits as it needs; in full, unless
/// that would be very long.
std::string contour_text(double value, double interval);

class ContourLabels {
public:
    /// For a picture of this size with its margin, in pixels. Values are multiples of the
    /// interval.
    ContourLabels(const Host &host, std::int32_t width, std::int32_t height, std::int32_t margin,
                  double interval);

    /// No value is written there; the box is that of a picture without its margin.
    void keep_free(const Box<2> &box);

    /// Looks for places on the line of a value; `path` is in pixels, with the margin, and does not
    /// leave the picture by far: it is tried pixel by pixel.
    void add(double value, std::span<const Point<2>> path);

    /// Calls sink(x, y, share) for the pixels, with the margin, that values take.
    template <class Sink> void each_pixel(Raster &raster, Sink sink) const {
        for (const Label &label : labels_) {
            Patch patch{};
            patch.corners = 4;
            for (int i = 0; i < 4; ++i) {
                const double along = i == 0 || i == 3 ? -label.half : label.half;
                const double across = i < 2 ? -half_height_ : half_height_;
                const Point<2> corner = label.at(along, across);
                patch.corner[i][0] = corner[0];
                patch.corner[i][1] = corner[1];
            }
            raster.fill(patch, sink);
        }
    }
    /// Writes them into the picture, without its margin.
    void paint(Picture &picture) const;

private:
    struct Label {
        double value;
        Point<2> middle, direction;
        double half; // of its length

        /// A place by its distances from the middle.
        Point<2> at(double along, double across) const {
            return {middle[0] + direction[0] * along - direction[1] * across,
                    middle[1] + direction[1] * along + direction[0] * across};
        }
    };
    /// A place of a line, with its distance from the beginning.
    struct Step {
        Point<2> at;
        double along;
    };

    void measure(std::span<const Point<2>> path);
    Point<2> place(double along, std::size_t &hint) const;
    double bend(double from, double to, Label &label) const;
    bool is_free(const Label &label) const;
    void take(const Label &label);
    void make_cells();
    template <class Visit> bool each_cell(const Label &label, Visit visit) const;

    const Host &host_;
    const std::int32_t width_, height_, margin_;
    const double interval_, letters_, half_height_, cell_;
    const std::int32_t columns_;
    Arena<Label> labels_;
    Arena<Step> steps_;         // of the line
    Arena<std::uint8_t> taken_; // cells of the picture that have a value, or are kept free
};

} // namespace abacus
