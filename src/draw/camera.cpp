#include "draw/camera.hpp"

#include "draw/arithmetic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace abacus {

namespace {

[[noreturn]] void refuse(const char *message, const char *hint) {
    throw Error(ABACUS_ERROR_ARGUMENT, message, {}, hint);
}

/// The unit vector in a direction; 0 for a vector without length.
Point<3> unit(Point<3> a) {
    const double largest = std::max({std::fabs(a[0]), std::fabs(a[1]), std::fabs(a[2])});
    if (!(largest > 0)) return {};
    const int exponent = std::ilogb(largest);
    for (double &x : a) x = std::scalbn(x, -exponent);
    const double length = std::sqrt(dot(a, a));
    return {a[0] / length, a[1] / length, a[2] / length};
}

/// Half the way from one point to another, which does not overflow.
Point<3> half_way(const Point<3> &from, const Point<3> &to) {
    return {to[0] * 0.5 - from[0] * 0.5, to[1] * 0.5 - from[1] * 0.5, to[2] * 0.5 - from[2] * 0.5};
}

Point<3> point_of(const double (&p)[3]) { return {p[0], p[1], p[2]}; }

Point<3> middle_of(const Box<3> &box) {
    Point<3> middle;
    for (int i = 0; i < 3; ++i) middle[i] = box.lower[i] * 0.5 + box.upper[i] * 0.5;
    return middle;
}

/// An eye in a direction from a point, so far away that a ball around the scene fills the picture.
Point<3> far_enough(const Box<3> &scene, const Point<3> &toward, const Point<3> &direction,
                    double field_of_view) {
    const Point<3> radius = half_way(scene.lower, scene.upper);
    const double ball = std::sqrt(3.0) * std::max({radius[0], radius[1], radius[2]});
    const double distance = ball / std::sin(field_of_view * (M_PI / 360));
    Point<3> eye;
    for (int i = 0; i < 3; ++i) {
        eye[i] = toward[i] + direction[i] * distance;
        if (!std::isfinite(eye[i]))
            refuse("the eye is too far away", "Say where it is with the argument eye.");
    }
    return eye;
}

// Nothing nearer to the eye than this share of the way to the farthest point is drawn: it would
// appear a million times larger.
constexpr double nearest_part = 1e-6;
constexpr Point<3> from_south_west{-1, -2, 1};
constexpr double shape_of_perspective = 0.75; // height to width
// Beyond this, places are not exact, but they are not in the picture either.
constexpr double farthest_place = 0x1p58;

std::int64_t place(double x) {
    return static_cast<std::int64_t>(
        std::floor(std::fmin(std::fmax(x, -farthest_place), farthest_place) + 0.5));
}

} // namespace

Camera::Camera(const abacus_camera &camera, const abacus_drawing &drawing, const Box<3> &scene)
    : has_perspective_(camera.field_of_view > 0), width_(drawing.width), height_(drawing.height),
      nearest_(-std::numeric_limits<double>::infinity()) {
    if (!(camera.field_of_view >= 0 && camera.field_of_view < 180))
        refuse("field_of_view must be at least 0 and below 180 degrees",
               "Leave it out for parallel rays.");
    for (int i = 0; i < 3; ++i)
        if ((camera.has_eye && !std::isfinite(camera.eye[i])) ||
            (camera.has_toward && !std::isfinite(camera.toward[i])) ||
            (camera.has_up && !std::isfinite(camera.up[i])))
            refuse("the camera is not finite", "Give finite coordinates.");
    const Point<3> middle = middle_of(scene);
    const Point<3> toward = camera.has_toward ? point_of(camera.toward) : middle;
    Point<3> eye = point_of(camera.eye), ahead = unit(half_way(eye, toward));
    if (!camera.has_eye) {
        const Point<3> from = unit(from_south_west);
        ahead = {-from[0], -from[1], -from[2]};
        if (has_perspective_) eye = far_enough(scene, toward, from, camera.field_of_view);
    }
    set_directions(camera, ahead);
    origin_ = has_perspective_ ? eye : middle;
    // The unit is such that the farthest corner of the scene is at a distance of about 1.
    double farthest = 0;
    for (int i = 0; i < 3; ++i)
        farthest = std::max({farthest, std::fabs(scene.lower[i] * 0.5 - origin_[i] * 0.5),
                             std::fabs(scene.upper[i] * 0.5 - origin_[i] * 0.5)});
    unit_ = std::ldexp(1.0, std::clamp(farthest > 0 ? std::ilogb(farthest) + 2 : 0, -1074, 1023));
    if (!has_perspective_) return;
    nearest_ = nearest_part;
    if (height_ == 0) height_ = height_of_shape(width_, shape_of_perspective);
    scale_ = height_ * 0.5 / std::tan(camera.field_of_view * (M_PI / 360));
}

