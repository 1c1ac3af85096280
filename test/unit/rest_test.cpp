// If deletions would cost more than triangulating the remaining points, these are triangulated
// instead, and the mesh is the same.
#include "change/outlay.hpp"
#include "support/point_model.hpp"
#include "support/sanitized.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace abacus::test {
namespace {

const int scale = sanitized ? 4 : 1;

template <class Dimension> class Rest : public testing::Test {
protected:
    static constexpr int D = Dimension::value;
    using Points = std::vector<InputOf<D>>;

    void add(Points &to, const Point<D> &p) {
        to.push_back({next_id, p, {double(next_id) / 4}});
        ++next_id;
    }
    /// If `flat`, points on a line, or on a grid in the plane x + y = 0; otherwise on a circle, or
    /// on a curve around an axis.
    Points crowd(bool flat) {
        Points points;
        const int n = (D == 2 ? 5000 : 900) / scale;
        for (int i = 0; i < n; ++i) {
            Point<D> p{};
            if (flat) {
                p[0] = D == 2 ? i : i % 30;
                p[1] = -p[0];
                if (D == 3) p[2] = i / 30;
            } else {
                const double angle = 6.283185307179586 * i / n;
                p[0] = std::cos(angle);
                p[1] = std::sin(angle);
                if (D == 3) p[2] = 0.25 * std::sin(5 * angle);
            }
            add(points, p);
            if (i % 50 == 0) add(points, p);
        }
        return points;
    }
    /// Each is a neighbour of many points of the crowd.
    Points hubs(int n) {
        Points points;
        for (int i = 0; i < n; ++i) {
            Point<D> p;
            for (double &x : p) x = 1000.0 + double(random() % 100000) / 64;
            if (i % 2) p[1] = -p[0] - p[1];
            add(points, p);
        }
        return points;
    }
    void insert(MeshOf<D> &mesh, PointModel<D> &model, const Points &points) {
        model.insert(points);
        ASSERT_EQ(mesh.insert(points), ABACUS_OK) << mesh.error.detail;
    }
    /// Removes them, which triangulates the rest.
    void remove(MeshOf<D> &mesh, PointModel<D> &model, const Points &points,
                std::size_t memory = 16 << 20) {
        const std::uint64_t vertices = mesh.header.facts.census.vertices,
                            removals = mesh.header.counters.removals;
        std::uint64_t deleted = 0;
        const std::uint64_t expected = model.remove(points);
        ASSERT_EQ(mesh.remove(points, deleted, memory), ABACUS_OK) << mesh.error.detail;
        EXPECT_EQ(deleted, expected);
        EXPECT_LT(mesh.header.counters.removals - removals,
                  vertices - mesh.header.facts.census.vertices);
        model.expect(mesh);
    }

    std::mt19937_64 random{5};
    std::int64_t next_id = 0;
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Rest, Dimensions);

TYPED_TEST(Rest, IsTheMeshOfWhatIsLeft) {
    constexpr int D = TypeParam::value;
    for (const std::size_t cache_bytes : {std::size_t(60) << 10, std::size_t(64) << 20}) {
        MeshOf<D> mesh(1, cache_bytes);
        PointModel<D> model;
        this->insert(mesh, model, this->crowd(false));
        auto hubs = this->hubs(200);
        // Some places have two points: both leave, or only one, and the other takes over.
        for (int i = 0; i < 40; ++i) this->add(hubs, hubs[i].point);
        this->insert(mesh, model, hubs);
        hubs.resize(220);
        this->add(hubs, Point<D>{7, 7}); // not in the mesh
        this->remove(mesh, model, hubs, cache_bytes);
        if (this->HasFatalFailure()) return;
        // Afterwards it continues as before.
        this->insert(mesh, model, this->hubs(20));
        model.expect(mesh);
    }
}

TYPED_TEST(Rest, WaitsIfItSpansNoSimplex) {
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(1, 60 << 10);
    PointModel<D> model;
    this->insert(mesh, model, this->crowd(true));
    EXPECT_EQ(mesh.header.facts.census.vertices, 0u);
    for (int round = 0; round < 2; ++round) {
        const auto hubs = this->hubs(200);
        this->insert(mesh, model, hubs);
        EXPECT_GT(mesh.header.facts.census.vertices, 0u);
        EXPECT_GT(mesh.header.facts.census.duplicates, 0u);
        this->remove(mesh, model, hubs);
        if (this->HasFatalFailure()) return;
        EXPECT_EQ(mesh.header.facts.census.vertices, 0u);
        EXPECT_EQ(mesh.header.facts.census.duplicates, 0u);
        EXPECT_TRUE(mesh.host.pages.empty());
    }
}

TYPED_TEST(Rest, MayBeNothing) {
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(1, 60 << 10);
    PointModel<D> model;
    auto all = this->hubs(300);
    const auto crowd = this->crowd(false);
    all.insert(all.end(), crowd.begin(), crowd.end());
    this->insert(mesh, model, all);
    std::uint64_t deleted = 0;
    ASSERT_EQ(mesh.remove(all, deleted), ABACUS_OK) << mesh.error.detail;
    EXPECT_EQ(deleted, all.size());
    EXPECT_EQ(mesh.header.facts.census.vertices, 0u);
    EXPECT_TRUE(mesh.host.pages.empty());
    EXPECT_EQ(mesh.check(), std::vector<std::string>{});
    ASSERT_EQ(mesh.insert(all), ABACUS_OK);
    model.expect(mesh);
}

TYPED_TEST(Rest, KeepsWhatIsNotTakenExactly) {
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(1);
    PointModel<D> model;
    this->insert(mesh, model, this->crowd(false));
    const auto hubs = this->hubs(200);
    this->insert(mesh, model, hubs);
    auto wanted = hubs, taken = hubs;
    taken.clear();
    for (std::size_t i = 0; i < hubs.size(); ++i)
        if (i % 5 == 0)
            wanted[i].attributes[0] += 1;
        else
            taken.push_back(hubs[i]);
    wanted.insert(wanted.end(), taken.begin(), taken.begin() + 50); // a second time
    std::uint64_t deleted = 0;
    const std::uint64_t removals = mesh.header.counters.removals;
    ASSERT_EQ(mesh.remove(wanted, deleted, 16 << 20, true), ABACUS_OK);
    EXPECT_EQ(deleted, model.remove(taken));
    EXPECT_LT(mesh.header.counters.removals - removals, deleted);
    model.expect(mesh);
}

TYPED_TEST(Rest, IsLeftAloneWhereRemovalsCostLess) {
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(1);
    typename TestFixture::Points points;
    for (int i = 0; i < 6000 / scale; ++i) {
        Point<D> p;
        for (double &x : p) x = double(this->random() % 1000000);
        this->add(points, p);
    }
    ASSERT_EQ(mesh.insert(points), ABACUS_OK);
    points.resize(points.size() / (D == 2 ? 2 : 8));
    std::uint64_t deleted = 0;
    ASSERT_EQ(mesh.remove(points, deleted), ABACUS_OK);
    EXPECT_EQ(mesh.header.counters.removals, points.size());
}

TEST(Outlay, IsTooMuchOnlyIfAllCostsMoreThanTheRest) {
    // 500 of 1,000 vertices with 2,000 triangles leave, at the same cost each.
    const auto given_up = [](std::uint64_t cost) {
        Outlay<2> outlay(500, 1000, 2000);
        for (int i = 1; i <= 500; ++i)
            if (outlay.is_too_much(cost, 1)) return i;
        return 0;
    };
    EXPECT_EQ(given_up(0), 0);
    EXPECT_EQ(given_up(16), 0);
    EXPECT_GT(given_up(100), 0);
    EXPECT_LT(given_up(1000), given_up(100));
    EXPECT_EQ(given_up(100000), 1);
}
TEST(Outlay, OfOnePointIsNeverTooMuch) {
    Outlay<3> outlay(1, 10, 20);
    EXPECT_FALSE(outlay.is_too_much(1u << 30, 1));
}

} // namespace
} // namespace abacus::test
