// Polygons: which places are inside, what of triangles and segments is, and the trapezoids of their
// inside, against plain sums and rational numbers.
#include "geometry/polygon.hpp"

#include "geometry/clip_trapezoid.hpp"
#include "geometry/rational.hpp"
#include "support/memory_host.hpp"

#include <gtest/gtest.h>

#include <random>

namespace abacus {
namespace {

using exact::Rational;
using Ring = std::vector<Point<2>>;

struct Made {
    explicit Made(const std::vector<Ring> &rings) {
        std::vector<Point<2>> points;
        std::vector<std::size_t> sizes;
        for (const Ring &ring : rings) {
            points.insert(points.end(), ring.begin(), ring.end());
            sizes.push_back(ring.size());
        }
        polygon.emplace(host, points.data(), sizes.data(), sizes.size());
    }
    MemoryHost memory;
    const Host host{*memory.table()};
    std::optional<Polygon> polygon;
};

/// Twice the area, exactly.
Rational area_of(const Ring &ring) {
    Rational sum = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point<2> &a = ring[i], &b = ring[(i + 1) % ring.size()];
        sum += Rational(a[0]) * Rational(b[1]) - Rational(a[1]) * Rational(b[0]);
    }
    return sum;
}

Rational y_at(const Point<2> *const (&edge)[2], double x) {
    const Point<2> &a = *edge[0], &b = *edge[1];
    return Rational(a[1]) + (Rational(b[1]) - Rational(a[1])) * (Rational(x) - Rational(a[0])) /
                                (Rational(b[0]) - Rational(a[0]));
}

/// Twice the area of all trapezoids, exactly.
Rational area_of(const Polygon &polygon) {
    Rational sum = 0;
    polygon.each_part(polygon.box(), [&](const Polygon::Trapezoid &part) {
        const Rational left = y_at(part.upper, part.left) - y_at(part.lower, part.left),
                       right = y_at(part.upper, part.right) - y_at(part.lower, part.right);
        EXPECT_GE(left, 0);
        EXPECT_GE(right, 0);
        sum += (left + right) * (Rational(part.right) - Rational(part.left));
    });
    return sum;
}

/// A comb of `teeth` points, whose sides are vertical, level and oblique, on a grid.
Ring comb(int teeth, std::mt19937_64 &random) {
    Ring ring{{0, 0}};
    for (int i = 0; i < teeth; ++i) {
        const double x = 2 * i + 1;
        ring.push_back({x, -static_cast<double>(random() % 5) - 1});
        ring.push_back({x + static_cast<double>(random() % 2), 0});
        if (ring.back() == ring[ring.size() - 2]) ring.pop_back();
    }
    const double end = 2 * teeth + 2;
    ring.push_back({end, 0});
    for (int i = teeth; i > 0; --i) {
        ring.push_back({2.0 * i, 4 + static_cast<double>(random() % 5)});
        ring.push_back({2.0 * i - 1, 3});
    }
    ring.push_back({0, 3});
    return ring;
}

/// Around the origin, with radii that are random.
Ring star(int corners, std::mt19937_64 &random) {
    std::uniform_real_distribution<double> radius(1, 10);
    Ring ring;
    for (int i = 0; i < corners; ++i) {
        const double angle = 6.283185307179586 * i / corners, r = radius(random);
        ring.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    return ring;
}

std::vector<std::vector<Ring>> polygons() {
    std::mt19937_64 random(3);
    const Ring square{{0, 0}, {8, 0}, {8, 8}, {0, 8}};
    std::vector<std::vector<Ring>> all{
        {square},
        {square, {{2, 2}, {2, 4}, {4, 4}, {4, 2}}}, // a hole
        {square, {{0, 4}, {4, 2}, {4, 6}}},         // ... that touches in a corner
        {square, {{2, 2}, {2, 4}, {4, 4}, {4, 2}}, {{4, 4}, {6, 4}, {6, 6}}}, // two that touch
        {square, {{8, 8}, {12, 8}, {12, 12}}}, // two parts that touch
        {{{0, 0}, {4, 0}, {4, 4}, {2, 0.5}}},  // level, vertical, flat
        {{{0, 0}, {0, 9}, {1, 1}}, {{3, 0}, {5, 5}, {5, -5}}},
    };
    for (int i = 2; i < 12; ++i) {
        all.push_back({comb(i, random)});
        all.push_back({star(3 * i, random)});
        all.push_back({star(5 * i, random), {{-0.5, -0.5}, {0.5, -0.5}, {0.1, 0.6}}});
    }
    return all;
}

/// By all edges, in rational numbers.
int side_by_all(const std::vector<Ring> &rings, const Point<2> &p) {
    bool odd = false;
    for (const Ring &ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Point<2> &a = ring[i], &b = ring[(i + 1) % ring.size()];
            const Rational turn = (Rational(b[0]) - a[0]) * (Rational(p[1]) - a[1]) -
                                  (Rational(b[1]) - a[1]) * (Rational(p[0]) - a[0]);
            if (turn == 0 && std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) &&
                std::min(a[1], b[1]) <= p[1] && p[1] <= std::max(a[1], b[1]))
                return 0;
            if ((a[1] > p[1]) != (b[1] > p[1]) && (b[1] > a[1]) == (turn > 0)) odd = !odd;
        }
    return odd ? 1 : -1;
}

TEST(Polygon, IsDividedIntoTrapezoidsWithItsArea) {
    for (const auto &rings : polygons()) {
        const Made made(rings);
        Rational area = 0;
        for (const Ring &ring : rings) {
            const Rational one = area_of(ring), size = one < 0 ? Rational(-one) : one;
            const bool is_hole = &ring != &rings[0] && side_by_all({rings[0]}, ring[1]) > 0;
            area += is_hole ? Rational(-size) : size;
        }
        EXPECT_EQ(area_of(*made.polygon), area);
    }
}

TEST(Polygon, KnowsThePlacesInside) {
    std::mt19937_64 random(5);
    for (const auto &rings : polygons()) {
        const Made made(rings);
        for (int i = 0; i < 400; ++i) {
            const Point<2> p{static_cast<double>(random() % 33) / 2 - 4,
                             static_cast<double>(random() % 33) / 2 - 4};
            EXPECT_EQ(made.polygon->side(p), side_by_all(rings, p)) << p[0] << ' ' << p[1];
        }
        for (const Ring &ring : rings)
            for (const Point<2> &corner : ring) EXPECT_EQ(made.polygon->side(corner), 0);
    }
}

TEST(Polygon, OverlapsTrianglesOfWhichItHasAPart) {
    std::mt19937_64 random(7);
    const auto coordinate = [&] { return static_cast<double>(random() % 17) - 4; };
    int found = 0, all = 0;
    for (const auto &rings : polygons()) {
        const Made made(rings);
        for (int i = 0; i < 200; ++i) {
            Point<2> a{coordinate(), coordinate()}, b{coordinate(), coordinate()},
                c{coordinate(), coordinate()};
            const int turn = orientation(a, b, c);
            if (turn == 0) continue;
            if (turn < 0) std::swap(b, c);
            // The parts of the triangle have an area, but for rounding.
            const Piece<2> whole{{{{0, 0}, {b[0] - a[0], b[1] - a[1]}, {c[0] - a[0], c[1] - a[1]}}},
                                 {}};
            double area = 0;
            made.polygon->each_part(made.polygon->box(), [&](const Polygon::Trapezoid &part) {
                clip_trapezoid(whole, part, a, [&](const Piece<2> &p) { area += measure(p); });
            });
            const bool overlaps = made.polygon->overlaps({&a, &b, &c});
            EXPECT_EQ(overlaps, area > 1e-9) << area;
            found += overlaps;
            ++all;
        }
    }
    EXPECT_GT(found, all / 10);
    EXPECT_LT(found, all - all / 10);
}

TEST(Polygon, CutsSegments) {
    std::mt19937_64 random(9);
    const auto coordinate = [&] { return static_cast<double>(random() % 29) / 2 - 4; };
    for (const auto &rings : polygons()) {
        const Made made(rings);
        for (int i = 0; i < 50; ++i) {
            const Point<2> a{coordinate(), coordinate()}, b{coordinate(), coordinate()};
            if (a == b) continue;
            std::vector<Polygon::Stretch> stretches;
            made.polygon->cut(a, b, [&](const Polygon::Stretch &s) { stretches.push_back(s); });
            EXPECT_EQ(made.polygon->overlaps(a, b), !stretches.empty());
            double last = -1;
            for (const auto &s : stretches) {
                EXPECT_LT(last, s.from);
                EXPECT_LT(s.from, s.to);
                last = s.to;
                EXPECT_TRUE(s.from > 0 || s.first == a);
                EXPECT_TRUE(s.to < 1 || s.last == b);
            }
            for (int k = 0; k <= 16; ++k) { // shares that are exact
                const double t = k / 16.0;
                const Point<2> p{a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t};
                const bool is_in =
                    std::any_of(stretches.begin(), stretches.end(), [&](const Polygon::Stretch &s) {
                        return s.from <= t && t <= s.to;
                    });
                const int side = side_by_all(rings, p);
                EXPECT_TRUE(side == 0 || is_in == (side > 0)) << t;
            }
        }
    }
}

TEST(Polygon, MayBeEmpty) {
    const Made made({});
    const Point<2> a{0, 0}, b{1, 0}, c{0, 1};
    EXPECT_EQ(made.polygon->side(a), -1);
    EXPECT_FALSE(made.polygon->overlaps({&a, &b, &c}));
    EXPECT_FALSE(made.polygon->overlaps(a, b));
}

} // namespace
} // namespace abacus
