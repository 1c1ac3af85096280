// Rasters: every value is that of Interpolation at the pixel's centre, to the last bit; except with
// natural neighbours, whose sums have no defined order.
#include "query/places/value_raster.hpp"
#include "support/lattice.hpp"
#include "support/point_sets.hpp"
#include "support/triangulations.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace abacus::test {
namespace {

constexpr std::size_t ample = 64 << 20, little = 60 << 10;

template <int D> double wavy(const Point<D> &p) {
    double sum = 0;
    for (int i = 0; i < D; ++i) sum += std::sin((i + 1) * p[i]);
    return sum;
}

template <int D> std::vector<InputOf<D>> with_values(const std::vector<Point<D>> &points) {
    std::vector<InputOf<D>> input;
    for (std::size_t i = 0; i < points.size(); ++i)
        input.push_back({static_cast<std::int64_t>(i), points[i], {wavy<D>(points[i])}});
    return input;
}

template <int D>
void expect_raster(MeshOf<D> &mesh, const abacus_raster &raster, const abacus_interpolation &how,
                   std::size_t memory) {
    const Host host = mesh.host.host();
    Reader<D> reader(host, mesh.header, ample);
    Interpolation<D> interpolation(host);
    ValueRaster<D> rows(host, mesh.header, raster, how, memory, little);
    int values = 0;
    for (std::uint32_t j = 0; j < raster.height; ++j) {
        const double *row = rows.next();
        ASSERT_NE(row, nullptr);
        for (std::uint32_t i = 0; i < raster.width; ++i) {
            Point<D> p;
            p[0] = raster.lower[0] + (i + 0.5) * (raster.upper[0] - raster.lower[0]) / raster.width;
            p[1] =
                raster.upper[1] - (j + 0.5) * (raster.upper[1] - raster.lower[1]) / raster.height;
            if (D == 3) p[D - 1] = raster.lower[2];
            double expected = 0;
            if (!interpolation.values(reader, how, p, &expected))
                ASSERT_TRUE(std::isnan(row[i])) << i << ", " << j;
            else if (how.method == ABACUS_NATURAL) // sums in any order
                ASSERT_NEAR(expected, row[i], 1e-12) << i << ", " << j;
            else
                ASSERT_EQ(std::memcmp(&expected, row + i, sizeof expected), 0)
                    << i << ", " << j << ": " << row[i] << " for " << expected;
            values += !std::isnan(row[i]);
        }
    }
    ASSERT_EQ(rows.next(), nullptr);
    ASSERT_GT(values, 0);
}

template <int D> void expect_rasters(MeshOf<D> &mesh, double extent, bool is_delaunay) {
    abacus_interpolation how{};
    how.attributes = 1;
    for (const bool is_lattice : {true, false}) {
        abacus_raster raster{};
        for (int i = 0; i < 2; ++i) {
            raster.lower[i] = is_lattice ? -0.75 : -0.1 * extent;
            raster.upper[i] = is_lattice ? std::round(extent) + 0.75 : 1.07 * extent;
        }
        raster.lower[2] = raster.upper[2] = is_lattice ? 1 : 0.45 * extent;
        // On the lattice the centres are vertices, and points halfway between them.
        const auto cells = static_cast<std::uint32_t>(2 * (std::round(extent) + 1.5));
        raster.width = is_lattice ? cells : 61;
        raster.height = is_lattice ? cells : 47;
        for (const abacus_method method : {ABACUS_LINEAR, ABACUS_NATURAL, ABACUS_NEAREST})
            for (const abacus_outside outside : {ABACUS_OUTSIDE_NOTHING, ABACUS_OUTSIDE_NEAREST})
                for (const double max_edge : {0.0, D == 2 ? 1.45 : 1.8})
                    for (const std::size_t memory : {std::size_t(100), ample}) {
                        if (method == ABACUS_NATURAL && !is_delaunay) continue;
                        if (method != ABACUS_LINEAR && memory == 100) continue;
                        how.method = method;
                        how.outside = outside;
                        how.extent.max_edge = max_edge;
                        expect_raster<D>(mesh, raster, how, memory);
                        if (testing::Test::HasFatalFailure()) return;
                    }
    }
}

template <int D> void expect_rasters_of_delaunay() {
    const int n = D == 2 ? 14 : 5;
    MeshOf<D> lattice(1);
    ASSERT_EQ(lattice.insert(with_values<D>(grid<D>(n))), ABACUS_OK);
    expect_rasters<D>(lattice, n - 1, true);
    Random random(1);
    std::vector<Point<D>> points(D == 2 ? 1500 : 400);
    for (auto &p : points)
        for (double &x : p) x = 8 * unit(random);
    MeshOf<D> scattered(1);
    ASSERT_EQ(scattered.insert(with_values<D>(points)), ABACUS_OK);
    expect_rasters<D>(scattered, 8, true);
}

TEST(ValueRaster, EqualsInterpolationInThePlane) { expect_rasters_of_delaunay<2>(); }
TEST(ValueRaster, EqualsInterpolationInAPlaneOfSpace) { expect_rasters_of_delaunay<3>(); }

TEST(ValueRaster, OfMeshesWithHoles) {
    auto t = keeping<2>(delaunay<2>(grid<2>(14)), [](const Point<2> &c) {
        return static_cast<int>(std::hypot(c[0] - 6, c[1] - 6)) % 3 != 0;
    });
    flip(t, 60, 2);
    for (auto &v : t.vertices) v.attributes = {wavy<2>(v.point)};
    Mesh mesh(1);
    ASSERT_EQ(mesh.load(t.vertices, t.simplices), ABACUS_OK) << mesh.error.message;
    ASSERT_NE(mesh.header.facts.standing, 0u);
    expect_rasters<2>(mesh, 13, false);
}

/// Slivers, whose borders in a row are hard to find with doubles.
TEST(ValueRaster, OfSlivers) {
    std::vector<Point<2>> points;
    Random random(6);
    for (int i = 0; i < 400; ++i)
        points.push_back(
            {1e6 + 100 * unit(random), 4e6 + 1e-9 * static_cast<double>(random() % 4000000000)});
    for (int i = 0; i < 50; ++i) points.push_back({1e6 + 2 * i, 4e6 + 1e-7 * i});
    Mesh mesh(1);
    ASSERT_EQ(mesh.insert(with_values<2>(points)), ABACUS_OK);
    abacus_interpolation how{};
    how.attributes = 1;
    how.extent = {};
    expect_raster<2>(mesh, {{1e6 - 1, 4e6 - 1e-7}, {1e6 + 101, 4e6 + 2e-6}, 80, 80, 0}, how, ample);
    expect_raster<2>(mesh, {{1e6 - 1, 4e6 - 1}, {1e6 + 101, 4e6 + 5}, 80, 80, 0}, how, ample);
}

} // namespace
} // namespace abacus::test
