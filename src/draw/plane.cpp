#include "draw/plane.hpp"

#include "draw/arithmetic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace abacus {

namespace {

[[noreturn]] void refuse(const char *message) { throw Error(ABACUS_ERROR_ARGUMENT, message); }

Point<3> times(const Point<3> &a, double f) { return {a[0] * f, a[1] * f, a[2] * f}; }

Point<3> of_length_1(const Point<3> &a) { return times(a, 1 / std::sqrt(dot(a, a))); }

/// The part of a direction that lies in the plane.
Point<3> along(const Point<3> &direction, const Point<3> &normal) {
    const double off = dot(direction, normal);
    return of_length_1({direction[0] - off * normal[0], direction[1] - off * normal[1],
                        direction[2] - off * normal[2]});
}

} // namespace

Plane::Plane(const abacus_section &section) {
    double largest = 0;
    for (int i = 0; i < 3; ++i) {
        if (!std::isfinite(section.through[i])) refuse("point of the plane is not finite");
        if (!std::isfinite(section.normal[i])) refuse("normal of the plane is not finite");
        largest = std::max(largest, std::fabs(section.normal[i]));
    }
    if (!(largest > 0)) refuse("normal of the plane is zero");
    if (!std::isfinite(section.exaggeration) || section.exaggeration == 0)
        refuse("exaggeration must be finite and not zero");

    // Scaling by a power of two is exact.
    const int exponent = std::ilogb(largest) + 1;
    for (int i = 0; i < 3; ++i) {
        through_[i] = section.through[i] * scale;
        normal_[i] = std::scalbn(section.normal[i], -exponent);
    }
    const Point<3> n = of_length_1(normal_);
    const bool is_map = std::fabs(n[2]) > std::hypot(n[0], n[1]);
    const Point<3> up = along(is_map ? Point<3>{0, 1, 0} : Point<3>{0, 0, 1}, n);
    const Point<3> right = cross(up, n);
    const double side = right[0] < 0 || (right[0] == 0 && right[1] < 0) ? -1 : 1;
    axis_[0] = times(right, side);
    axis_[1] = times(up, section.exaggeration);
    normal_ = times(normal_, section.exaggeration < 0 ? -side : side);
}

double Plane::height(const Point<3> &p) const {
    return normal_[0] * (p[0] * scale - through_[0]) + normal_[1] * (p[1] * scale - through_[1]) +
           normal_[2] * (p[2] * scale - through_[2]);
}

double Plane::tolerance(const Point<3> &p) const {
    double sum = 0;
    for (int i = 0; i < 3; ++i)
        sum += std::fabs(normal_[i]) * (std::fabs(p[i] * scale) + std::fabs(through_[i]));
    return 4 * std::numeric_limits<double>::epsilon() * sum;
}

Place Plane::place(const Point<3> &p) const {
    const Point<3> q = times(p, scale);
    const double h = height(p);
    const bool is_on = std::fabs(h) <= tolerance(p);
    return {{finite(dot(axis_[0], q)), finite(dot(axis_[1], q))}, h, is_on ? 0 : h < 0 ? -1 : 1};
}

Point<3> Plane::point(const double (&at)[2]) const {
    // The three directions are at right angles to each other; only the first has length 1.
    const double right = at[0];
    const double up = at[1] / dot(axis_[1], axis_[1]);
    const double out = dot(normal_, through_) / dot(normal_, normal_);
    Point<3> p;
    for (int i = 0; i < 3; ++i)
        p[i] = finite((axis_[0][i] * right + axis_[1][i] * up + normal_[i] * out) / scale);
    return p;
}

bool Plane::misses(const Point<3> &lower, const Point<3> &upper) const {
    Point<3> lowest, highest, farthest;
    for (int i = 0; i < 3; ++i) {
        lowest[i] = normal_[i] < 0 ? upper[i] : lower[i];
        highest[i] = normal_[i] < 0 ? lower[i] : upper[i];
        farthest[i] = std::max(std::fabs(lower[i]), std::fabs(upper[i]));
    }
    // Rounding is monotonic: no point between the two has a height beyond theirs.
    const double slack = tolerance(farthest);
    return height(lowest) > slack || height(highest) < -slack;
}

SheetWindow Plane::window(const Point<3> &lower, const Point<3> &upper) const {
    for (int i = 0; i < 3; ++i)
        if (!std::isfinite(lower[i]) || !std::isfinite(upper[i])) refuse("window is not finite");
    Place corner[8];
    for (int i = 0; i < 8; ++i)
        corner[i] = place({i & 1 ? upper[0] : lower[0], i & 2 ? upper[1] : lower[1],
                           i & 4 ? upper[2] : lower[2]});
    SheetWindow window;
    for (int axis = 0; axis < 2; ++axis) {
        double &low = window.lower[axis] = std::numeric_limits<double>::infinity();
        double &high = window.upper[axis] = -low;
        const auto include = [&](double at) {
            low = std::min(low, at);
            high = std::max(high, at);
        };
        for (int i = 0; i < 8; ++i) {
            if (corner[i].side == 0) include(corner[i].at[axis]);
            for (int step = 1; step < 8; step *= 2) {
                const Place &p = corner[i], &q = corner[i ^ step];
                if (p.side < 0 && q.side > 0)
                    include(std::lerp(p.at[axis], q.at[axis], pierced(p, q)));
            }
        }
        if (!(low < high)) refuse("the plane does not meet the window");
    }
    return window;
}

} // namespace abacus
