// A plane through space, as the sheet of a picture: on which side of it a point
// lies, where its foot is on the sheet, and which part of a box it cuts.
//
// The side is decided in floating point, since exact decisions would differ by less
// than any picture shows. But a picture would show a gap. There is none as long as all
// tetrahedra around a vertex agree on its side. So the side is a function of the
// coordinates alone. A point is on the plane when the rounding of its own coordinates
// could have brought it there: a plane through 0.1 + 0.2 meets a layer of a grid at
// 0.3.
#pragma once

#include "geometry/point.hpp"
#include "host/host.hpp"

#include <abacus/draw.h>

namespace abacus {

/// A point as the plane sees it.
struct Place {
    double at[2];  // its foot on the sheet: to the right, upwards
    double height; // above the sheet, towards the viewer
    int side;      // sign of the height, or 0: on the plane
};

/// A rectangle of the sheet.
struct SheetWindow {
    double lower[2], upper[2];
};

class Plane {
public:
    /// Lengths of places are lengths in the mesh times this, so that no sum of
    /// finite coordinates overflows.
    static constexpr double scale = 0.125;

    /// Throws an Error (argument) if the section names no plane. Directions on the
    /// sheet are as abacus/draw.h says.
    explicit Plane(const abacus_section &section);

    Place place(const Point<3> &p) const;
    /// The point of the plane whose foot is there on the sheet, as near as rounding comes to it.
    Point<3> point(const double (&at)[2]) const;
    /// True if all of the box lies on one side, and no point in it is on the plane.
    bool misses(const Point<3> &lower, const Point<3> &upper) const;
    /// The rectangle of the sheet that just holds its part within the box. Throws an
    /// Error (argument) if there is no such part.
    SheetWindow window(const Point<3> &lower, const Point<3> &upper) const;

private:
    double height(const Point<3> &p) const;
    double tolerance(const Point<3> &p) const;

    Point<3> through_, normal_;
    Point<3> axis_[2]; // of the sheet
};

/// Where the line between two places on opposite sides pierces the plane: the share
/// of the way from the lower to the upper one, which is the same for every caller.
inline double pierced(const Place &below, const Place &above) {
    return below.height / (below.height - above.height);
}

} // namespace abacus
