// Areas and volumes: compared with rational arithmetic over all triangles and pairs of them;
// identities; the same to the last bit, however the mesh was made.
#include "query/volume/volume.hpp"
#include "support/large_mesh.hpp"
#include "support/mesh_in_change.hpp"
#include "support/triangulations.hpp"

#include <CGAL/Exact_rational.h>

#include <gtest/gtest.h>

#include <cmath>

namespace abacus::test {
namespace {

using Rational = CGAL::Exact_rational;

// ---- Rational arithmetic -----------------------------------------------------------------

struct Corner {
    Rational x, y, height, other;
};
using Polygon = std::vector<Corner>;

/// The part of a convex polygon where a linear function, given at the corners, is not negative.
template <class Side> Polygon part_of(const Polygon &polygon, Side side) {
    Polygon part;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Corner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const Rational at_a = side(a), at_b = side(b);
        if (at_a >= 0) part.push_back(a);
        if ((at_a > 0 && at_b < 0) || (at_a < 0 && at_b > 0)) {
            const Rational t = at_a / (at_a - at_b);
            part.push_back({a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t,
                            a.height + (b.height - a.height) * t,
                            a.other + (b.other - a.other) * t});
        }
    }
    return part;
}

Rational turn(const Corner &a, const Corner &b, const Corner &c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

Rational area_of(const Polygon &polygon) {
    Rational sum = 0;
    for (std::size_t i = 2; i < polygon.size(); ++i)
        sum += turn(polygon[0], polygon[i - 1], polygon[i]) / 2;
    return sum;
}

Rational integral_of(const Polygon &polygon) {
    Rational sum = 0;
    for (std::size_t i = 2; i < polygon.size(); ++i)
        sum += turn(polygon[0], polygon[i - 1], polygon[i]) / 6 *
               (polygon[0].height + polygon[i - 1].height + polygon[i].height);
    return sum;
}

struct Expected {
    Rational area = 0, cut = 0, fill = 0;

    void add(const Polygon &polygon) {
        area += area_of(polygon);
        cut += integral_of(part_of(polygon, [](const Corner &c) { return c.height; }));
        fill -= integral_of(part_of(polygon, [](const Corner &c) { return Rational(-c.height); }));
    }
};

/// The box of a polygon, in doubles: rational arithmetic is slow.
Box<2> around(const Polygon &polygon) {
    Box<2> box;
    for (const Corner &c : polygon) box.extend({CGAL::to_double(c.x), CGAL::to_double(c.y)});
    return box;
}

Polygon in_window(Polygon polygon, const abacus_window &window) {
    if (window.kind == ABACUS_NO_WINDOW) return polygon;
    polygon = part_of(polygon, [&](const Corner &c) { return c.x - Rational(window.lower[0]); });
    polygon = part_of(polygon, [&](const Corner &c) { return Rational(window.upper[0]) - c.x; });
    polygon = part_of(polygon, [&](const Corner &c) { return c.y - Rational(window.lower[1]); });
    return part_of(polygon, [&](const Corner &c) { return Rational(window.upper[1]) - c.y; });
}

/// A mesh and its triangles with heights.
struct Surface : Mesh {
    Surface() : Mesh(1) {}

    void insert_all(const std::vector<Input> &input) {
        ASSERT_EQ(insert(input), ABACUS_OK) << error.message;
        read(input);
    }
    void load_all(Triangulation<2> t, const std::function<double(const Point<2> &)> &height) {
        for (auto &v : t.vertices) v.attributes = {height(v.point)};
        ASSERT_EQ(load(t.vertices, t.simplices), ABACUS_OK) << error.message << error.detail;
        read(t.vertices);
    }
    void read(const std::vector<Input> &input) {
        std::map<Point<2>, double> heights;
        for (const Input &p : input) heights.emplace(p.point, p.attributes[0]);
        for (const abacus_simplex &s : simplices(false)) {
            Polygon triangle;
            bool is_whole = true;
            for (const auto &at : s.corner) {
                if (triangle.size() == 3) break;
                const double height = heights.at({at[0], at[1]});
                is_whole = is_whole && std::isfinite(height);
                triangle.push_back({at[0], at[1], is_whole ? height : 0, 0});
            }
            if (is_whole) triangles.push_back(triangle);
        }
    }

    std::vector<Polygon> triangles;
};

Expected expected_above(const Surface &mesh, const abacus_window &window, double base) {
    Expected sums;
    for (Polygon triangle : mesh.triangles) {
        for (Corner &c : triangle) c.height -= Rational(base);
        sums.add(in_window(triangle, window));
    }
    return sums;
}

/// The height of a triangle's plane.
Rational height_at(const Polygon &t, const Corner &p) {
    const Rational all = turn(t[0], t[1], t[2]);
    return (turn(p, t[1], t[2]) * t[0].height + turn(t[0], p, t[2]) * t[1].height +
            turn(t[0], t[1], p) * t[2].height) /
           all;
}

Expected expected_between(const Surface &first, const Surface &second,
                          const abacus_window &window) {
    Expected sums;
    std::vector<Box<2>> boxes;
    for (const Polygon &b : second.triangles) boxes.push_back(around(b));
    for (const Polygon &triangle : first.triangles) {
        const Polygon a = in_window(triangle, window);
        const Box<2> box = around(a);
        for (std::size_t n = 0; n < boxes.size() && !a.empty(); ++n) {
            if (!box.meets(boxes[n])) continue;
            const Polygon &b = second.triangles[n];
            Polygon both = a;
            for (int i = 0; i < 3; ++i)
                both =
                    part_of(both, [&](const Corner &c) { return turn(b[i], b[(i + 1) % 3], c); });
            for (Corner &c : both) c.height -= height_at(b, c);
            sums.add(both);
        }
    }
    return sums;
}

// ---- What is tested ------------------------------------------------------------------------

abacus_surface surface_in(const abacus_window &window) {
    abacus_surface surface{};
    surface.window = window;
    return surface;
}

abacus_window window(double x0, double y0, double x1, double y1) {
    abacus_window window{};
    window.kind = ABACUS_BOX_WINDOW;
    window.lower[0] = x0;
    window.lower[1] = y0;
    window.upper[0] = x1;
    window.upper[1] = y1;
    return window;
}

template <int D> abacus_volume above(MeshOf<D> &mesh, const abacus_window &window, double base) {
    const abacus_surface surface = surface_in(window);
    abacus_volume volume{};
    EXPECT_EQ(abacus_volume_above(mesh.host.table(), &mesh.header.facts, &surface, base, &volume,
                                  &mesh.error),
              ABACUS_OK)
        << mesh.error.message;
    EXPECT_EQ(mesh.host.bytes, 0u);
    return volume;
}

abacus_volume between(Mesh &first, Mesh &second, const abacus_window &window,
                      std::size_t cache_bytes = std::size_t{1} << 20) {
    const abacus_surface surface = surface_in(window);
    abacus_volume volume{};
    EXPECT_EQ(abacus_volume_between(first.host.table(), &first.header.facts, &surface,
                                    second.host.table(), &second.header.facts, 0, cache_bytes,
                                    &volume, &first.error),
              ABACUS_OK)
        << first.error.message << first.error.detail;
    EXPECT_EQ(first.host.bytes + second.host.bytes, 0u);
    EXPECT_EQ(first.host.violations, std::vector<std::string>{});
    EXPECT_EQ(second.host.violations, std::vector<std::string>{});
    return volume;
}

void expect_near(const abacus_volume &volume, const Expected &expected, double size = 1) {
    const double slack = 1e-13 * size;
    EXPECT_NEAR(volume.area, CGAL::to_double(expected.area), slack);
    EXPECT_NEAR(volume.cut, CGAL::to_double(expected.cut), slack);
    EXPECT_NEAR(volume.fill, CGAL::to_double(expected.fill), slack);
    EXPECT_GE(volume.surface, volume.area * (1 - 1e-15));
}

double hill(const Point<2> &p) { return std::sin(5 * p[0]) * std::cos(4 * p[1]) - p[0] / 3; }
double dune(const Point<2> &p) { return std::cos(7 * p[0] + p[1]) / 2; }

std::vector<Input> raised(const std::vector<Point<2>> &points, double (*height)(const Point<2> &),
                          int gap = 0) {
    std::vector<Input> input;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const bool is_gap = gap > 0 && i % static_cast<std::size_t>(gap) == 0;
        input.push_back(
            {static_cast<std::int64_t>(i), points[i], {is_gap ? NAN : height(points[i])}});
    }
    return input;
}

/// Points of the unit square, moved and scaled; every third of them on a grid.
std::vector<Point<2>> points(int n, unsigned seed, double scale = 1, double shift = 0) {
    Random random(seed);
    std::vector<Point<2>> result;
    for (int i = 0; i < n; ++i) {
        Point<2> p = unit_point<2>(random);
        for (double &x : p) x = (i % 3 == 0 ? std::floor(x * 9) / 8 : x) * scale + shift;
        result.push_back(p);
    }
    return result;
}

const std::vector<abacus_window> windows{
    {},
    window(0.2, 0.3, 0.7, 0.8),
    window(0.5, 0.25, 0.5625, 0.375),
    window(-3, 0.5, 3, 4),
    window(0.5, 0.1, 0.5, 0.9),
    window(7, 7, 8, 8),
};

TEST(Volume, OverABase) {
    Surface mesh;
    mesh.insert_all(raised(points(300, 1), hill, 40));
    for (const abacus_window &w : windows)
        for (const double base : {-0.25, 0.0, 2.0, -2.0})
            expect_near(above(mesh, w, base), expected_above(mesh, w, base), 10);
}

TEST(Volume, BetweenTwoMeshes) {
    Surface first, second, holes, far;
    first.insert_all(raised(points(120, 2), hill, 50));
    second.insert_all(raised(points(90, 3, 0.8, 0.15), dune, 30));
    far.insert_all(raised(points(40, 4, 1, 5), dune));
    holes.load_all(keeping<2>(delaunay<2>(points(140, 5)),
                              [](const Point<2> &c) { return c[0] < 0.4 || c[1] > 0.6; }),
                   dune);
    const std::pair<Surface *, Surface *> pairs[] = {
        {&first, &second}, {&second, &first}, {&first, &holes}, {&holes, &second}};
    for (const abacus_window &w : windows)
        for (const auto &[one, other] : pairs) {
            const Expected expected = expected_between(*one, *other, w);
            for (const std::size_t bytes : {std::size_t{60} << 10, std::size_t{64} << 20})
                expect_near(between(*one, *other, w, bytes), expected);
            EXPECT_EQ(between(*one, far, w).area, 0);
        }
}

TEST(Volume, BetweenATriangleAndThousands) {
    Surface coarse, fine;
    coarse.insert_all({{1, {-2, -2}, {0}}, {2, {3, -2.5}, {1}}, {3, {0.1, 4}, {-1}}});
    fine.insert_all(raised(points(20000, 6), hill, 999));
    Surface pieces;
    pieces.load_all(keeping<2>(delaunay<2>(points(5000, 7)),
                               [](const Point<2> &c) { return c[0] + c[1] > 0.3; }),
                    hill);
    for (const abacus_window &w : windows) {
        for (Surface *other : {&fine, &pieces}) {
            const abacus_volume volume = between(coarse, *other, w, 60 << 10);
            const abacus_volume turned = between(*other, coarse, w, 60 << 10);
            EXPECT_EQ(volume.area, turned.area);
            EXPECT_EQ(volume.cut, turned.fill);
            EXPECT_EQ(volume.fill, turned.cut);
            EXPECT_NEAR(volume.area, above<2>(*other, w, 0).area, 1e-13);
        }
    }
}

TEST(Volume, OfGridsThatShareEdges) {
    const auto grid = [](int n, double from, double to) {
        std::vector<Point<2>> points;
        for (int x = 0; x <= n; ++x)
            for (int y = 0; y <= n; ++y)
                points.push_back({from + (to - from) * x / n, from + (to - from) * y / n});
        return points;
    };
    Surface eight, four, beside;
    eight.insert_all(raised(grid(8, 0, 1), hill));
    four.insert_all(raised(grid(4, 0, 1), dune));
    beside.insert_all(raised(grid(8, 1, 2), dune)); // has one common corner
    for (const abacus_window &w : windows) {
        expect_near(between(eight, four, w), expected_between(eight, four, w));
        EXPECT_EQ(between(eight, beside, w).area, 0);
    }
    EXPECT_EQ(between(eight, four, {}).area, 1);
    // Triangles of equal size: the order of the meshes does not matter.
    Surface moved;
    moved.insert_all(raised(grid(8, 0.03, 1.03), dune));
    const abacus_volume volume = between(eight, moved, {}), turned = between(moved, eight, {});
    EXPECT_EQ(volume.area, turned.area);
    EXPECT_EQ(volume.cut, turned.fill);
    EXPECT_EQ(volume.fill, turned.cut);
}

/// Two meshes with the same points have no volume between them, exactly.
TEST(Volume, BetweenTheSameIsNothing) {
    for (const double shift : {0.0, 5e6}) {
        Surface mesh;
        mesh.insert_all(raised(points(3000, 8, 1000, shift), hill));
        for (const abacus_window &w :
             {abacus_window{}, window(200 + shift, 100 + shift, 700 + shift, 420.7 + shift)}) {
            const abacus_volume volume = between(mesh, mesh, w), whole = above<2>(mesh, w, 0);
            EXPECT_EQ(volume.cut, 0);
            EXPECT_EQ(volume.fill, 0);
            EXPECT_EQ(volume.area, whole.area);
            EXPECT_NEAR(volume.surface, whole.surface, 1e-12 * whole.surface);
        }
    }
}

bool same(const abacus_volume &a, const abacus_volume &b) {
    return a.area == b.area && a.surface == b.surface && a.cut == b.cut && a.fill == b.fill;
}

TEST(Volume, IsTheSameHoweverTheMeshCameAbout) {
    std::vector<Input> input = raised(distinct(points(5000, 9, 300, 7e5)), hill);
    std::vector<Input> other = raised(distinct(points(4000, 10, 290, 7e5 + 3)), dune);
    const abacus_window w = window(7e5 + 20, 7e5 + 50, 7e5 + 200, 7e5 + 144);
    Random random(11);
    std::optional<abacus_volume> whole, part, both;
    for (const std::size_t bytes : {std::size_t{60} << 10, std::size_t{1} << 20, ample}) {
        MeshOf<2> first(1, bytes), second(1, bytes);
        std::shuffle(input.begin(), input.end(), random);
        std::shuffle(other.begin(), other.end(), random);
        for (std::size_t i = 0; i < input.size(); ++i) // ids give no order
            input[i].id = static_cast<std::int64_t>(i);
        if (bytes == ample) {
            ASSERT_EQ(first.stage(input), ABACUS_OK);
            ASSERT_EQ(first.build(), ABACUS_OK);
        } else {
            ASSERT_EQ(first.insert({input.begin(), input.begin() + 2000}), ABACUS_OK);
            ASSERT_EQ(first.insert({input.begin() + 2000, input.end()}), ABACUS_OK);
        }
        ASSERT_EQ(second.insert(other), ABACUS_OK);
        const abacus_volume all = above<2>(first, {}, 0.1), some = above<2>(first, w, 0.1);
        const abacus_volume shared = between(first, second, w, bytes);
        EXPECT_TRUE(same(all, whole.value_or(all)));
        EXPECT_TRUE(same(some, part.value_or(some)));
        EXPECT_TRUE(same(shared, both.value_or(shared)));
        whole = all;
        part = some;
        both = shared;
    }
}

TEST(Volume, OfWindowsAddUp) {
    Surface mesh;
    mesh.insert_all(raised(points(2000, 12), hill));
    const abacus_volume whole = above<2>(mesh, window(0, 0, 1, 1), 0.05);
    abacus_volume sum{};
    for (int x = 0; x < 8; ++x)
        for (int y = 0; y < 8; ++y) {
            const abacus_volume part =
                above<2>(mesh, window(x / 8.0, y / 8.0, (x + 1) / 8.0, (y + 1) / 8.0), 0.05);
            sum.area += part.area;
            sum.surface += part.surface;
            sum.cut += part.cut;
            sum.fill += part.fill;
        }
    EXPECT_NEAR(sum.area, whole.area, 1e-14);
    EXPECT_NEAR(sum.surface, whole.surface, 1e-13);
    EXPECT_NEAR(sum.cut, whole.cut, 1e-14);
    EXPECT_NEAR(sum.fill, whole.fill, 1e-14);
}

TEST(Volume, LeavesOutLongEdges) {
    Surface mesh, other;
    mesh.insert_all(raised(points(500, 13), hill));
    other.insert_all(raised(points(500, 14), hill));
    abacus_surface surface = surface_in({});
    surface.extent.max_edge = 0.08;
    const auto keep_short = [](const std::vector<Polygon> &triangles) {
        std::vector<Polygon> kept;
        for (const Polygon &t : triangles) {
            bool is_short = true;
            for (int i = 0; i < 3; ++i) {
                const Corner &a = t[i], &b = t[(i + 1) % 3];
                const Rational square = (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
                is_short = is_short && square <= Rational(0.08) * Rational(0.08);
            }
            if (is_short) kept.push_back(t);
        }
        return kept;
    };
    mesh.triangles = keep_short(mesh.triangles);
    other.triangles = keep_short(other.triangles);
    ASSERT_GT(mesh.triangles.size(), 100u);
    abacus_volume volume{};
    ASSERT_EQ(abacus_volume_above(mesh.host.table(), &mesh.header.facts, &surface, 0.1, &volume,
                                  &mesh.error),
              ABACUS_OK);
    expect_near(volume, expected_above(mesh, {}, 0.1));
    ASSERT_EQ(abacus_volume_between(mesh.host.table(), &mesh.header.facts, &surface,
                                    other.host.table(), &other.header.facts, 0,
                                    std::size_t{1} << 20, &volume, &mesh.error),
              ABACUS_OK);
    expect_near(volume, expected_between(mesh, other, {}));
}

TEST(Volume, ReadsWhatBothMeshesHaveAlone) {
    Surface small;
    small.insert_all(raised(points(50, 20, 0.01, 0.6), dune));
    MeshOf<2> large(1);
    ASSERT_EQ(large.insert(raised(points(60000, 21), hill)), ABACUS_OK);
    for (const bool is_first : {true, false}) {
        const auto pages_read = [&] {
            return large.host.calls.find + large.host.calls.next + large.host.calls.fetch;
        };
        const std::uint64_t before = pages_read();
        const abacus_volume volume =
            is_first ? between(large, small, {}) : between(small, large, {});
        EXPECT_NEAR(volume.area, above<2>(small, {}, 0).area, 1e-16);
        // If it is scanned, it is searched along its hull; otherwise only by pages around the other
        // mesh.
        EXPECT_LT(pages_read() - before, large.host.pages.size() / 2) << is_first;
    }
}

// ---- In space --------------------------------------------------------------------------------

std::vector<InputOf<3>> field(int n, const std::function<double(const Point<3> &)> &value) {
    std::vector<InputOf<3>> input;
    Random random(15);
    for (int i = 0; i < n; ++i) {
        Point<3> p = unit_point<3>(random);
        if (i < 8) p = {i & 1 ? 1.0 : 0, i & 2 ? 1.0 : 0, i & 4 ? 1.0 : 0};
        input.push_back({i, p, {value(p)}});
    }
    return input;
}

TEST(Volume, InSpaceOfPartsOfACube) {
    MeshOf<3> mesh(1);
    ASSERT_EQ(mesh.insert(field(900, [](const Point<3> &p) { return p[0] + p[1] + p[2]; })),
              ABACUS_OK);
    for (const double base : {-1.0, 0.0, 0.25, 0.5, 1.0, 2.5, 3.0, 4.0}) {
        const abacus_volume volume = above<3>(mesh, {}, base);
        const auto cube = [&](double x) { return x > 0 ? x * x * x / 6 : 0; };
        const double below = cube(base) - 3 * cube(base - 1) + 3 * cube(base - 2) - cube(base - 3);
        const auto square = [&](double x) { return x > 0 ? x * x / 2 : 0; };
        const double section = square(base) - 3 * square(base - 1) + 3 * square(base - 2) -
                               square(base - 3); // over the base plane, along one axis
        EXPECT_NEAR(volume.area, 1, 1e-13);
        EXPECT_NEAR(volume.fill, below, 1e-13);
        EXPECT_NEAR(volume.cut, 1 - below, 1e-13);
        EXPECT_NEAR(volume.surface, section * std::sqrt(3.0), 1e-12) << base;
    }
}

TEST(Volume, InSpaceOfALayerThroughPoints) {
    std::vector<InputOf<3>> grid;
    for (int i = 0; i < 5 * 5 * 5; ++i)
        grid.push_back({i, {i % 5 + 0.0, i / 5 % 5 + 0.0, i / 25 + 0.0}, {i / 25 + 0.0}});
    MeshOf<3> mesh(1);
    ASSERT_EQ(mesh.insert(grid), ABACUS_OK);
    for (int base = 0; base <= 5; ++base) {
        const abacus_volume volume = above<3>(mesh, {}, base);
        EXPECT_EQ(volume.area, 64);
        EXPECT_EQ(volume.fill, 16 * std::min(base, 4));
        EXPECT_EQ(volume.cut, 64 - volume.fill);
        EXPECT_EQ(volume.surface, base == 0 || base == 5 ? 0 : 16);
    }
    abacus_window w{};
    w.kind = ABACUS_BOX_WINDOW;
    for (int axis = 0; axis < 3; ++axis) {
        w.lower[axis] = 0.5;
        w.upper[axis] = 3.25;
    }
    const abacus_volume volume = above<3>(mesh, w, 1.75);
    EXPECT_NEAR(volume.area, 2.75 * 2.75 * 2.75, 1e-13);
    EXPECT_NEAR(volume.fill, 2.75 * 2.75 * 1.25, 1e-13);
    EXPECT_NEAR(volume.surface, 2.75 * 2.75, 1e-13);
}

TEST(Volume, InSpaceIsTheSameHoweverTheMeshCameAbout) {
    std::vector<InputOf<3>> input =
        field(800, [](const Point<3> &p) { return std::sin(9 * p[0]) + p[1] * p[2]; });
    Random random(16);
    std::optional<abacus_volume> known;
    for (const std::size_t bytes : {std::size_t{60} << 10, std::size_t{64} << 20}) {
        std::shuffle(input.begin(), input.end(), random);
        MeshOf<3> mesh(1, bytes);
        ASSERT_EQ(mesh.insert(input), ABACUS_OK);
        const abacus_volume volume = above<3>(mesh, {}, 0.3);
        EXPECT_TRUE(same(volume, known.value_or(volume)));
        known = volume;
    }
}

// ---- Comparisons -----------------------------------------------------------------------------

template <int D>
abacus_comparison compared(MeshOf<D> &first, MeshOf<D> &second, std::size_t cache_bytes) {
    const abacus_surface surface = surface_in({});
    abacus_comparison comparison{};
    EXPECT_EQ(abacus_compare(first.host.table(), &first.header.facts, &surface, second.host.table(),
                             &second.header.facts, 0, cache_bytes, &comparison, &first.error),
              ABACUS_OK)
        << first.error.message << first.error.detail;
    EXPECT_EQ(first.host.bytes + second.host.bytes, 0u);
    EXPECT_EQ(first.host.violations, std::vector<std::string>{});
    EXPECT_EQ(second.host.violations, std::vector<std::string>{});
    return comparison;
}

/// Linear functions over different points of a cube: all is known.
TEST(Comparison, OfLinearFunctionsInSpace) {
    MeshOf<3> fine(1), coarse(1);
    ASSERT_EQ(fine.insert(field(2500, [](const Point<3> &p) { return 2 * p[0] + p[1]; })),
              ABACUS_OK);
    ASSERT_EQ(coarse.insert(field(8, [](const Point<3> &p) { return p[0] + 0.5 - p[2]; })),
              ABACUS_OK);
    // x + y + z - 0.5 is negative in a corner of the cube, with a volume of 1/48 and a mean of
    // -1/8.
    const double absolute = 1 + 2 * 0.125 / 48, square = 3.0 / 12 + 1;
    for (const std::size_t bytes : {std::size_t{60} << 10, std::size_t{64} << 20})
        for (const bool is_turned : {false, true}) {
            const abacus_comparison comparison =
                is_turned ? compared<3>(coarse, fine, bytes) : compared<3>(fine, coarse, bytes);
            const double sign = is_turned ? -1 : 1;
            EXPECT_EQ(comparison.is_any, 1);
            EXPECT_EQ(comparison.greatest, sign * 2.5);
            for (const double x : comparison.place) EXPECT_EQ(x, 1);
            EXPECT_NEAR(comparison.mean, sign, 1e-12);
            EXPECT_NEAR(comparison.mean_absolute, absolute, 1e-12);
            EXPECT_NEAR(comparison.rms, std::sqrt(square), 1e-12);
        }
}

TEST(Comparison, OfTheSameInSpaceIsNothing) {
    MeshOf<3> mesh(1);
    ASSERT_EQ(mesh.insert(field(900, [](const Point<3> &p) { return std::sin(9 * p[0]) + p[1]; })),
              ABACUS_OK);
    const abacus_comparison comparison = compared<3>(mesh, mesh, std::size_t{60} << 10);
    EXPECT_EQ(comparison.is_any, 1);
    EXPECT_EQ(comparison.greatest, 0);
    for (const double x : comparison.place) EXPECT_EQ(x, 0);
    EXPECT_EQ(comparison.mean, 0);
    EXPECT_EQ(comparison.mean_absolute, 0);
    EXPECT_EQ(comparison.rms, 0);
}

/// A mesh with a hole counts only where it is; either may have it.
TEST(Comparison, WithHolesInSpace) {
    MeshOf<3> whole(1), holes(1), apart(1);
    ASSERT_EQ(whole.insert(field(300, [](const Point<3> &) { return 0.0; })), ABACUS_OK);
    Random random(23);
    std::vector<Point<3>> points;
    for (int i = 0; i < 400; ++i) points.push_back(unit_point<3>(random));
    auto t = keeping<3>(delaunay<3>(points), [](const Point<3> &c) { return c[0] > c[1] + 0.1; });
    for (auto &v : t.vertices) v.attributes = {v.point[0] - v.point[1]};
    ASSERT_EQ(holes.load(t.vertices, t.simplices), ABACUS_OK) << holes.error.message;
    std::vector<InputOf<3>> far;
    for (auto v : t.vertices) {
        v.point[2] += 7;
        far.push_back(v);
    }
    ASSERT_EQ(apart.insert(far), ABACUS_OK);
    const double volume = above<3>(holes, {}, 0).area;
    EXPECT_GT(volume, 0.1);
    EXPECT_LT(volume, 0.9);
    const abacus_comparison there = compared<3>(holes, whole, std::size_t{60} << 10),
                            back = compared<3>(whole, holes, std::size_t{60} << 10);
    EXPECT_EQ(there.greatest, -back.greatest);
    EXPECT_EQ(there.mean, -back.mean);
    EXPECT_EQ(there.rms, back.rms);
    EXPECT_GT(there.mean, 0.1);
    EXPECT_GE(there.mean_absolute, there.mean);
    EXPECT_EQ(compared<3>(apart, whole, std::size_t{60} << 10).is_any, 0);
    EXPECT_EQ(compared<3>(apart, holes, std::size_t{60} << 10).is_any, 0);
}

// ---- What cannot be ------------------------------------------------------------------------

TEST(Volume, OfNothing) {
    Mesh empty(1);
    Surface mesh;
    mesh.insert_all(raised(points(100, 17), hill));
    for (const abacus_volume &volume :
         {above<2>(empty, {}, 0), between(empty, mesh, {}), between(mesh, empty, {})})
        EXPECT_TRUE(same(volume, {0, 0, 0, 0}));
}

TEST(Volume, BeyondDoublesIsInfinite) {
    Surface mesh;
    mesh.insert_all({{1, {0, 0}, {1}}, {2, {1e200, 0}, {1}}, {3, {0, 1e200}, {1}}});
    EXPECT_FALSE(std::isfinite(above<2>(mesh, {}, 0).area));
}

/// Results are those of a mesh of size 1 times powers of two, as far as these are doubles.
TEST(Volume, AtTheLimitsOfDoubles) {
    const auto expect_scaled = [](double value, double of_size_1, int exponent) {
        EXPECT_DOUBLE_EQ(value, std::ldexp(of_size_1, exponent)) << exponent;
    };
    const auto insert = [](Surface &mesh, int e, int h, double second) {
        const double unit = std::ldexp(1, e), up = std::ldexp(1, h);
        mesh.insert_all({{1, {0, 0}, {0.25 * up}},
                         {2, {unit, 0}, {second * up}},
                         {3, {0, unit}, {-0.75 * up}}});
    };
    Surface mesh, other;
    insert(mesh, 0, 0, 0.5);
    insert(other, 0, 0, 0.125);
    const abacus_volume over = above<2>(mesh, {}, 0), against = between(mesh, other, {});
    for (const int e : {-600, -530, -340, -283, -260, 258, 340, 510, 700}) {
        Surface small, beside;
        insert(small, e, e, 0.5);
        insert(beside, e, e, 0.125);
        const abacus_volume volume = above<2>(small, {}, 0), both = between(small, beside, {});
        expect_scaled(volume.area, over.area, 2 * e);
        expect_scaled(volume.surface, over.surface, 2 * e);
        expect_scaled(volume.cut, over.cut, 3 * e);
        expect_scaled(volume.fill, over.fill, 3 * e);
        expect_scaled(both.surface, against.surface, 2 * e);
        expect_scaled(both.cut, against.cut, 3 * e);
    }
    Surface steep;
    insert(steep, -600, 500, 0.5);
    const abacus_volume volume = above<2>(steep, {}, 0);
    expect_scaled(volume.cut, over.cut, -700);
    EXPECT_GT(volume.surface, 0);
}

TEST(Volume, InSpaceOfThinTetrahedra) {
    MeshOf<3> mesh(1);
    ASSERT_EQ(mesh.insert({{1, {0, 0, 0}, {-1}},
                           {2, {0x1p700, 0, 0}, {1}},
                           {3, {0, 0x1p-600, 0}, {1}},
                           {4, {0, 0, 0x1p-600}, {1}}}),
              ABACUS_OK);
    const abacus_volume volume = above<3>(mesh, {}, 0);
    EXPECT_DOUBLE_EQ(volume.area, 0x1p-500 / 6);
    EXPECT_DOUBLE_EQ(volume.fill, 0x1p-503 / 6);
    EXPECT_DOUBLE_EQ(volume.surface, 0x1p100 / 8 * std::sqrt(2.0));
}

TEST(Volume, ShowsItsProgress) {
    Surface mesh;
    mesh.insert_all(raised(points(3000, 22), hill));
    for (const bool is_alone : {true, false}) {
        std::vector<abacus_progress> reports;
        mesh.host.on_progress = [&](const abacus_progress &p) { reports.push_back(p); };
        if (is_alone)
            above<2>(mesh, {}, 0);
        else
            between(mesh, mesh, window(0, 0, 0.3, 0.3));
        ASSERT_GE(reports.size(), 2u);
        EXPECT_EQ(reports.front().phase, ABACUS_PHASE_SCANNING);
        EXPECT_EQ(reports.front().total, is_alone ? mesh.header.facts.census.simplices : 0);
        EXPECT_GT(reports.back().done, 0u);
        if (is_alone) {
            EXPECT_EQ(reports.back().done, mesh.header.facts.census.simplices);
        }
        mesh.host.on_progress = {};
    }
}

TEST(Volume, SurvivesFailures) {
    Surface first, second;
    first.insert_all(raised(points(1500, 18), hill));
    second.insert_all(raised(points(1500, 19), dune));
    const abacus_surface surface = surface_in({});
    abacus_volume volume{};
    for (MemoryHost *failing : {&first.host, &second.host})
        for (std::uint64_t n = 1; n < 40; n += 3) {
            failing->fail_at(n);
            const abacus_status status = abacus_volume_between(
                first.host.table(), &first.header.facts, &surface, second.host.table(),
                &second.header.facts, 0, 100 << 10, &volume, &first.error);
            EXPECT_EQ(status, failing->failed ? ABACUS_HOST_ERROR : ABACUS_OK);
            failing->recover();
            EXPECT_EQ(first.host.bytes + second.host.bytes, 0u);
        }
    first.host.cancel();
    EXPECT_EQ(abacus_volume_between(first.host.table(), &first.header.facts, &surface,
                                    second.host.table(), &second.header.facts, 0, 100 << 10,
                                    &volume, &first.error),
              ABACUS_HOST_ERROR);
}

} // namespace
} // namespace abacus::test
