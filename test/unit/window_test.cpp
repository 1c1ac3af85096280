// Windows of a mesh: balls compared with rational arithmetic, and simplices of boxes and balls
// compared with brute force over all.
#include "geometry/ball.hpp"
#include "query/locate/reader.hpp"
#include "query/scan/cell_scan.hpp"
#include "support/extents.hpp"
#include "support/point_sets.hpp"
#include "support/triangulations.hpp"

#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/squared_distance_2.h>
#include <CGAL/squared_distance_3.h>

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace abacus::test {
namespace {

using Rational = CGAL::Exact_rational;
using Kernel = CGAL::Simple_cartesian<Rational>;

Kernel::Point_2 cgal(const Point<2> &p) { return {p[0], p[1]}; }
Kernel::Point_3 cgal(const Point<3> &p) { return {p[0], p[1], p[2]}; }

bool cgal_meets(const Corners<2> &c, const Ball<2> &ball) {
    const Kernel::Point_2 center = cgal(ball.center);
    if (!Kernel::Triangle_2(cgal(*c[0]), cgal(*c[1]), cgal(*c[2])).has_on_unbounded_side(center))
        return true;
    const Rational radius = ball.radius;
    for (int i = 0; i < 3; ++i) {
        const Kernel::Segment_2 edge(cgal(*c[i]), cgal(*c[(i + 1) % 3]));
        if (CGAL::squared_distance(center, edge) <= radius * radius) return true;
    }
    return false;
}

bool cgal_meets(const Corners<3> &c, const Ball<3> &ball) {
    const Kernel::Point_3 center = cgal(ball.center);
    if (!Kernel::Tetrahedron_3(cgal(*c[0]), cgal(*c[1]), cgal(*c[2]), cgal(*c[3]))
             .has_on_unbounded_side(center))
        return true;
    const Rational radius = ball.radius;
    for (int i = 0; i < 4; ++i) {
        const Kernel::Triangle_3 facet(cgal(*c[(i + 1) % 4]), cgal(*c[(i + 2) % 4]),
                                       cgal(*c[(i + 3) % 4]));
        if (CGAL::squared_distance(center, facet) <= radius * radius) return true;
    }
    return false;
}

template <int D> void compare_balls(double unit, unsigned seed) {
    Random random(seed);
    const auto any = [&] {
        Point<D> p;
        for (double &x : p) x = static_cast<double>(random() % 12) * unit;
        return p;
    };
    int met = 0, touched = 0;
    for (int round = 0; round < 2000;) {
        std::array<Point<D>, D + 1> at;
        Corners<D> corners;
        for (int i = 0; i <= D; ++i) {
            at[i] = any();
            corners[i] = &at[i];
        }
        const int turned = orientation<D>(corners);
        if (turned == 0) continue;
        if (turned < 0) std::swap(corners[0], corners[1]);
        ++round;
        const Ball<D> ball{any(), static_cast<double>(random() % 6) * unit};
        const bool expected = cgal_meets(corners, ball);
        ASSERT_EQ(meets<D>(corners, ball), expected)
            << testing::PrintToString(at) << testing::PrintToString(ball.center) << ball.radius;
        met += expected;
        Rational square = 0;
        for (int i = 0; i < D; ++i)
            square += (Rational(at[0][i]) - Rational(ball.center[i])) *
                      (Rational(at[0][i]) - Rational(ball.center[i]));
        const Rational most = Rational(ball.radius) * Rational(ball.radius);
        ASSERT_EQ(ball.contains(at[0]), square <= most);
        touched += square == most;
    }
    EXPECT_GT(met, 300);
    EXPECT_LT(met, 1900);
    if (std::scalbn(1.0, std::ilogb(unit)) == unit) { // everything is an integer in one unit
        EXPECT_GT(touched, 5);
    }
}

TEST(Ball, MeetsWhatItMeetsInRationalArithmetic) {
    for (const double unit : {1.0, 0.1, 0x1p-1074, 1e300}) {
        compare_balls<2>(unit, 1);
        compare_balls<3>(unit, 2);
    }
}

template <int D> Positions<D> places(const abacus_simplex &s) {
    Positions<D> at;
    for (int i = 0; i <= D; ++i) std::copy_n(s.corner[i], D, at[i].begin());
    return at;
}

template <int D>
std::multiset<Positions<D>> read(MeshOf<D> &mesh, const abacus_window &window, double max_edge) {
    const Host host = mesh.host.host();
    CellScan<D> scan(host, mesh.header, window, up_to(max_edge));
    std::multiset<Positions<D>> found;
    abacus_simplex simplex;
    while (scan.next(simplex, nullptr)) found.insert(places<D>(simplex));
    return found;
}

template <int D>
std::multiset<Positions<D>> expected(MeshOf<D> &mesh, const abacus_window &window,
                                     double max_edge) {
    std::multiset<Positions<D>> result;
    for (const abacus_simplex &s : mesh.simplices(false)) {
        const Positions<D> at = places<D>(s);
        Corners<D> corners;
        for (int i = 0; i <= D; ++i) corners[i] = &at[i];
        bool is_wanted = Window<D>(window).meets(corners);
        for (int i = 0; max_edge > 0 && i < D; ++i)
            for (int j = i + 1; j <= D; ++j)
                is_wanted = is_wanted && distance<D>(at[i], at[j]) <= max_edge;
        if (is_wanted) result.insert(at);
    }
    return result;
}

template <int D> void expect_windows(MeshOf<D> &mesh, const std::vector<Point<D>> &points) {
    Random random(3);
    for (int i = 0; i < 60; ++i) {
        const Point<D> &a = points[random() % points.size()], &b = points[random() % points.size()];
        abacus_window window{};
        window.kind = i % 3 == 0   ? ABACUS_NO_WINDOW
                      : i % 3 == 1 ? ABACUS_BOX_WINDOW
                                   : ABACUS_BALL_WINDOW;
        const double stretch = i % 4 == 0 ? 5 : 1; // some are outside
        for (int k = 0; k < D; ++k) {
            window.lower[k] = std::min(a[k], b[k]) * stretch;
            window.upper[k] = std::max(a[k], b[k]) * stretch;
            window.center[k] = a[k] * stretch;
        }
        window.radius = i % 5 == 0 ? 0 : distance<D>(a, b) * unit(random);
        const double max_edge = i % 2 == 0 ? 0 : distance<D>(a, b) * 0.3;
        EXPECT_TRUE(read<D>(mesh, window, max_edge) == expected<D>(mesh, window, max_edge)) << i;
    }
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
    EXPECT_EQ(mesh.host.bytes, 0u);
}

template <int D> std::vector<Point<D>> uniform(int n, unsigned seed) {
    Random random(seed);
    std::vector<Point<D>> points(static_cast<std::size_t>(n));
    for (auto &p : points)
        for (double &x : p) x = unit(random);
    return points;
}

template <int D> void expect_windows_of_meshes() {
    const auto points = uniform<D>(D == 2 ? 4000 : 1500, 4);
    MeshOf<D> mesh(0);
    ASSERT_EQ(mesh.stage(number<D>(points)), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    expect_windows<D>(mesh, points);
    auto t =
        keeping<D>(delaunay<D>(points), [](const Point<D> &c) { return c[0] < 0.4 || c[1] > 0.6; });
    MeshOf<D> loaded(0);
    ASSERT_EQ(loaded.load(t.vertices, t.simplices), ABACUS_OK) << loaded.error.message;
    expect_windows<D>(loaded, points);
    MeshOf<D> empty(0);
    EXPECT_TRUE(read<D>(empty, {}, 0).empty());
}

TEST(Window, HasTheSimplicesThatMeetIt) {
    expect_windows_of_meshes<2>();
    expect_windows_of_meshes<3>();
}

/// Small windows that lie beside, among others, the long simplices along a slanted side of the
/// hull.
template <int D> void expect_bounds(MeshOf<D> &mesh, int rounds) {
    Random random(6);
    const auto all = mesh.simplices(false);
    std::size_t passed_by = 0;
    for (int i = 0; i < rounds; ++i) {
        abacus_window window{}, box{};
        window.kind = ABACUS_BOUNDS_WINDOW;
        Box<D> wanted;
        for (int k = 0; k < D; ++k) {
            wanted.lower[k] = window.lower[k] = unit(random) * 1.2 - 0.1;
            wanted.upper[k] = window.upper[k] = window.lower[k] + unit(random) * 0.02;
        }
        box = window;
        box.kind = ABACUS_BOX_WINDOW;
        std::multiset<Positions<D>> expected;
        for (const abacus_simplex &s : all) {
            const Positions<D> at = places<D>(s);
            Box<D> around;
            for (const Point<D> &p : at) around.extend(p);
            if (around.meets(wanted)) expected.insert(at);
        }
        EXPECT_TRUE(read<D>(mesh, window, 0) == expected) << i;
        passed_by += expected.size() - read<D>(mesh, box, 0).size();
    }
    EXPECT_GT(passed_by, 15u);
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
}

template <int D> void expect_bounds_of_meshes() {
    auto points = uniform<D>(D == 2 ? 6000 : 2000, 7);
    for (Point<D> &p : points) // the half below a slanted plane, denser and denser near a corner
        if (p[0] < p[1]) std::swap(p[0], p[1]);
    for (std::size_t i = 0; i < points.size(); i += 2)
        for (int k = 1; k < D; ++k) points[i][k] *= points[i][k] * points[i][k];
    MeshOf<D> mesh(0);
    ASSERT_EQ(mesh.stage(number<D>(points)), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    expect_bounds<D>(mesh, 60);
    auto t =
        keeping<D>(delaunay<D>(points), [](const Point<D> &c) { return c[0] < 0.4 || c[1] > 0.1; });
    MeshOf<D> loaded(0);
    ASSERT_EQ(loaded.load(t.vertices, t.simplices), ABACUS_OK) << loaded.error.message;
    expect_bounds<D>(loaded, 20);
}

TEST(Window, OfBoundsHasTheSimplicesWhoseBoundingBoxesMeetIt) {
    expect_bounds_of_meshes<2>();
    expect_bounds_of_meshes<3>();
}

template <int D> void expect_stretches(MeshOf<D> &mesh) {
    const Host host = mesh.host.host();
    std::vector<std::uint64_t> codes;
    for (const abacus_simplex &s : mesh.simplices(false)) codes.push_back(s.code);
    std::sort(codes.begin(), codes.end());
    Random random(8);
    for (int i = 0; i < 60; ++i) {
        std::uint64_t least = codes[random() % codes.size()], greatest = least;
        if (i % 3 == 1) greatest = codes[random() % codes.size()];
        if (i % 5 == 1) ++least;
        if (i % 7 == 1) least = 0;
        if (i % 11 == 1) greatest = UINT64_MAX;
        std::vector<std::uint64_t> expected, found;
        for (const std::uint64_t code : codes)
            if (least <= code && code <= greatest) expected.push_back(code);
        CellScan<D> scan(host, mesh.header, least, greatest);
        abacus_simplex simplex;
        while (scan.next(simplex, nullptr)) found.push_back(simplex.code);
        std::sort(found.begin(), found.end());
        EXPECT_EQ(found, expected);
    }
}

TEST(Stretch, HasTheSimplicesWithItsCodes) {
    auto points = uniform<2>(4000, 9);
    for (int i = 0; i < 1500; ++i) // far below the resolution of the domain: many share a code
        points.push_back({0.5 + (i % 40) * 1e-12, 0.5 + (i / 40) * 1e-12});
    MeshOf<2> mesh(0);
    ASSERT_EQ(mesh.stage(number<2>(points)), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    expect_stretches<2>(mesh);
    MeshOf<3> solid(0);
    ASSERT_EQ(solid.stage(number<3>(uniform<3>(1500, 10))), ABACUS_OK);
    ASSERT_EQ(solid.build(), ABACUS_OK);
    expect_stretches<3>(solid);
    MeshOf<2> empty(0);
    const Host host = empty.host.host();
    abacus_simplex simplex;
    EXPECT_FALSE((CellScan<2>(host, empty.header, 0, UINT64_MAX).next(simplex, nullptr)));
}

TEST(Window, OfAPointIsItsStar) {
    Mesh mesh(0);
    std::vector<Point<2>> points;
    for (int x = 0; x < 9; ++x)
        for (int y = 0; y < 9; ++y) points.push_back({x + 0.0, y + 0.0});
    ASSERT_EQ(mesh.stage(number(points)), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    const Host host = mesh.host.host();
    for (const std::size_t bytes : {std::size_t{40} << 10, std::size_t{64} << 20}) {
        Reader<2> reader(host, mesh.header, bytes);
        for (const Point<2> &p : {Point<2>{4, 4}, {0, 0}, {3.5, 4}, {2.25, 2.125}, {9, 3}}) {
            std::multiset<Positions<2>> star;
            reader.star(p, [&](const abacus_simplex &s) { star.insert(places<2>(s)); });
            abacus_window window{};
            window.kind = ABACUS_BALL_WINDOW;
            std::copy(p.begin(), p.end(), window.center);
            EXPECT_TRUE(star == read<2>(mesh, window, 0));
        }
    }
}

TEST(Neighbours, AreReachedAcrossSoManyFacets) {
    Mesh mesh(0);
    ASSERT_EQ(mesh.stage(number(uniform<2>(2000, 5))), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    const auto all = mesh.simplices(false);
    std::map<std::pair<std::int64_t, std::int64_t>, std::size_t> by_edge;
    for (std::size_t n = 0; n < all.size(); ++n)
        for (int i = 0; i < 3; ++i) by_edge[{all[n].id[i], all[n].id[(i + 1) % 3]}] = n;
    const Host host = mesh.host.host();
    Reader<2> reader(host, mesh.header, std::size_t{64} << 20);
    for (std::size_t first : {std::size_t{0}, std::size_t{777}, all.size() - 1})
        for (const std::uint32_t steps : {0u, 1u, 4u, 1000u}) {
            std::vector<std::size_t> expected{first};
            std::set<std::size_t> met{first};
            std::size_t level = 0;
            for (std::uint32_t step = 0; step < steps; ++step)
                for (const std::size_t end = expected.size(); level < end; ++level)
                    for (int i = 0; i < 3; ++i) {
                        const auto &s = all[expected[level]];
                        const auto beyond = by_edge.find({s.id[(i + 1) % 3], s.id[i]});
                        if (beyond != by_edge.end() && met.insert(beyond->second).second)
                            expected.push_back(beyond->second);
                    }
            std::multiset<Positions<2>> found, wanted;
            reader.neighbours(all[first].code, all[first].id, steps,
                              [&](const abacus_simplex &s) { found.insert(places<2>(s)); });
            for (const std::size_t n : expected) wanted.insert(places<2>(all[n]));
            EXPECT_TRUE(found == wanted) << found.size() << " of " << wanted.size();
        }
}

} // namespace
} // namespace abacus::test
