// Voronoi cells, compared with brute force: half-spaces cut one by one from the window.
#include "geometry/distance.hpp"
#include "support/oracle.hpp"
#include "support/point_sets.hpp"

#include <abacus/shapes.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace abacus::test {
namespace {

struct Cells {
    std::map<std::int64_t, abacus_voronoi_cell> cell;
    std::map<std::int64_t, std::vector<double>> ring;
    std::map<std::pair<std::int64_t, std::int64_t>, double> facet;
    std::map<std::int64_t, double> sides; ///< of the window, over all cells
    double sum = 0;
};

template <int D> Cells read(MeshOf<D> &mesh, const abacus_window &window, std::size_t cache_bytes) {
    const abacus_host *const host = mesh.host.table();
    Cells cells;
    abacus_voronoi *voronoi = nullptr;
    abacus_error error{};
    const auto open = [&] {
        EXPECT_EQ(
            abacus_voronoi_open(host, &mesh.header.facts, &window, cache_bytes, &voronoi, &error),
            ABACUS_OK)
            << error.message;
    };
    open();
    abacus_voronoi_cell cell;
    while (abacus_voronoi_next(voronoi, &cell, &error) == ABACUS_OK) {
        EXPECT_TRUE(cells.cell.emplace(cell.vertex, cell).second) << "twice";
        cells.ring[cell.vertex].assign(cell.ring, cell.ring + cell.corners * D);
        cells.sum += D == 2 ? cell.area : cell.volume;
    }
    abacus_voronoi_close(voronoi);
    open();
    abacus_voronoi_facet facet;
    while (abacus_voronoi_next_facet(voronoi, &facet, &error) == ABACUS_OK) {
        if (facet.has_neighbour)
            cells.facet[{facet.vertex, facet.neighbour}] += facet.size;
        else
            cells.sides[facet.vertex] += facet.size;
    }
    abacus_voronoi_close(voronoi);
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
    EXPECT_EQ(mesh.host.bytes, 0u);
    return cells;
}

/// The area left of a window after cutting off everything that is nearer to another point.
double area_by_hand(const std::vector<Point<2>> &points, std::size_t n, const abacus_window &w) {
    using Ring = std::vector<std::array<long double, 2>>;
    Ring ring{{w.lower[0], w.lower[1]},
              {w.upper[0], w.lower[1]},
              {w.upper[0], w.upper[1]},
              {w.lower[0], w.upper[1]}};
    for (const Point<2> &q : points) {
        if (q == points[n]) continue;
        const auto excess = [&](const auto &at) {
            long double sum = 0;
            for (int i = 0; i < 2; ++i) {
                const long double edge = static_cast<long double>(q[i]) - points[n][i];
                sum += (at[i] - points[n][i] - edge / 2) * edge;
            }
            return sum;
        };
        Ring left;
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const auto &a = ring[i], &b = ring[(i + 1) % ring.size()];
            const long double s = excess(a), t = excess(b);
            if (s <= 0) left.push_back(a);
            if ((s <= 0) != (t <= 0))
                left.push_back(
                    {a[0] + (b[0] - a[0]) * (s / (s - t)), a[1] + (b[1] - a[1]) * (s / (s - t))});
        }
        ring = left;
    }
    long double sum = 0;
    for (std::size_t i = 1; i + 1 < ring.size(); ++i)
        sum += (ring[i][0] - ring[0][0]) * (ring[i + 1][1] - ring[0][1]) -
               (ring[i + 1][0] - ring[0][0]) * (ring[i][1] - ring[0][1]);
    return static_cast<double>(sum / 2);
}

template <int D> std::vector<Point<D>> points_of(int kind, int n, unsigned seed) {
    Random random(seed);
    std::vector<Point<D>> points;
    const int side = D == 2 ? 12 : 5;
    for (int i = 0; i < n; ++i) {
        Point<D> p{};
        double square = 0;
        for (int axis = 0, rest = i; axis < D; ++axis, rest /= side) {
            p[axis] = kind == 1 ? rest % side : unit(random) * 10;
            square += (p[axis] - 5) * (p[axis] - 5);
        }
        if (kind == 2) // on a sphere, and some inside
            for (double &x : p) x = 5 + (x - 5) * (i % 10 == 0 ? 1 : 4 / std::sqrt(square));
        if (kind == 3) // near a line
            for (int axis = 1; axis < D; ++axis) p[axis] = p[0] / axis + p[axis] * 1e-7;
        points.push_back(p);
    }
    return points;
}

