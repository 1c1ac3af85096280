// The earthquake points are the nodes of a stored octree, made like any other: by sizes, then
// balanced.
#include "octree/octree_nodes.hpp"
#include "quake/quake_points.hpp"
#include "support/octree_model.hpp"

#include <gtest/gtest.h>

#include <bit>

namespace abacus::test {
namespace {

constexpr double frequency = 0.04, points_per_wavelength = 8;

/// Octants within the basin are as small as their wavelength requires.
abacus_host_status size_of(void *, std::size_t count, const double *const *centers,
                           const double *edges, double *sizes) {
    for (std::size_t k = 0; k < count; ++k) {
        const double half = edges[k] / 2;
        const double x = centers[0][k], y = centers[1][k], z = centers[2][k];
        if (x - half >= Basin::width || y - half >= Basin::width || z - half >= 0)
            sizes[k] = edges[k];
        else if (edges[k] > Basin::width / 8)
            sizes[k] = 0;
        else
            sizes[k] = Basin::slowest({x - half, x + half, y - half, y + half, z + half}) /
                       (frequency * points_per_wavelength);
    }
    return ABACUS_HOST_OK;
}

TEST(QuakeOctree, has_the_earthquake_points_as_nodes) {
    StoredOctree<3> octree;
    octree.header.facts.form.lower[2] = -Basin::depth;
    for (int i = 0; i < 3; ++i)
        octree.header.facts.form.upper[i] = octree.header.facts.form.lower[i] + 2 * Basin::width;
    const Host h = octree.host->host();
    {
        Growth<3> growth(h, octree.header, octree.memory);
        growth.to_sizes(size_of, nullptr, 1, octree.header);
    }
    octree.balance(2);
    QuakePoints points(frequency, points_per_wavelength);
    OctreeNodes<3> nodes(h, octree.header, octree.memory);
    const Grid<3> grid(octree.header.facts.form);
    std::int64_t count = 0;
    for (OctreeNodes<3>::Node node; nodes.next(node);) {
        Point<3> place;
        for (int i = 0; i < 3; ++i) place[i] = grid.line(i, node.point[i]);
        if (place[0] > Basin::width || place[1] > Basin::width || place[2] > 0) continue;
        QuakePoint point;
        ASSERT_TRUE(points.next(point));
        ASSERT_EQ(point.id, ++count);
        ASSERT_EQ(std::bit_cast<std::uint64_t>(place[0]), std::bit_cast<std::uint64_t>(point.x));
        ASSERT_EQ(std::bit_cast<std::uint64_t>(place[1]), std::bit_cast<std::uint64_t>(point.y));
        ASSERT_EQ(std::bit_cast<std::uint64_t>(place[2]), std::bit_cast<std::uint64_t>(point.z));
    }
    QuakePoint more;
    EXPECT_FALSE(points.next(more));
    EXPECT_GT(count, 10000);
}

} // namespace
} // namespace abacus::test
