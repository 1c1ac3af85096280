// Meshes that change everywhere: each page is loaded and stored about once, and pages stay as full
// as those of a mesh built from the same points.
#include "keys/domain_of.hpp"
#include "points/vertex_reader.hpp"
#include "staging/density.hpp"
#include "support/oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace abacus::test {
namespace {

template <class Dimension> class Grow : public testing::Test {
protected:
    static constexpr int D = Dimension::value;
    /// So many that insertion uses rounds unless a mesh replaces them.
    static constexpr std::size_t many = D == 2 ? 30000 : 8000;
    static constexpr std::size_t ample = 64 << 20, little = D == 2 ? 2 << 20 : 3 << 20;

    /// Points of the unit square or cube; ids are their numbers.
    std::vector<InputOf<D>> uniform(std::size_t n, unsigned seed) {
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> unit(0, 1);
        std::vector<Point<D>> points(n);
        for (Point<D> &p : points)
            for (double &x : p) x = unit(random);
        return number<D>(points);
    }
    static std::vector<InputOf<D>> part(const std::vector<InputOf<D>> &points, std::size_t from,
                                        std::size_t to) {
        return {points.begin() + static_cast<std::ptrdiff_t>(from),
                points.begin() + static_cast<std::ptrdiff_t>(to)};
    }
    /// Compares with a mesh made from the same points at once.
    static void expect_as_fresh(MeshOf<D> &mesh, const std::vector<InputOf<D>> &points,
                                double pages) {
        MeshOf<D> fresh(0, mesh.cache_bytes);
        ASSERT_EQ(fresh.insert(points), ABACUS_OK);
        EXPECT_EQ(mesh.positions(), fresh.positions());
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        EXPECT_LE(double(mesh.host.pages.size()), pages * double(fresh.host.pages.size()));
        EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
    }
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Grow, Dimensions);

TYPED_TEST(Grow, AsManyPointsAgainAreOneRound) {
    constexpr auto many = TestFixture::many;
    const auto points = this->uniform(2 * many, 1);
    for (const std::size_t cache : {TestFixture::ample, TestFixture::little}) {
        MeshOf<TestFixture::D> mesh(0, cache);
        ASSERT_EQ(mesh.insert(this->part(points, 0, many)), ABACUS_OK);
        const auto before = mesh.host.pages.size();
        mesh.header.counters = {};
        ASSERT_EQ(mesh.insert(this->part(points, many, 2 * many)), ABACUS_OK);
        const abacus_counters &counters = mesh.header.counters;
        const double again = cache == TestFixture::ample ? 1.0 : 2.2;
        EXPECT_LE(double(counters.loads), again * double(before));
        EXPECT_LE(double(counters.stores), again * double(mesh.host.pages.size()));
        this->expect_as_fresh(mesh, points, 1.15);
    }
}

// Points that memory cannot hold are distributed over rounds as they come in, and once more if the
// mesh turns out to replace the rounds.
TYPED_TEST(Grow, MorePointsThanMemoryHoldsAreOneRound) {
    constexpr int D = TypeParam::value;
    constexpr auto many = TestFixture::many;
    constexpr std::size_t scarce = (D == 2 ? 1024 : 512) << 10;
    const auto points = this->uniform(2 * many, 5);
    const auto more = this->part(points, many, 2 * many);
    for (const std::size_t memory : {TestFixture::ample, scarce}) {
        MeshOf<D> mesh;
        ASSERT_EQ(mesh.insert(this->part(points, 0, many)), ABACUS_OK);
        ASSERT_EQ(mesh.stage(more, memory), ABACUS_OK);
        EXPECT_EQ(mesh.host.calls.spool_create > 0, memory == scarce);
        ASSERT_EQ(mesh.header.facts.census.staged, many);
        const Host host = mesh.host.host();
        VertexReader<D> waiting(host, 0, 0, many);
        const Domain<D> domain = domain_of<D>(mesh.header.facts.form);
        std::vector<std::uint64_t> codes;
        std::set<std::int64_t> ids;
        while (waiting.advance()) {
            codes.push_back(domain.code(waiting.point()));
            ids.insert(waiting.id());
        }
        EXPECT_TRUE(std::is_sorted(codes.begin(), codes.end()));
        EXPECT_EQ(ids.size(), many);
        EXPECT_EQ(*ids.begin(), std::int64_t{many});
        ASSERT_EQ(mesh.build(), ABACUS_OK);
        this->expect_as_fresh(mesh, points, 1.15);
    }
}

TYPED_TEST(Grow, ExchangedPointsLeaveThePagesFull) {
    constexpr auto many = TestFixture::many;
    constexpr std::size_t some = many / 20;
    const auto points = this->uniform(many + 10 * some, 2);
    for (const std::size_t cache : {TestFixture::ample, TestFixture::little}) {
        MeshOf<TestFixture::D> mesh(0, cache);
        ASSERT_EQ(mesh.insert(this->part(points, 0, many)), ABACUS_OK);
        for (std::size_t i = 0; i < 10; ++i) {
            std::uint64_t deleted = 0;
            ASSERT_EQ(mesh.remove(this->part(points, i * some, (i + 1) * some), deleted),
                      ABACUS_OK);
            ASSERT_EQ(deleted, some);
            ASSERT_EQ(mesh.insert(this->part(points, many + i * some, many + (i + 1) * some)),
                      ABACUS_OK);
        }
        // In space a small cache evicts blocks before their neighbours on the curve are finished.
        const bool is_poor = TestFixture::D == 3 && cache == TestFixture::little;
        this->expect_as_fresh(mesh, this->part(points, 10 * some, many + 10 * some),
                              is_poor ? 1.35 : 1.15);
    }
}

// A page that is filled from the next one, and cut at the next change, is written twice for
// nothing.
TYPED_TEST(Grow, ExchangedPointsCutFewPages) {
    constexpr auto many = TestFixture::many;
    constexpr std::size_t some = many / 20, rounds = 24;
    const auto points = this->uniform(many + rounds * some, 2);
    MeshOf<TestFixture::D> mesh(0, TestFixture::ample);
    ASSERT_EQ(mesh.insert(this->part(points, 0, many)), ABACUS_OK);
    const auto pages = mesh.host.pages.size();
    mesh.header.counters = {};
    for (std::size_t i = 0; i < rounds; ++i) {
        std::uint64_t deleted = 0;
        ASSERT_EQ(mesh.remove(this->part(points, i * some, (i + 1) * some), deleted), ABACUS_OK);
        ASSERT_EQ(mesh.insert(this->part(points, many + i * some, many + (i + 1) * some)),
                  ABACUS_OK);
    }
    // Each round deletes a twentieth of the points everywhere, and inserts as many.
    EXPECT_LE(mesh.header.counters.splits, rounds / 8 * pages);
}

TYPED_TEST(Grow, OnlyAMeshWhereThePointsAreStandsIn) {
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh;
    mesh.header.facts.form.has_domain = 1;
    mesh.header.facts.form.upper[0] = 2;
    for (int i = 1; i < D; ++i) mesh.header.facts.form.upper[i] = 1;
    ASSERT_EQ(mesh.insert(this->uniform(TestFixture::many, 3)), ABACUS_OK);
    Point<D> lower{}, upper;
    upper.fill(1);
    upper[0] = 2;
    const Domain<D> domain(lower, upper);
    const Host host = mesh.host.host();
    // 100 points, `outside` of them in the empty half; each needs this many vertices.
    const auto dense = [&](int outside, double vertices_each) {
        Arena<std::uint64_t> codes(host);
        const auto sample = this->uniform(100, 4);
        for (int i = 0; i < 100; ++i) {
            Point<D> p = sample[i].point;
            if (i < outside) p[0] += 1;
            codes.push_back(domain.code(p));
        }
        return is_dense(host, codes, vertices_each);
    };
    EXPECT_TRUE(dense(0, 16));
    EXPECT_TRUE(dense(5, 16));
    EXPECT_FALSE(dense(20, 16));
    EXPECT_FALSE(dense(100, 16));
    EXPECT_FALSE(dense(0, 1000));

    // An invalid page: the load that needs it reports more.
    mesh.host.pages.begin()->second.size = 8;
    EXPECT_FALSE(dense(0, 16));
}

} // namespace
} // namespace abacus::test
