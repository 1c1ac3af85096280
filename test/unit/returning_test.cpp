// Changes report all simplices that they have created and removed.
#include "support/returned.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace abacus::test {
namespace {

constexpr std::size_t little = 60 << 10, ample = 64 << 20;

template <class Dimension> class Returning : public testing::Test {
protected:
    static constexpr int D = Dimension::value;
    using Points = std::vector<InputOf<D>>;

    Points uniform(std::size_t n, double from = 0, double edge = 1) {
        std::uniform_real_distribution<double> unit(0, 1);
        Points points;
        for (std::size_t i = 0; i < n; ++i) {
            Point<D> p;
            for (double &x : p) x = from + edge * unit(random);
            points.push_back({next_id++, p, {unit(random)}});
        }
        return points;
    }
    /// Points at a few places: most equal others, and many are cospherical.
    Points grid(std::size_t n) {
        Points points = uniform(n, 0, D == 2 ? 12 : 5);
        for (InputOf<D> &p : points)
            for (double &x : p.point) x = std::floor(x);
        return points;
    }
    Points some(const Points &points, std::size_t each) {
        Points chosen;
        for (std::size_t i = 0; i < points.size(); i += each) chosen.push_back(points[i]);
        return chosen;
    }

    std::mt19937_64 random{11};
    std::int64_t next_id = 0;
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Returning, Dimensions);

TYPED_TEST(Returning, IsTheDifferenceOfBeforeAndAfter) {
    for (const std::size_t cache : {little, ample}) {
        MeshOf<TypeParam::value> mesh(1, cache);
        Returned<TypeParam::value> returned(mesh);
        const auto points = this->uniform(2000);
        returned.insert(points);
        EXPECT_EQ(returned.rows.size(),
                  mesh.header.facts.census.simplices); // without those that were removed again
        returned.insert(this->uniform(1));
        EXPECT_LT(returned.rows.size(), 400u);
        EXPECT_GT(returned.rows.size(), 2u);
        returned.insert(this->uniform(300));
        returned.remove(this->some(points, 7));
        returned.remove(points);
        returned.insert({});
        EXPECT_TRUE(returned.rows.empty());
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
    }
}

TYPED_TEST(Returning, WithinLittleMemory) {
    // More than the log and the sort can hold, so with spools.
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(1);
    Returned<D> returned(mesh, 1);
    const auto points = this->uniform(D == 2 ? 6000 : 1500);
    mesh.host.spooled_bytes = 0;
    returned.insert(points);
    EXPECT_GT(mesh.host.spooled_bytes, 0u);
    returned.remove(this->some(points, 3));
}

TYPED_TEST(Returning, OfEqualPointsAnotherVertexMakesAnotherSimplex) {
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(1);
    Returned<D> returned(mesh);
    const auto points = this->grid(600);
    returned.insert(points);
    auto others = points; // at the same places: they all stay beside the vertices
    for (auto &p : others) p.id = this->next_id++;
    returned.insert(others);
    EXPECT_TRUE(returned.rows.empty());
    returned.insert(this->grid(40), ABACUS_REPLACE);
    EXPECT_FALSE(returned.rows.empty());
    returned.remove(this->some(points, 2));
    EXPECT_EQ(mesh.check(), std::vector<std::string>{});
}

TYPED_TEST(Returning, OfPointsThatWaitedOrWillWait) {
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(1);
    Returned<D> returned(mesh);
    typename TestFixture::Points line;
    for (int i = 0; i < 50; ++i) {
        Point<D> p{};
        p[0] = i;
        line.push_back({this->next_id++, p, {0.5}});
    }
    returned.insert(line);
    EXPECT_TRUE(returned.rows.empty());
    const auto points = this->uniform(D - 1, 1, 7);
    returned.insert(points); // spans simplices with the waiting points
    EXPECT_FALSE(returned.rows.empty());
    returned.remove(points); // removes them all
    EXPECT_FALSE(returned.rows.empty());
    EXPECT_EQ(mesh.header.facts.census.simplices, 0u);
    EXPECT_TRUE(std::none_of(returned.rows.begin(), returned.rows.end(),
                             [](const auto &row) { return row.created; }));
}

TYPED_TEST(Returning, WhereTheMeshIsMadeAnew) {
    // With another domain; and with deletions that cost more than triangulating the rest.
    constexpr int D = TypeParam::value;
    for (const std::size_t memory : {std::size_t(1), std::size_t(4) << 20}) {
        MeshOf<D> mesh(1);
        Returned<D> returned(mesh, memory);
        returned.insert(this->uniform(300));
        bool domain_changed = false;
        for (double edge = 10; edge < 1e5; edge *= 10) {
            returned.insert(this->uniform(300, 0, edge));
            domain_changed |= returned.domain_changed;
        }
        EXPECT_TRUE(domain_changed);

        MeshOf<D> crowded(1);
        Returned<D> rest(crowded, memory);
        typename TestFixture::Points crowd;
        const int n = D == 2 ? 5000 : 900;
        for (int i = 0; i < n; ++i) {
            const double angle = 6.283185307179586 * i / n;
            Point<D> p{};
            p[0] = std::cos(angle);
            p[1] = std::sin(angle);
            if (D == 3) p[2] = 0.25 * std::sin(5 * angle);
            crowd.push_back({this->next_id++, p, {0.5}});
        }
        rest.insert(crowd);
        auto hubs = this->uniform(200, 1000, 1500); // each is a neighbour of many others
        for (std::size_t i = 0; i < hubs.size(); i += 2)
            hubs[i].point[1] = -hubs[i].point[0] - hubs[i].point[1];
        rest.insert(hubs);
        const std::uint64_t removals = crowded.header.counters.removals;
        rest.remove(hubs);
        EXPECT_LT(crowded.header.counters.removals - removals, hubs.size());
        EXPECT_EQ(crowded.check(), std::vector<std::string>{});
    }
}

TYPED_TEST(Returning, EndsWellWhateverFails) {
    constexpr int D = TypeParam::value;
    const auto points = this->uniform(400);
    for (const bool memory : {false, true})
        for (std::uint64_t n = 1, failures = 1; failures > 0; n += 1 + n / 4) {
            MeshOf<D> mesh(1, little);
            memory ? mesh.host.fail_resize_at(n) : mesh.host.fail_at(n);
            const abacus_status status = mesh.with_stage(points, 1 << 20, [&](abacus_stage *stage) {
                const abacus_status ended =
                    abacus_stage_end(stage, &mesh.header.facts, &mesh.error);
                if (ended != ABACUS_OK) return ended;
                return mesh.with_build([&](abacus_build *build) {
                    abacus_status step = abacus_build_log(build, 1, &mesh.error);
                    if (step == ABACUS_OK)
                        step = abacus_build_insert(build, stage, ABACUS_KEEP, &mesh.header,
                                                   &mesh.error);
                    const auto ignore = [](void *, int, const abacus_simplex *) {
                        return ABACUS_HOST_OK;
                    };
                    if (step == ABACUS_OK)
                        step = abacus_build_report(build, ignore, nullptr, &mesh.error);
                    return step;
                });
            });
            failures = status == ABACUS_OK ? 0 : 1;
            EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
            EXPECT_EQ(mesh.host.bytes, 0u);
        }
}

} // namespace
} // namespace abacus::test
