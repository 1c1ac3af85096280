// Where places of a tile lie in space, in metres: on the globe from its centre (ECEF), or over a
// plane whose coordinates are metres themselves.
#pragma once

#include "geometry/map_plane.hpp"

#include <abacus/tile.h>

namespace abacus {

inline constexpr double radians_a_degree = std::numbers::pi / 180;

/// The ellipsoid of WGS 84.
inline constexpr double equator_radius = 6378137, pole_radius = 6356752.3142451793;

inline double dot(const Point<3> &a, const Point<3> &b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Point<3> cross(const Point<3> &a, const Point<3> &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Point<3> difference(const Point<3> &a, const Point<3> &b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
/// Of length 1; (0, 0, 0) if it has no direction.
inline Point<3> direction_of(const Point<3> &v) {
    const double length = std::hypot(v[0], v[1], v[2]);
    if (!(length > 0) || !std::isfinite(length)) return {0, 0, 0};
    return {v[0] / length, v[1] / length, v[2] / length};
}

/// Perpendicular to the ways from a to b and from c to d, as long as their parallelogram is large.
/// Finite, even where products of doubles are not.
inline Point<3> normal_of(const Point<3> &a, const Point<3> &b, const Point<3> &c,
                          const Point<3> &d) {
    const auto is_finite = [](const Point<3> &v) {
        return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
    };
    const Point<3> normal = cross(difference(b, a), difference(d, c));
    if (is_finite(normal)) return normal;
    const auto small = [](const Point<3> &p) {
        return Point<3>{std::ldexp(p[0], -600), std::ldexp(p[1], -600), std::ldexp(p[2], -600)};
    };
    return cross(difference(small(b), small(a)), difference(small(d), small(c)));
}

class TileFrame {
public:
    explicit TileFrame(abacus_tile_plane plane) : plane_(plane) {}

    bool is_on_globe() const { return plane_ != ABACUS_TILE_OWN; }
    /// Throws an Error (argument) if p is no place on the globe.
    void require_place(const Point<2> &p) const {
        if (plane_ == ABACUS_TILE_DEGREES && !(std::fabs(p[1]) <= 90)) MapPlane(true).project(p);
    }
    /// Longitude and latitude in degrees of a place of the mesh, on the globe.
    Point<2> degrees(const Point<2> &p) const {
        if (plane_ == ABACUS_TILE_DEGREES) return p;
        return {p[0] / equator_radius / radians_a_degree,
                std::atan(std::sinh(p[1] / equator_radius)) / radians_a_degree};
    }
    Point<3> place(const Point<2> &p, double height) const {
        return is_on_globe() ? on_globe(degrees(p), height) : Point<3>{p[0], p[1], height};
    }
    static Point<3> on_globe(const Point<2> &degrees, double height) {
        constexpr double ratio = (pole_radius / equator_radius) * (pole_radius / equator_radius);
        const double longitude = degrees[0] * radians_a_degree;
        const double latitude = degrees[1] * radians_a_degree;
        const double sine = std::sin(latitude), cosine = std::cos(latitude);
        const double across = equator_radius / std::sqrt(1 - (1 - ratio) * sine * sine);
        return {(across + height) * cosine * std::cos(longitude),
                (across + height) * cosine * std::sin(longitude), (across * ratio + height) * sine};
    }
    /// East, north and up at a place.
    std::array<Point<3>, 3> axes(const Point<2> &p) const {
        if (!is_on_globe()) return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        const Point<2> at = degrees(p);
        const double longitude = at[0] * radians_a_degree, latitude = at[1] * radians_a_degree;
        const Point<3> east{-std::sin(longitude), std::cos(longitude), 0};
        const Point<3> up{std::cos(latitude) * std::cos(longitude),
                          std::cos(latitude) * std::sin(longitude), std::sin(latitude)};
        return {east, cross(up, east), up};
    }

private:
    abacus_tile_plane plane_;
};

} // namespace abacus
