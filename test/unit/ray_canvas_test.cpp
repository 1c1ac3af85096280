// Pictures of the inside: the rays of all pixels, compared with rays that are cut off at every
// facet; and meshes with facets along the rays.
#include "draw/ray_canvas.hpp"
#include "support/image.hpp"
#include "support/large_mesh.hpp"
#include "support/oracle.hpp"
#include "support/point_sets.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace abacus::test {
namespace {

using Field = std::function<double(const Point<3> &)>;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double one(const Point<3> &) { return 1; }

abacus_camera camera(Point<3> eye, Point<3> toward, double field_of_view = 0) {
    abacus_camera camera{};
    camera.has_eye = camera.has_toward = 1;
    std::copy_n(eye.begin(), 3, camera.eye);
    std::copy_n(toward.begin(), 3, camera.toward);
    camera.field_of_view = field_of_view;
    return camera;
}

abacus_drawing drawing(int width, int height) {
    abacus_drawing drawing{};
    drawing.width = width;
    drawing.height = height;
    drawing.attribute = -1;
    return drawing;
}

struct Scene {
    explicit Scene(const std::vector<Point<3>> &points) {
        EXPECT_EQ(mesh.insert(number<3>(points)), ABACUS_OK) << mesh.error.detail;
        for (const Point<3> &p : points) box.extend(p);
        for (const abacus_simplex &s : mesh.simplices(false)) {
            Positions<3> at;
            for (int i = 0; i < 4; ++i) std::copy_n(s.corner[i], 3, at[i].begin());
            tetrahedra.push_back(at);
        }
    }
    RayCanvas canvas(const Camera &seen, const Field &field, abacus_ray_mode mode,
                     std::optional<Box<3>> box = std::nullopt) {
        RayCanvas canvas(host, seen, mode, box);
        for (const Positions<3> &t : tetrahedra)
            canvas.add(seen.see(t[0], field(t[0])), seen.see(t[1], field(t[1])),
                       seen.see(t[2], field(t[2])), seen.see(t[3], field(t[3])));
        return canvas;
    }

    /// A picture whose values are depths.
    RayCanvas depths(const Camera &seen, abacus_ray_mode mode) {
        return canvas(
            seen, [&](const Point<3> &p) { return seen.see(p, 0).seen[2]; }, mode);
    }

