// What a picture shows: the checked order, the extent of the mesh, and the
// map from mesh coordinates to pixels.
//
// A mesh is streamed twice when its extent or the range of its attribute must be found
// first; Extent is the first pass. Nothing in this folder grows with the number of
// triangles or tetrahedra.
#pragma once

#include "geometry/box.hpp"
#include "host/host.hpp"

#include <abacus/draw.h>
#include <cmath>
#include <cstdint>

namespace abacus {

/// What pictures are made of: a triangle of a mesh, the plane section of a tetrahedron or a box,
/// a square. A convex polygon, its corners in order, in either orientation; a
/// value for each corner, linear in between, none where it is not finite.
struct Patch {
    static constexpr int most = 6; // corners; the section of a box
    enum class Edge : std::uint8_t { free, hard, soft };

    double corner[most][2];
    double value[most];
    int corners = 3;    // from 3
    double spacing = 0; // distance between vertices of the mesh around here; 0 = as the area tells
    Edge edge[most] = {}; // whether the one from the corner before is fixed
    std::uint32_t region = 0;

    /// Twice the area of three corners; positive if they turn left where y points up.
    double turn(int a, int b, int c) const {
        return (corner[b][0] - corner[a][0]) * (corner[c][1] - corner[a][1]) -
               (corner[c][0] - corner[a][0]) * (corner[b][1] - corner[a][1]);
    }
};

/// Largest width and height, and the most pixels of a picture: each pixel takes
/// 24 bytes while it is drawn, 12 more with hill shading, 4 more with contours, 20 more with
/// regions, 4 more with fixed edges; a margin counts, too.
inline constexpr std::int32_t max_side = 16384;
inline constexpr std::int64_t max_pixels = std::int64_t{1} << 25;

/// True if the drawing names no window of its own, by its first D axes.
template <int D> bool shows_whole(const abacus_drawing &drawing) {
    for (int axis = 0; axis < D; ++axis)
        if (!(drawing.lower[axis] < drawing.upper[axis])) return true;
    return false;
}

/// True if it names the range of its colours.
inline bool has_range(const abacus_drawing &drawing) { return drawing.range[0] < drawing.range[1]; }

/// Throws an Error unless this can be drawn.
void check_drawing(const abacus_drawing &drawing);
/// The height of a picture that shows something of this shape, height to width; kept within the
/// limits, and from an eighth of the width to eight times.
std::int32_t height_of_shape(std::int32_t width, double shape);

/// First pass: window and value range of the patches that the picture shows.
class Extent {
public:
    /// Throws an Error unless this can be drawn.
    explicit Extent(const abacus_drawing &drawing);

    /// False if the picture can be drawn without a first pass.
    static bool is_needed(const abacus_drawing &drawing) {
        return shows_whole<2>(drawing) || (drawing.attribute >= 0 && !has_range(drawing));
    }

    void add(const Patch &patch);

    /// The drawing with window and height filled in: the window given or, if that is
    /// empty, the one that just holds the patches. A height from the window's shape
    /// is kept within the limits, and from an eighth of the width to eight times, at the cost of
    /// the shape.
    abacus_drawing drawing() const;
    /// Range of the colours: the one given or that of the values; NaN if there are none.
    double low() const { return low_ <= high_ ? low_ : NAN; }
    double high() const { return low_ <= high_ ? high_ : NAN; }

private:
    abacus_drawing drawing_;
    bool whole_;
    Box<2> around_;
    double low_, high_;
};

/// Position of `x` in [low, high] as a fraction of it; exact halves keep the
/// difference of two finite numbers finite.
class Scale {
public:
    Scale(double low, double high);
    double operator()(double x) const { return (x * 0.5 - origin_) * factor_; }
    /// Fractions of the range per unit.
    double factor() const { return factor_ * 0.5; }

private:
    double origin_, factor_;
};

/// Map from mesh coordinates to pixels: the window fills the picture, around which there is a
/// margin of so many pixels; y points up in the mesh and down in the picture.
class Frame {
public:
    Frame(const abacus_drawing &drawing, std::int32_t margin);

    double x(double x) const { return bounded(x_(x) * width_ + margin_); }
    double y(double y) const { return bounded(height_ - y_(y) * height_ + margin_); }
    /// Pixels per unit of the mesh along an axis.
    double pixels_per_unit(int axis) const {
        return axis == 0 ? x_.factor() * width_ : y_.factor() * height_;
    }

private:
    // Far corners stay far, but their differences and products stay finite.
    static double bounded(double pixel) { return std::fmin(std::fmax(pixel, -1e30), 1e30); }

    double width_, height_, margin_;
    Scale x_, y_;
};

} // namespace abacus
