// abacus_check on meshes of tetrahedra: a sound one has no fault, and every flipped bit is a fault.
#include "support/oracle.hpp"
#include "support/staged_points.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace abacus {
namespace {

struct Solid {
    explicit Solid(const std::vector<Point<3>> &points) {
        abacus_error error{};
        EXPECT_EQ(stage<3>(host, header, with_ids<3>(points), ample, error), ABACUS_OK);
        abacus_build *build = nullptr;
        EXPECT_EQ(abacus_build_open(host.table(), &header.facts, ample, &build, &error), ABACUS_OK);
        EXPECT_EQ(abacus_build_run(build, 0, &header, &error), ABACUS_OK) << error.detail;
        abacus_build_close(build);
        EXPECT_EQ(faults(), 0);
    }
    /// -1 if the check itself fails.
    int faults() {
        abacus_error error{};
        abacus_check *check = nullptr;
        if (abacus_check_open(host.table(), &header.facts, ample, 10, &check, &error) != ABACUS_OK)
            return -1;
        int count = 0;
        for (abacus_fault fault; abacus_check_next(check, &fault) == ABACUS_OK;) ++count;
        abacus_check_close(check);
        return count;
    }
    MemoryHost host;
    abacus_header header = empty_header<3>();
};

TEST(CheckInSpace, FindsNothingInSoundMeshes) {
    for (const Kind kind : all_kinds) {
        SCOPED_TRACE(static_cast<int>(kind));
        Solid solid(points<3>(kind, 600));
        EXPECT_EQ(solid.host.bytes, 0u);
        EXPECT_TRUE(solid.host.violations.empty());
    }
}

TEST(CheckInSpace, LoadsPagesAFewTimesWhereVerticesHaveMostOfThem) {
    // An arc and its axis: every edge of the one with every edge of the other makes a tetrahedron,
    // so each vertex of the arc is in as many pages as the axis has vertices.
    constexpr int n = 400;
    std::vector<Point<3>> points;
    for (int i = 0; i < n; ++i) {
        const double angle = 0.3 + 2.0 * i / n;
        points.push_back({std::cos(angle), std::sin(angle), 0});
        points.push_back({0, 0, (2.0 * i + 1) / n - 1});
    }
    test::MeshOf<3> mesh;
    ASSERT_EQ(mesh.insert(test::number<3>(points)), ABACUS_OK) << mesh.error.detail;
    ASSERT_EQ(mesh.header.facts.census.simplices, std::uint64_t(n - 1) * (n - 1));
    mesh.cache_bytes = 8 << 20; // some two thirds of the pages
    const std::uint64_t before = mesh.host.calls.find;
    EXPECT_EQ(mesh.check(), std::vector<std::string>{});
    EXPECT_GT(mesh.host.calls.find - before, mesh.host.pages.size());
    EXPECT_LT(mesh.host.calls.find - before, 8 * mesh.host.pages.size());
}

TEST(CheckInSpace, FindsEveryFlippedBitOfASinglePage) {
    Solid solid(points<3>(Kind::uniform, 20));
    ASSERT_EQ(solid.host.pages.size(), 1u);
    MemoryHost::Page &page = solid.host.pages.begin()->second;
    for (std::size_t bit = 0; bit < 8 * page.size; ++bit) {
        page.bytes()[bit / 8] ^= 1 << bit % 8;
        ASSERT_GT(solid.faults(), 0) << "bit " << bit % 8 << " of byte " << bit / 8;
        page.bytes()[bit / 8] ^= 1 << bit % 8;
    }
}

TEST(CheckInSpace, FindsFlippedBitsAnywhere) {
    Solid solid(points<3>(Kind::uniform, 700));
    ASSERT_GT(solid.host.pages.size(), 5u);
    std::mt19937_64 random(1);
    for (int round = 0; round < 150; ++round) {
        auto &[key, page] = *std::next(solid.host.pages.begin(),
                                       std::ptrdiff_t(random() % solid.host.pages.size()));
        const std::size_t bit = random() % (8 * (round % 2 ? page.size : 96));
        page.bytes()[bit / 8] ^= 1 << bit % 8;
        ASSERT_GT(solid.faults(), 0) << "bit " << bit;
        page.bytes()[bit / 8] ^= 1 << bit % 8;
    }
}

} // namespace
} // namespace abacus
