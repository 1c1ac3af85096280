// From where a mesh in space is seen: vertices as the eye sees them, and their places in the
// picture.
//
// Places are whole numbers of a fraction of a pixel. So whether the centre of a pixel is on one
// side of a line between two of them or on the other is exact, and all who share the line agree.
//
// What is linear in space is not so in a picture with perspective: what is, is the inverse of the
// depth, and what is linear in space divided by the depth. So each place has a weight, the inverse
// of its depth, by which it counts between others; with parallel rays it is 1.
#pragma once

#include "draw/frame.hpp"
#include "geometry/box.hpp"

#include <abacus/raycast.h>
#include <cstdint>
#include <utility>

namespace abacus {

/// A vertex as the eye sees it.
struct Sight {
    Point<3> seen; // to the right, downwards, ahead
    double value;
    // Only where it is ahead of the eye:
    std::int64_t x, y; // in steps of a pixel
    double weight;
};

class Camera {
public:
    static constexpr std::int64_t steps = 256; // of a pixel

    /// `scene` is what there is to be seen. Throws an Error (argument) if the camera sees nothing,
    /// or the drawing makes no picture.
    Camera(const abacus_camera &camera, const abacus_drawing &drawing, const Box<3> &scene);

    /// With parallel rays, fit() must be called before anything is seen.
    bool has_parallel_rays() const { return !has_perspective_; }
    /// A point to the right and downwards, in any picture.
    Point<2> place(const Point<3> &p) const;
    /// The picture just holds what is placed there. Its height, if it is not given, is as the shape
    /// tells, from an eighth of the width to eight times.
    void fit(const Box<2> &around);

    std::int32_t width() const { return width_; }
    std::int32_t height() const { return height_; }

    Sight see(const Point<3> &p, double value) const { return sight(look(p), value); }
    /// Of a point already looked at.
    Sight sight(const Point<3> &seen, double value) const;
    /// What is less far ahead is not seen.
    double nearest() const { return nearest_; }
    /// Length in the mesh of a step ahead along the ray of a pixel.
    double length(std::int32_t x, std::int32_t y) const;
    /// From how far ahead to how far the ray of a pixel is in a box; empty: [1, 0].
    std::pair<double, double> depths_within(const Box<3> &box, std::int32_t x,
                                            std::int32_t y) const;

private:
    Point<3> look(const Point<3> &p) const;
    double from_origin(double x, int axis) const;
    /// To the right and downwards at depth 1, or at any with parallel rays.
    Point<2> ray(std::int32_t x, std::int32_t y) const;
    void set_directions(const abacus_camera &camera, const Point<3> &ahead);

    bool has_perspective_;
    std::int32_t width_, height_;
    Point<3> origin_;              // the eye; with parallel rays the middle of the scene
    std::array<Point<3>, 3> axis_; // right, down, ahead; of length 1
    double unit_ = 1;              // length in the mesh of what is seen as 1, a power of two
    double nearest_;
    double scale_ = 1;  // pixels
    Point<2> middle_{}; // what is in the middle of the picture
};

} // namespace abacus