    MeshOf<3> mesh;
    const Host host = mesh.host.host();
    Box<3> box;
    std::vector<Positions<3>> tetrahedra;
};

double dot(const Point<3> &a, const Point<3> &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point<3> minus(const Point<3> &a, const Point<3> &b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Point<3> cross(const Point<3> &a, const Point<3> &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Point<3> unit_vector(const Point<3> &a) {
    const double length = std::sqrt(dot(a, a));
    return {a[0] / length, a[1] / length, a[2] / length};
}

struct Chord {
    double length = 0, sum = 0;
    double least = INFINITY, greatest = -INFINITY;
};

/// The part of the mesh on a ray from `from` in a direction of length 1.
Chord follow(const Scene &scene, const Point<3> &from, const Point<3> &direction,
             const Field &field) {
    Chord chord;
    for (const Positions<3> &t : scene.tetrahedra) {
        double enters = 0, leaves = INFINITY;
        for (int i = 0; i < 4; ++i) {
            const Point<3> &a = t[(i + 1) % 4], &b = t[(i + 2) % 4], &c = t[(i + 3) % 4];
            Point<3> inwards = cross(minus(b, a), minus(c, a));
            if (dot(inwards, minus(t[i], a)) < 0)
                for (double &x : inwards) x = -x;
            const double height = dot(inwards, minus(from, a)), slope = dot(inwards, direction);
            if (slope > 0)
                enters = std::max(enters, -height / slope);
            else if (slope < 0)
                leaves = std::min(leaves, -height / slope);
            else if (height < 0)
                leaves = -INFINITY;
        }
        if (!(enters < leaves)) continue;
        const auto at = [&](double way) {
            Point<3> p;
            for (int i = 0; i < 3; ++i) p[i] = from[i] + way * direction[i];
            return field(p); // linear
        };
        chord.length += leaves - enters;
        chord.sum += (leaves - enters) * (at(enters) + at(leaves)) / 2;
        chord.least = std::min({chord.least, at(enters), at(leaves)});
        chord.greatest = std::max({chord.greatest, at(enters), at(leaves)});
    }
    return chord;
}

std::vector<Point<3>> in_a_cube(int n) {
    Random random(4);
    std::vector<Point<3>> points;
    for (int i = 0; i < n; ++i) points.push_back({unit(random), unit(random), unit(random)});
    for (int i = 0; i < 8; ++i)
        points.push_back({i & 1 ? 1. : 0., i & 2 ? 1. : 0., i & 4 ? 1. : 0.});
    return points;
}

double sloping(const Point<3> &p) { return 3 + p[0] - 2 * p[1] + 0.5 * p[2]; }

/// The ray of a pixel in a perspective picture: its beginning, and a direction of length 1.
std::pair<Point<3>, Point<3>> ray(const abacus_camera &given, int width, int height, int x, int y) {
    const Point<3> eye{given.eye[0], given.eye[1], given.eye[2]};
    const Point<3> ahead =
        unit_vector(minus({given.toward[0], given.toward[1], given.toward[2]}, eye));
    const Point<3> right = unit_vector(cross(ahead, {0, 0, 1})), down = cross(ahead, right);
    const double step = std::tan(given.field_of_view * M_PI / 360) / (height / 2.0);
    Point<3> direction = ahead;
    for (int i = 0; i < 3; ++i)
        direction[i] +=
            right[i] * (x + 0.5 - width / 2.0) * step + down[i] * (y + 0.5 - height / 2.0) * step;
    return {eye, unit_vector(direction)};
}

void expect_rays(const abacus_camera &given, Scene &scene) {
    const Camera seen(given, drawing(24, 20), scene.box);
    const RayCanvas sum = scene.canvas(seen, sloping, ABACUS_RAY_SUM);
    const RayCanvas mean = scene.canvas(seen, sloping, ABACUS_RAY_MEAN);
    const RayCanvas least = scene.canvas(seen, sloping, ABACUS_RAY_MIN);
    const RayCanvas greatest = scene.canvas(seen, sloping, ABACUS_RAY_MAX);
    const RayCanvas length = scene.canvas(seen, one, ABACUS_RAY_SUM);
    int met = 0;
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 24; ++x) {
            const auto [from, direction] = ray(given, 24, 20, x, y);
            const Chord chord = follow(scene, from, direction, sloping);
            if (!(chord.length > 0.1)) continue; // near the outline, steps of a pixel matter
            ++met;
            EXPECT_NEAR(length.value(x, y), chord.length, 0.02);
            EXPECT_NEAR(sum.value(x, y), chord.sum, 0.08);
            EXPECT_NEAR(mean.value(x, y), chord.sum / chord.length, 0.02);
            EXPECT_NEAR(least.value(x, y), chord.least, 0.03);
            EXPECT_NEAR(greatest.value(x, y), chord.greatest, 0.03);
        }
    EXPECT_GT(met, 60);
}

TEST(RayCanvas, MeetsWhatRaysMeetInPerspective) {
    Scene scene(in_a_cube(150));
    expect_rays(camera({0.3, -2, 0.4}, {0.5, 0.5, 0.5}, 40), scene);
    expect_rays(camera({-1.5, 2.5, 2}, {0.5, 0.5, 0.5}, 30), scene);
    expect_rays(camera({0.45, 0.51, 0.52}, {0.9, 0.7, 0.6}, 100), scene); // inside it
    expect_rays(camera({0.5, 0.5, 0.5}, {0.5, 1, 0.5}, 60), scene);
}

/// Facets, edges and vertices lie exactly along the rays through the centres of pixels.
TEST(RayCanvas, MeetsEachTetrahedronOfAGridOnce) {
    std::vector<Point<3>> points;
    for (int i = 0; i < 9 * 9 * 9; ++i)
        points.push_back({i % 9 + 0.0, i / 9 % 9 + 0.0, i / 81 + 0.0});
    Scene scene(points);
    for (const double shift : {0.0, 0.5}) {
        Camera seen(camera({4, -9, 4}, {4, 0, 4}), drawing(16, 16), scene.box);
        const Point<2> a = seen.place({shift, 0, 8 - shift}),
                       b = seen.place({8 + shift, 0, -shift});
        seen.fit(Box<2>(a, b)); // two pixels a cell: their centres at quarters of it, or ...
        const RayCanvas canvas = scene.canvas(seen, one, ABACUS_RAY_SUM);
        for (int y = 1; y < 15; ++y)
            for (int x = 1; x < 15; ++x) EXPECT_NEAR(canvas.value(x, y), 8, 1e-9) << x << ' ' << y;
    }
    // ... at the corners of the cells, where the upper left ones belong to the mesh.
    Camera seen(camera({4, -9, 4}, {4, 0, 4}), drawing(9, 9), scene.box);
    const Point<2> a = seen.place({-0.5, 0, 8.5}), b = seen.place({8.5, 0, -0.5});
    seen.fit(Box<2>(a, b));
    const RayCanvas canvas = scene.canvas(seen, one, ABACUS_RAY_SUM);
    const RayCanvas mean = scene.canvas(seen, sloping, ABACUS_RAY_MEAN);
    for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 9; ++x) {
            if (x == 8 || y == 8) {
                EXPECT_TRUE(std::isnan(canvas.value(x, y)));
                continue;
            }
            EXPECT_NEAR(canvas.value(x, y), 8, 1e-9);
            EXPECT_NEAR(mean.value(x, y), sloping({x + 0.0, 4, 8.0 - y}), 1e-9);
        }
}

class RaysThroughPoints : public testing::TestWithParam<PointSet<3>> {};

/// No ray slips through the mesh, and none is counted twice: the tetrahedra give the same lengths
/// as the hull alone.
TEST_P(RaysThroughPoints, HasNoCracks) {
    Random random(8);
    std::vector<Point<3>> points = GetParam().points(random);
    if (points.size() > 1500) points.resize(1500);
    Scene scene(points);
    if (scene.tetrahedra.empty()) return;
    for (const double field_of_view : {0.0, 50.0}) {
        abacus_camera given{};
        given.field_of_view = field_of_view;
        if (field_of_view > 0 && scene.box.upper[0] > 1e307) continue; // no eye is that far away
        Camera seen(given, drawing(60, 60), scene.box);
        if (seen.has_parallel_rays()) {
            Box<2> around;
            for (const Point<3> &p : points) around.extend(seen.place(p));
            seen.fit(around);
        }
        const RayCanvas canvas = scene.canvas(seen, one, ABACUS_RAY_SUM);
        const RayCanvas mean = scene.canvas(seen, one, ABACUS_RAY_MEAN);
        // The places where rays enter and leave the whole mesh.
        const RayCanvas first = scene.depths(seen, ABACUS_RAY_MIN);
        const RayCanvas last = scene.depths(seen, ABACUS_RAY_MAX);
        int met = 0;
        for (int y = 0; y < 60; ++y)
            for (int x = 0; x < 60; ++x) {
                const double way = last.value(x, y) - first.value(x, y); // the scene has about 1
                const double unit = seen.length(x, y);
                if (!(way > 0)) continue;
                ++met;
                EXPECT_NEAR(mean.value(x, y), 1, 1e-12);
                if (std::isfinite(way * unit)) {
                    // A tetrahedron that is turned inside out may be the first or the last.
                    EXPECT_NEAR(canvas.value(x, y) / unit, way, 0.01 * way + 0.002 + 1e-323 / unit)
                        << x << ' ' << y;
                } else {
                    EXPECT_EQ(canvas.value(x, y), std::numeric_limits<double>::max());
                }
            }
        EXPECT_GT(met, 100);
    }
}

INSTANTIATE_TEST_SUITE_P(All, RaysThroughPoints, testing::ValuesIn(point_sets<3>()),
                         [](const auto &info) { return std::string(info.param.name); });

TEST(RayCanvas, SeesWhatIsInABox) {
    Scene scene(in_a_cube(300));
    const Box<3> box({0.25, 0.25, 0.25}, {0.75, 0.5, 0.75});
    Camera seen(camera({0.5, -9, 0.5}, {0.5, 0, 0.5}), drawing(20, 20), box);
    seen.fit(Box<2>(seen.place({0, 0, 1}), seen.place({1, 0, 0})));
    const RayCanvas length = scene.canvas(seen, one, ABACUS_RAY_SUM, box);
    const RayCanvas greatest = scene.canvas(
        seen, [](const Point<3> &p) { return p[1]; }, ABACUS_RAY_MAX, box);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 20; ++x)
            if (x >= 5 && x < 15 && y >= 5 && y < 15) {
                EXPECT_NEAR(length.value(x, y), 0.25, 1e-9);
                EXPECT_NEAR(greatest.value(x, y), 0.5, 1e-9);
            } else {
                EXPECT_TRUE(std::isnan(length.value(x, y)));
            }
}

TEST(RayCanvas, PassesOverMissingValues) {
    Scene scene(in_a_cube(50));
    Camera seen(camera({0.5, -9, 0.5}, {0.5, 0, 0.5}), drawing(8, 8), scene.box);
    seen.fit(Box<2>(seen.place({0, 0, 1}), seen.place({1, 0, 0})));
    const auto left = [](const Point<3> &p) { return p[0] > 0.5 ? nan : 7; };
    const RayCanvas mean = scene.canvas(seen, left, ABACUS_RAY_MEAN);
    EXPECT_NEAR(mean.value(0, 4), 7, 1e-12);
    EXPECT_TRUE(std::isnan(mean.value(7, 4)));
    EXPECT_FALSE(mean.is_blank());
    abacus_drawing colours = drawing(8, 8);
    colours.range[1] = 14;
    const Image image = decode(mean.png(colours));
    EXPECT_NE(image(0, 4), image(7, 4));
    EXPECT_TRUE(RayCanvas(scene.host, seen, ABACUS_RAY_MEAN, std::nullopt).is_blank());
}

TEST(RayCanvas, OfCoordinatesOfAnyMagnitude) {
    for (const double size : {1e-300, 1e300, 1e-12}) {
        std::vector<Point<3>> points = in_a_cube(40);
        for (Point<3> &p : points)
            for (double &x : p) x *= size;
        Scene scene(points);
        abacus_camera given{};
        given.field_of_view = 60;
        Camera seen(given, drawing(10, 10), scene.box);
        const RayCanvas canvas = scene.canvas(seen, one, ABACUS_RAY_SUM);
        EXPECT_GT(canvas.value(5, 5), size);
        EXPECT_LT(canvas.value(5, 5), 2 * size);
    }
}

} // namespace
} // namespace abacus::test
