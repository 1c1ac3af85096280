// The canvas on which a mesh is drawn, patch by patch: triangle by triangle, or one
// tetrahedron's section after the other.
//
// Each pixel keeps a few sums over the shares that patches cover, and the colour is
// computed from them at the end. So memory depends on the picture alone, the order of
// the patches does not matter, and a pixel that holds a thousand patches shows their
// mean, not the last of them.
//
// There are two styles. With an attribute, the surface is tinted by its value and
// shaded as hills. Without one, the mesh itself is the subject: the tint tells
// how many patches share a pixel's area, on a log scale fitted to the picture,
// so that fine detail lights up and wide triangles recede into the dark. A plane
// cuts small corners off large tetrahedra; patches of a section therefore bring
// the mesh's own spacing, by which they count as triangles of that size would.
//
// A picture of a window is drawn with a margin, which is cut off in the end: what is there casts
// its light and its lines into the window. So windows side by side fit at their seam.
//
// Edges get thinner with the size of their patch (see edge_width). So their tone stays
// below a bound however fine the mesh is: an etching, not a blot.
#pragma once

#include "draw/contour_labels.hpp"
#include "draw/frame.hpp"
#include "draw/overlay.hpp"
#include "draw/palette.hpp"
#include "draw/picture.hpp"
#include "draw/raster.hpp"
#include "host/arena.hpp"

#include <functional>

#include <abacus/draw.h>

namespace abacus {

class Relief;

class Canvas {
public:
    /// `drawing` has a window, or comes from an Extent; `low` and `high` are the range
    /// of the attribute, NaN if there is none; `margin` is in pixels. Throws an Error if it cannot
    /// be drawn.
    Canvas(const Host &host, const abacus_drawing &drawing, double low, double high,
           std::int32_t margin = 0);

    /// How wide a margin makes a window fit to what is beside it.
    static std::int32_t margin_of(const abacus_drawing &drawing);

    /// Corners outside the window are welcome, values may be NaN.
    void add(const Patch &patch);
    /// Leaves only what other patches cover, which do not overlap: each(keep) calls keep(patch) for
    /// all of them.
    void leave_only(const std::function<void(const std::function<void(const Patch &)> &)> &each);
    /// The fixed edges of a patch alone.
    void add_edges(const Patch &patch);

    /// The levels whose contours get their values, in ascending order; none if they get none.
    Arena<double> labelled_levels() const;
    /// Writes the value of a contour on it where there is room; `path` is in coordinates.
    void label(double value, std::span<const Point<2>> path);
    const abacus_drawing &drawing() const { return drawing_; }

    /// Whether no patch so far covers anything of the picture.
    bool is_blank() const;
    /// The picture of all patches so far; `palette` gives the colours of values. `unit` is the unit
    /// of coordinates in which a scale bar tells lengths.
    /// Once: the heights are used up.
    Png png(const Palette &palette, double unit = 1);

private:
    /// Sums over the shares of a pixel that patches cover.
    struct Pixel {
        float covered; // the shares themselves
        float count;   // ... in patches: share of the patch in this pixel
        float valued;  // the shares of patches with values
        float value;   // ... times value, as a fraction of the range; beyond it that of its end
        float ink;     // share under edges
    };

    /// What a patch has at a place.
    struct Shown {
        double value;  // as a fraction of the range; NaN: none
        double height; // the value itself
    };

    /// Both take the patch in pixels, with values as fractions of the range; `heights` are the
    /// values themselves.
    void fill(const Patch &patch, const double (&heights)[Patch::most], double area,
              double density);
    void outline(const Patch &patch, double width);
    /// Draws the contours of a patch; its values are not fractions here.
    void contour(const Patch &pixels, const double (&values)[Patch::most]);
    /// Patches a pixel where vertices are this far apart.
    double density(double spacing) const;
    void deposit(std::int32_t x, std::int32_t y, double covered, double count, Shown shown,
                 double ink);
    /// The corners of a patch in pixels; false if none of the picture is near it.
    bool place(Patch &patch, Box<2> &box) const;

    bool has_values() const { return low_ <= high_; }
    bool has_legend() const {
        return drawing_.attribute >= 0 && drawing_.legend != nullptr && has_values();
    }
    bool is_shaded() const { return is_shaded(drawing_) && low_ < high_; }
    static bool is_shaded(const abacus_drawing &drawing) {
        return drawing.attribute >= 0 && drawing.exaggeration != 0;
    }
    /// Place of a pixel of the picture among all.
    std::size_t index(std::int32_t x, std::int32_t y) const {
        return static_cast<std::size_t>(y + margin_) * width_ + (x + margin_);
    }
    Relief relief();
    Picture values(const Palette &palette);
    Picture mesh() const;

    const Host *host_;
    abacus_drawing drawing_;
    double low_, high_;
    const std::int32_t margin_;
    const std::int32_t width_, height_; // with the margin
    Frame frame_;
    Scale range_;
    Raster raster_;
    Overlay overlay_;
    Arena<Pixel> pixels_;
    ContourLabels labels_;
    Arena<Point<2>> path_;  // of a contour, in pixels
    Arena<float> contours_; // shares of pixels under them; empty if there are none
    Arena<double> heights_; // shares of patches with values, times the value; empty unless shaded
};

} // namespace abacus