/// Infinite or almost equal.
MATCHER_P(RoundsLike, expected, "") {
    return arg == expected ||
           std::abs(arg - expected) <= 1e-9 * std::abs(expected) + 16 * 0x1p-1074;
}

template <int D> double content(const abacus_window &w) {
    double product = 1;
    for (int i = 0; i < D; ++i) product *= w.upper[i] - w.lower[i];
    return product;
}

template <int D> void expect_cells(int kind) {
    SCOPED_TRACE(kind);
    const auto points = points_of<D>(kind, D == 2 ? 144 : 125, 7);
    MeshOf<D> mesh(0);
    ASSERT_EQ(mesh.stage(number<D>(points)), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.message;
    const auto input = number<D>(points);
    Random random(kind);
    for (int i = 0; i < (D == 2 ? 12 : 8); ++i) {
        abacus_window window{};
        window.kind = ABACUS_BOX_WINDOW;
        for (int axis = 0; axis < D; ++axis) {
            const double size = i < 3 ? 30 : i < 8 ? 4 : 0.3, at = unit(random) * 14 - 2;
            window.lower[axis] = i == 3 ? 2 : at - size / 2;
            window.upper[axis] = i == 3 ? 5.5 : at + size / 2;
        }
        SCOPED_TRACE(i);
        const Cells cells = read<D>(mesh, window, i % 2 == 0 ? 1 << 20 : 1 << 10);
        EXPECT_NEAR(cells.sum / content<D>(window), 1, 1e-9);
        if constexpr (D == 2)
            for (std::size_t n = 0; n < points.size(); ++n) {
                const double expected = area_by_hand(points, n, window);
                const auto found = cells.cell.find(input[n].id);
                const double area = found == cells.cell.end() ? 0 : found->second.area;
                EXPECT_NEAR(area, expected, 1e-9 * content<2>(window)) << n;
            }
        // If a side of the window is a bisector, only one of the two neighbours has a part.
        if (i == 3) continue;
        for (const auto &[ends, size] : cells.facet) {
            const auto back = cells.facet.find({ends.second, ends.first});
            EXPECT_NEAR(back == cells.facet.end() ? 0 : back->second, size, 1e-6)
                << ends.first << " " << ends.second;
        }
    }
}

TEST(Voronoi, CellsOfAWindowInThePlane) {
    for (int kind = 0; kind < 4; ++kind) expect_cells<2>(kind);
}
TEST(Voronoi, CellsOfAWindowInSpace) {
    for (int kind = 0; kind < 4; ++kind) expect_cells<3>(kind);
}

template <int D> void expect_grid() {
    const auto points = points_of<D>(1, D == 2 ? 144 : 125, 0);
    const int side = D == 2 ? 12 : 5;
    MeshOf<D> mesh(0);
    ASSERT_EQ(mesh.stage(number<D>(points)), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    int bounded = 0;
    const Cells cells = read<D>(mesh, abacus_window{}, 1 << 10);
    EXPECT_EQ(cells.cell.size(), points.size());
    for (const auto &[vertex, cell] : cells.cell) {
        bounded += cell.bounded;
        if (!cell.bounded) {
            EXPECT_TRUE(std::isinf(cell.area));
            EXPECT_EQ(cell.corners, 0u);
        } else if constexpr (D == 2) {
            EXPECT_EQ(cell.area, 1);
            EXPECT_EQ(cell.corners, 4u) << "repeated corners";
        } else {
            EXPECT_NEAR(cell.volume, 1, 1e-15);
            EXPECT_NEAR(cell.area, 6, 1e-14);
        }
    }
    EXPECT_EQ(bounded, D == 2 ? 100 : (side - 2) * (side - 2) * (side - 2));
}

TEST(Voronoi, CornersOfAGridComeOnce) {
    expect_grid<2>();
    expect_grid<3>();
}

/// Points on one circle around their centre: its cell is a regular polygon.
TEST(Voronoi, CocircularPointsHaveOneCorner) {
    std::vector<Point<2>> points;
    // Pythagorean: 5² = 3² + 4², 25² = 7² + 24² = 15² + 20², all exactly on the circle.
    for (const auto &[a, b] : {std::pair{25, 0}, {24, 7}, {20, 15}, {15, 20}, {7, 24}, {0, 25}})
        for (const int s : {-1, 1})
            for (const int t : {-1, 1}) {
                const Point<2> p{0.1 + s * a * 0x1p-10, 0.7 + t * b * 0x1p-10};
                if (std::find(points.begin(), points.end(), p) == points.end()) points.push_back(p);
            }
    MeshOf<2> mesh(0);
    ASSERT_EQ(mesh.stage(number<2>(points)), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    abacus_window window{};
    window.kind = ABACUS_BOX_WINDOW;
    window.lower[0] = -1, window.lower[1] = -1, window.upper[0] = 2, window.upper[1] = 2;
    const Cells cells = read<2>(mesh, window, 1 << 20);
    EXPECT_EQ(cells.cell.size(), points.size());
    EXPECT_NEAR(cells.sum, 9, 1e-12);
}

/// All coordinates times a power of two, also one whose square no double holds: the same cells.
template <int D> void expect_same_at(int exponent) {
    SCOPED_TRACE(exponent);
    const auto cells_at = [](int scale, bool has_window) {
        auto points = points_of<D>(0, D == 2 ? 40 : 20, 3);
        for (auto &p : points)
            for (double &x : p) x = std::ldexp(x, scale);
        MeshOf<D> mesh(0);
        EXPECT_EQ(mesh.stage(number<D>(points)), ABACUS_OK);
        EXPECT_EQ(mesh.build(), ABACUS_OK) << mesh.error.message;
        abacus_window window{};
        if (has_window) window.kind = ABACUS_BOX_WINDOW;
        std::fill_n(window.lower, D, std::ldexp(2, scale));
        std::fill_n(window.upper, D, std::ldexp(5, scale));
        return read<D>(mesh, window, 1 << 20);
    };
    for (const bool has_window : {false, true}) {
        const Cells expected = cells_at(0, has_window), cells = cells_at(exponent, has_window);
        ASSERT_EQ(cells.cell.size(), expected.cell.size());
        ASSERT_EQ(cells.facet.size(), expected.facet.size());
        for (const auto &[id, cell] : expected.cell) {
            const abacus_voronoi_cell &found = cells.cell.at(id);
            const auto at_scale = [&](double x, int dimension) {
                return std::ldexp(x, dimension * exponent);
            };
            EXPECT_THAT(found.area, RoundsLike(at_scale(cell.area, 2))) << id;
            EXPECT_THAT(found.volume, RoundsLike(at_scale(cell.volume, 3))) << id;
            const auto &ring = cells.ring.at(id), &wanted = expected.ring.at(id);
            ASSERT_EQ(ring.size(), wanted.size()) << id;
            for (std::size_t i = 0; i < ring.size(); ++i)
                EXPECT_THAT(ring[i], RoundsLike(at_scale(wanted[i], 1))) << id;
        }
        for (const auto &[ends, size] : expected.facet)
            EXPECT_THAT(cells.facet.at(ends), RoundsLike(std::ldexp(size, (D - 1) * exponent)));
    }
}

TEST(Voronoi, CellsDoNotDependOnTheScale) {
    for (const int exponent : {-1000, -565, -380, -270, 340, 565, 1015}) {
        expect_same_at<2>(exponent);
        expect_same_at<3>(exponent);
    }
}

TEST(Voronoi, OfAnEmptyMeshAreNone) {
    MeshOf<2> mesh(0);
    ASSERT_EQ(mesh.stage(number<2>(std::vector<Point<2>>{{0, 0}, {1, 1}})), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    EXPECT_TRUE(read<2>(mesh, abacus_window{}, 1 << 20).cell.empty());
}

} // namespace
} // namespace abacus::test
