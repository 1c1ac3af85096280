#include "quake/basin.hpp"

#include <algorithm>
#include <cmath>

namespace abacus {
namespace {

/// A hollow in the rock below an ellipse: its depth is depth * (1 - q)^2, where q grows
/// from 0 at the centre to 1 at the rim with the square of the distance.
struct Hollow {
    double x, y;            ///< centre, metres
    double length, breadth; ///< half axes, metres
    double cosine, sine;    ///< direction of the longer one
    double depth;           ///< metres
};

// Where hollows overlap, their depths add up.
constexpr Hollow hollows[] = {
    {52'000, 45'000, 38'000, 17'000, 0.8, -0.6, 6'500},
    {36'000, 31'000, 24'000, 12'000, 0.96, -0.28, 1'700},
    {68'000, 58'000, 20'000, 13'000, 0.6, 0.8, 1'900},
    {25'000, 76'000, 18'000, 9'000, 0.96, 0.28, 3'600},
    {61'000, 80'000, 19'000, 7'500, 1, 0, 2'300},
    {86'000, 27'000, 12'000, 8'000, 0.28, 0.96, 1'400},
    {12'000, 55'000, 9'000, 5'500, 0.6, -0.8, 700},
};

/// The least square of a * dx + b * dy over ranges of dx and dy.
double least_square(double a, double b, double lower_dx, double upper_dx, double lower_dy,
                    double upper_dy) {
    const double lower =
        (a < 0 ? a * upper_dx : a * lower_dx) + (b < 0 ? b * upper_dy : b * lower_dy);
    const double upper =
        (a < 0 ? a * lower_dx : a * upper_dx) + (b < 0 ? b * lower_dy : b * upper_dy);
    const double least = std::max({lower, -upper, 0.0});
    return least * least;
}

/// Depth of the rock under the sediments; over a box, an upper bound.
double deepest_floor(const Basin::Box &box) {
    double depth = 0;
    for (const Hollow &h : hollows) {
        const double dx0 = box.lower_x - h.x, dx1 = box.upper_x - h.x;
        const double dy0 = box.lower_y - h.y, dy1 = box.upper_y - h.y;
        const double along =
            least_square(h.cosine / h.length, h.sine / h.length, dx0, dx1, dy0, dy1);
        if (along >= 1) continue;
        const double across =
            least_square(-h.sine / h.breadth, h.cosine / h.breadth, dx0, dx1, dy0, dy1);
        const double inside = 1 - (along + across);
        if (inside > 0) depth += h.depth * (inside * inside);
    }
    return depth;
}

/// Shear waves in sediments: faster with the root of the depth (compaction), slower over a
/// deep floor (the middle of a basin is filled with the finest grains).
double sediment_velocity(double depth, double floor) {
    return 200 + 450 * std::max(0.0, 1 - floor / 7'000) + 13 * std::sqrt(depth);
}

/// In rock: weathered above, nearly constant below. Faster than sediments at any depth
/// that they reach.
double rock_velocity(double depth) { return 1'500 + 2'200 * (depth / (depth + 2'000)); }

/// Over a point, or the least over a box.
double shear_velocity(const Basin::Box &box) {
    const double depth = -box.upper_z;
    const double floor = deepest_floor(box);
    return depth < floor ? sediment_velocity(depth, floor) : rock_velocity(depth);
}

} // namespace

double Basin::slowest(const Box &box) { return shear_velocity(box); }

double Basin::slowest() { return slowest({0, width, 0, width, 0}); }

// vp and density of crustal rock from vs: T. M. Brocher, "Empirical relations
// between elastic wavespeeds and density in the Earth's crust", Bulletin of the
// Seismological Society of America 95 (2005), equations 9 and 1 (Nafe and Drake).
Material Basin::material(double x, double y, double z) {
    const double vs = shear_velocity({x, x, y, y, z});
    const double s = vs / 1'000;
    const double p = 0.9409 + s * (2.0947 + s * (-0.8206 + s * (0.2683 - s * 0.0251)));
    const double density =
        p * (1.6612 + p * (-0.4721 + p * (0.0671 + p * (-0.0043 + p * 0.000106))));
    return {vs, p * 1'000, density * 1'000};
}

} // namespace abacus
