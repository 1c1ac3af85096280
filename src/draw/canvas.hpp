// The canvas on which a mesh is drawn, triangle by triangle.
//
// Each pixel keeps a few sums over what the triangles cover of it; the colour is
// made of them at the end. So memory depends on the picture alone, the order of
// the triangles does not matter, and a pixel that holds a thousand triangles
// shows their mean, not the last of them.
//
// There are two styles. With an attribute, the surface is tinted by height and
// shaded as hills. Without one, the mesh itself is the subject: the tint tells
// how many triangles share a pixel's area, on a log scale fitted to the picture,
// so that fine detail lights up and wide triangles recede into the dark.
//
// Edges lose width with the size of their triangle (see edge_width), so that
// their tone stays below a bound however fine the mesh: an etching, no blot.
#pragma once

#include "draw/frame.hpp"
#include "draw/palette.hpp"
#include "draw/picture.hpp"
#include "draw/raster.hpp"
#include "host/arena.hpp"

namespace abacus {

class Relief;

class Canvas {
public:
    /// `drawing` has a window, or comes from an Extent; `low` and `high` are the range
    /// of the attribute, NaN if there is none. Throws an Error if it cannot be drawn.
    Canvas(const Host &host, const abacus_drawing &drawing, double low, double high);

    /// TriangleCorners outside the window are welcome, values may be NaN.
    void triangle(const TriangleCorners &corner, const TriangleValues &value);

    /// The picture of all triangles so far.
    Png png() const;

private:
    /// Sums over the shares of a pixel that triangles cover.
    struct Pixel {
        float covered; // the shares themselves
        float count;   // ... in triangles: share of the triangle in this pixel
        float valued;  // the shares of triangles with values
        float value;   // ... times value, as a fraction of the range
        float ink;     // share under edges
    };

    void fill(const TriangleCorners &p, const TriangleValues &value, double area);
    void outline(const TriangleCorners &p, double width);
    void deposit(std::int32_t x, std::int32_t y, double covered, double count, double value,
                 double ink);

    bool has_values() const { return low_ <= high_; }
    void raise(Relief &relief) const;
    Picture terrain() const;
    Picture mesh() const;

    const Host *host_;
    abacus_drawing drawing_;
    double low_, high_;
    Frame frame_;
    Scale range_;
    Raster raster_;
    Arena<Pixel> pixels_;
};

} // namespace abacus
