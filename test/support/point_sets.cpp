#include "support/point_sets.hpp"

#include <cmath>
#include <set>

namespace abacus::test {
namespace {

template <class Make> auto make(int n, Make point) {
    std::vector<decltype(point(0))> points;
    for (int i = 0; i < n; ++i) points.push_back(point(i));
    return points;
}

std::vector<Point<3>> integer_points_of_a_sphere(int radius) {
    std::vector<Point<3>> points;
    for (int x = -radius; x <= radius; ++x)
        for (int y = -radius; y <= radius; ++y)
            for (int z = -radius; z <= radius; ++z)
                if (x * x + y * y + z * z == radius * radius)
                    points.push_back({x + 0.0, y + 0.0, z + 0.0});
    return points;
}

/// Corners of the octants of an octree that is refined towards a bent surface.
std::vector<Point<3>> octree_corners() {
    std::set<Point<3>> corners;
    const std::function<void(Point<3>, double, int)> visit = [&](Point<3> at, double edge,
                                                                 int level) {
        const double height = 10 + 5 * std::sin(at[0] / 7) * std::cos(at[1] / 9);
        if (level < 5 && std::fabs(at[2] + edge / 2 - height) < edge) {
            for (int i = 0; i < 8; ++i)
                visit({at[0] + (i & 1) * edge / 2, at[1] + (i >> 1 & 1) * edge / 2,
                       at[2] + (i >> 2) * edge / 2},
                      edge / 2, level + 1);
            return;
        }
        for (int i = 0; i < 8; ++i)
            corners.insert(
                {at[0] + (i & 1) * edge, at[1] + (i >> 1 & 1) * edge, at[2] + (i >> 2) * edge});
    };
    visit({0, 0, 0}, 32, 0);
    return {corners.begin(), corners.end()};
}

} // namespace

template <> const std::vector<PointSet<2>> &point_sets<2>() {
    using Points = std::vector<Point<2>>;
    static const std::vector<PointSet<2>> sets = {
        {"uniform",
         [](Random &r) { return make(20000, [&](int) {
                             return Point<2>{unit(r), unit(r)};
                         }); }},
        {"grid",
         [](Random &) {
             return make(120 * 120, [](int i) { return Point<2>{i % 120 + 0.0, i / 120 + 0.0}; });
         }},
        {"negative_grid_with_duplicates",
         [](Random &r) {
             return make(9000, [&](int) {
                 return Point<2>{std::floor(unit(r) * 60) - 30, std::floor(unit(r) * 60) - 30};
             });
         }},
        {"circle_and_centre",
         [](Random &r) {
             Points points = make(4000, [&](int) {
                 const double angle = 6.283185307179586 * unit(r);
                 return Point<2>{std::cos(angle), std::sin(angle)};
             });
             points.push_back({0, 0});
             return points;
         }},
        {"exactly_cocircular", // integer points on one circle
         [](Random &) {
             constexpr int radius = 5 * 13 * 17 * 29;
             Points points;
             for (int x = -radius; x <= radius; ++x) {
                 const double y = std::sqrt(double(radius) * radius - double(x) * x);
                 if (y == std::floor(y)) {
                     points.push_back({x + 0.0, y});
                     if (y > 0) points.push_back({x + 0.0, -y});
                 }
             }
             return points;
         }},
        {"lines",
         [](Random &r) {
             return make(3000, [&](int i) {
                 const double t = unit(r) * 1000;
                 return i % 3 == 0 ? Point<2>{t, 0} : i % 3 == 1 ? Point<2>{t, t} : Point<2>{7, t};
             });
         }},
        {"clusters_below_the_code",
         [](Random &r) {
             return make(8000, [&](int i) {
                 return Point<2>{i % 5 * 0.2 + unit(r) * 1e-12, i % 3 * 0.3 + unit(r) * 1e-12};
             });
         }},
        {"cluster_at_zero",
         [](Random &r) {
             Points points = make(3000, [&](int) {
                 return Point<2>{(unit(r) - 0.5) * 1e-30, (unit(r) - 0.5) * 1e-30};
             });
             for (const double x : {-1.0, 1.0})
                 for (const double y : {-1.0, 1.0}) points.push_back({x, y});
             return points;
         }},
        {"exponents",
         [](Random &r) {
             const auto any = [&] { return std::ldexp(unit(r) - 0.5, int(r() % 1990) - 995); };
             return make(1000, [&](int) { return Point<2>{any(), any()}; });
         }},
        {"largest_doubles",
         [](Random &r) {
             return make(800, [&](int) {
                 return Point<2>{(2 * unit(r) - 1) * 1.7e308, (2 * unit(r) - 1) * 1.7e308};
             });
         }},
        {"denormals",
         [](Random &r) {
             return make(800, [&](int) {
                 return Point<2>{5e-324 * std::floor(unit(r) * 100),
                                 5e-324 * std::floor(unit(r) * 100)};
             });
         }},
    };
    return sets;
}

template <> const std::vector<PointSet<3>> &point_sets<3>() {
    using Points = std::vector<Point<3>>;
    static const std::vector<PointSet<3>> sets = {
        {"uniform",
         [](Random &r) {
             return make(6000, [&](int) { return Point<3>{unit(r), unit(r), unit(r)}; });
         }},
        {"grid",
         [](Random &) {
             return make(12 * 12 * 12, [](int i) {
                 return Point<3>{i % 12 + 0.0, i / 12 % 12 + 0.0, i / 144 + 0.0};
             });
         }},
        {"negative_grid_with_duplicates",
         [](Random &r) {
             const auto any = [&] { return std::floor(unit(r) * 14) - 7; };
             return make(4000, [&](int) { return Point<3>{any(), any(), any()}; });
         }},
        {"octree_corners", [](Random &) { return octree_corners(); }},
        {"integer_points_of_a_sphere", [](Random &) { return integer_points_of_a_sphere(45); }},
        {"integer_points_of_a_sphere_and_its_centre",
         [](Random &) {
             Points points = integer_points_of_a_sphere(35);
             points.push_back({0, 0, 0});
             return points;
         }},
        {"sphere", // nearly cospherical
         [](Random &r) {
             return make(1500, [&](int) {
                 const double z = 2 * unit(r) - 1, angle = 6.283185307179586 * unit(r);
                 const double radius = std::sqrt(1 - z * z);
                 return Point<3>{radius * std::cos(angle), radius * std::sin(angle), z};
             });
         }},
        {"cone", // an apex with every facet of the hull
         [](Random &r) {
             Points points = make(800, [&](int) {
                 const double angle = 6.283185307179586 * unit(r);
                 return Point<3>{std::cos(angle), std::sin(angle), 0};
             });
             points.push_back({0, 0, 1});
             return points;
         }},
        {"skew_lines",
         [](Random &r) {
             return make(200, [&](int i) {
                 const double t = unit(r);
                 return i % 2 == 0 ? Point<3>{t, 0, 0} : Point<3>{0.3, t, 1};
             });
         }},
        {"lines_and_planes",
         [](Random &r) {
             return make(1500, [&](int i) {
                 const double s = std::floor(unit(r) * 40), t = std::floor(unit(r) * 40);
                 return i % 3 == 0   ? Point<3>{s, t, 0}
                        : i % 3 == 1 ? Point<3>{s, s, t}
                                     : Point<3>{7, 5, t};
             });
         }},
        {"clusters_below_the_code",
         [](Random &r) {
             return make(2000, [&](int i) {
                 return Point<3>{i % 5 * 0.2 + unit(r) * 1e-12, i % 3 * 0.3 + unit(r) * 1e-12,
                                 i % 7 * 0.1 + unit(r) * 1e-12};
             });
         }},
        {"cluster_at_zero",
         [](Random &r) {
             const auto any = [&] { return (unit(r) - 0.5) * 1e-30; };
             Points points = make(1500, [&](int) { return Point<3>{any(), any(), any()}; });
             for (int i = 0; i < 8; ++i)
                 points.push_back({(i & 1) * 2 - 1.0, (i >> 1 & 1) * 2 - 1.0, (i >> 2) * 2 - 1.0});
             return points;
         }},
        {"exponents",
         [](Random &r) {
             const auto any = [&] { return std::ldexp(unit(r) - 0.5, int(r() % 1990) - 995); };
             return make(300, [&](int) { return Point<3>{any(), any(), any()}; });
         }},
        {"largest_doubles",
         [](Random &r) {
             const auto any = [&] { return (2 * unit(r) - 1) * 1.7e308; };
             return make(300, [&](int) { return Point<3>{any(), any(), any()}; });
         }},
        {"denormals",
         [](Random &r) {
             const auto any = [&] { return 5e-324 * std::floor(unit(r) * 20); };
             return make(500, [&](int) { return Point<3>{any(), any(), any()}; });
         }},
        {"coplanar",
         [](Random &r) { return make(200, [&](int) {
                             return Point<3>{unit(r), unit(r), 0};
                         }); }},
    };
    return sets;
}

} // namespace abacus::test