void Camera::set_directions(const abacus_camera &camera, const Point<3> &ahead) {
    if (dot(ahead, ahead) == 0)
        refuse("eye and toward are the same point", "Give two different points.");
    Point<3> up = camera.has_up ? unit(point_of(camera.up)) : Point<3>{0, 0, 1};
    constexpr double parallel = 1e-9;
    const auto is_along = [&](const Point<3> &v) {
        const Point<3> side = cross(ahead, v);
        return dot(side, side) < parallel * parallel;
    };
    if (is_along(up)) {
        if (camera.has_up)
            refuse("up is zero, or along the line of sight", "Give a direction across that line.");
        up = {0, 1, 0};
    }
    const Point<3> right = unit(cross(ahead, up));
    axis_ = {right, cross(ahead, right), ahead};
}

double Camera::from_origin(double x, int axis) const {
    const double way = x - origin_[axis];
    if (std::isfinite(way)) [[likely]]
        return way / unit_;
    return (x * 0.5 - origin_[axis] * 0.5) / unit_ * 2;
}

Point<3> Camera::look(const Point<3> &p) const {
    Point<3> way;
    for (int i = 0; i < 3; ++i) way[i] = from_origin(p[i], i);
    return {dot(axis_[0], way), dot(axis_[1], way), dot(axis_[2], way)};
}

Point<2> Camera::place(const Point<3> &p) const {
    const Point<3> seen = look(p);
    return {seen[0], seen[1]};
}

void Camera::fit(const Box<2> &around) {
    double extent[2] = {1, 1};
    for (int axis = 0; axis < 2; ++axis) {
        if (!(around.lower[axis] < around.upper[axis])) continue;
        middle_[axis] = around.lower[axis] * 0.5 + around.upper[axis] * 0.5;
        extent[axis] = around.upper[axis] - around.lower[axis];
    }
    if (height_ == 0) height_ = height_of_shape(width_, extent[1] / extent[0]);
    scale_ = std::min(width_ / extent[0], height_ / extent[1]);
}

Sight Camera::sight(const Point<3> &seen, double value) const {
    Sight sight{seen, value, 0, 0, 1};
    if (has_perspective_) {
        if (!(seen[2] >= nearest_)) return sight;
        sight.weight = 1 / seen[2];
    }
    const double x = (seen[0] * sight.weight - middle_[0]) * scale_ + width_ * 0.5;
    const double y = (seen[1] * sight.weight - middle_[1]) * scale_ + height_ * 0.5;
    sight.x = abacus::place(x * steps);
    sight.y = abacus::place(y * steps);
    return sight;
}

Point<2> Camera::ray(std::int32_t x, std::int32_t y) const {
    return {(x + 0.5 - width_ * 0.5) / scale_ + middle_[0],
            (y + 0.5 - height_ * 0.5) / scale_ + middle_[1]};
}

double Camera::length(std::int32_t x, std::int32_t y) const {
    if (!has_perspective_) return unit_;
    const Point<2> at = ray(x, y);
    return unit_ * std::sqrt(1 + at[0] * at[0] + at[1] * at[1]);
}

std::pair<double, double> Camera::depths_within(const Box<3> &box, std::int32_t x,
                                                std::int32_t y) const {
    const Point<2> at = ray(x, y);
    double from = nearest_, to = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        // On this axis the ray is at begin + depth * step.
        const double aside = axis_[0][i] * at[0] + axis_[1][i] * at[1];
        const double begin = has_perspective_ ? 0 : aside;
        const double step = has_perspective_ ? axis_[2][i] + aside : axis_[2][i];
        double enters = from_origin(box.lower[i], i) - begin;
        double leaves = from_origin(box.upper[i], i) - begin;
        if (step == 0) {
            if (enters > 0 || leaves < 0) return {1, 0};
            continue;
        }
        if (step < 0) std::swap(enters, leaves);
        from = std::max(from, enters / step);
        to = std::min(to, leaves / step);
    }
    return from <= to ? std::pair(from, to) : std::pair(1.0, 0.0);
}

} // namespace abacus
