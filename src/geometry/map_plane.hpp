// The plane of a map: that of the mesh's coordinates, or Web Mercator where they are longitude and
// latitude in degrees.
//
// Web Mercator is measured in degrees too: x is the longitude, and y grows so that a degree is as
// long upwards as it is to the right. So only latitudes change, and they keep their order: what is
// within a box in the mesh is within a box in the plane.
#pragma once

#include "geometry/box.hpp"
#include "host/error.hpp"

#include <cmath>
#include <numbers>

namespace abacus {

class MapPlane {
public:
    explicit MapPlane(bool is_geographic) : is_geographic_(is_geographic) {}

    bool is_geographic() const { return is_geographic_; }
    /// Throws an Error (argument) if p is no place on the globe.
    Point<2> project(const Point<2> &p) const {
        if (!is_geographic_) return p;
        if (!(std::fabs(p[1]) <= 90)) throw_no_latitude(p);
        return {p[0], mercator(p[1])};
    }
    Point<2> unproject(const Point<2> &p) const {
        return is_geographic_ ? Point<2>{p[0], latitude(p[1])} : p;
    }
    Box<2> unproject(const Box<2> &box) const {
        return {unproject(box.lower), unproject(box.upper)};
    }

    /// Poles are far away, but not infinitely.
    static double mercator(double latitude) {
        constexpr double last = 89.9999;
        const double bounded = std::fmin(std::fmax(latitude, -last), last);
        return std::asinh(std::tan(bounded / degrees)) * degrees;
    }
    static double latitude(double y) { return std::atan(std::sinh(y / degrees)) * degrees; }

private:
    static constexpr double degrees = 180 / std::numbers::pi;

    [[noreturn]] static void throw_no_latitude(const Point<2> &p) {
        throw Error(ABACUS_ERROR_ARGUMENT, "the mesh is not in longitude and latitude",
                    "A vertex has the latitude " + std::to_string(p[1]) + ".",
                    "Give srid => 3857 if its coordinates are in Web Mercator, or world for a map "
                    "of its own.");
    }

    bool is_geographic_;
};

} // namespace abacus
