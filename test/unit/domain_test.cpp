// Meshes that outgrow their domain get another one if it is worth it, and remain the mesh of their
// points.
#include "keys/domain_of.hpp"
#include "support/point_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace abacus::test {
namespace {

constexpr std::size_t little = 40 << 10, ample = 64 << 20;

template <class Dimension> class OtherDomain : public testing::Test {
protected:
    static constexpr int D = Dimension::value;
    using Points = std::vector<InputOf<D>>;

    /// Points of a box with this corner and edge, a few of them twice.
    Points fresh(std::size_t n, double corner, double edge) {
        std::uniform_real_distribution<double> unit(0, 1);
        Points points;
        for (std::size_t i = 0; i < n; ++i, ++next_id_) {
            Point<D> p;
            for (double &x : p) x = corner + edge * unit(random_);
            if (i > 0 && random_() % 16 == 0) p = points[random_() % i].point;
            points.push_back({next_id_, p, {double(next_id_) / 4}});
        }
        return points;
    }
    static Domain<D> domain(const MeshOf<D> &mesh) { return domain_of<D>(mesh.header.facts.form); }
    static double edge(const MeshOf<D> &mesh) {
        return domain(mesh).upper()[0] - domain(mesh).lower()[0];
    }
    static InputOf<D> at(double x) {
        Point<D> p;
        p.fill(x);
        return {-1, p, {0.5}};
    }
    bool fits(MeshOf<D> &mesh) {
        int fits = -1;
        EXPECT_EQ(abacus_domain_fits(mesh.host.table(), &mesh.header.facts, &fits, &mesh.error),
                  ABACUS_OK);
        return fits == 1;
    }
    /// Pages that begin within a code.
    static std::size_t crowded(const MeshOf<D> &mesh) {
        return static_cast<std::size_t>(
            std::count_if(mesh.host.pages.begin(), mesh.host.pages.end(),
                          [](const auto &page) { return page.first.part != 0; }));
    }
    abacus_status rekey(MeshOf<D> &mesh, int &done) {
        return mesh.with_build([&](abacus_build *build) {
            return abacus_build_rekey(build, 16 << 20, &mesh.header, &done, &mesh.error);
        });
    }

private:
    std::mt19937_64 random_{3};
    std::int64_t next_id_ = 0;
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(OtherDomain, Dimensions);

TYPED_TEST(OtherDomain, ForManyPointsOutside) {
    constexpr int D = TypeParam::value;
    for (const std::size_t cache_bytes : {little, ample})
        for (const std::size_t memory : {std::size_t(1), ample}) {
            MeshOf<D> mesh(1, cache_bytes);
            PointModel<D> model;
            double edge = 1;
            for (int round = 0; round < 4; ++round, edge *= -7) { // to and fro
                auto points = this->fresh(500, 0, edge);
                const auto old = model.points();
                for (std::size_t i = 0; i < old.size(); i += 40) { // equal to existing points
                    points.push_back(old[i]);
                    points.back().id = -std::int64_t(i) - 1000 * round;
                }
                model.insert(points);
                ASSERT_EQ(mesh.insert(points, memory), ABACUS_OK) << mesh.error.detail;
                EXPECT_EQ(mesh.header.facts.census.outside, 0u);
                ASSERT_NO_FATAL_FAILURE(model.expect(mesh));
            }
        }
}

TYPED_TEST(OtherDomain, OneByOneFromNothing) {
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(1, ample);
    PointModel<D> model;
    for (int i = 0; i < 300; ++i) {
        const auto point = this->fresh(1, 0, 1);
        model.insert(point);
        ASSERT_EQ(mesh.insert(point), ABACUS_OK) << mesh.error.detail;
    }
    model.expect(mesh);
    EXPECT_GE(this->edge(mesh), 0.9);
    EXPECT_LE(mesh.header.facts.census.outside, 110u);
}

TYPED_TEST(OtherDomain, AsFewPagesAsOfAFreshMesh) {
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(1), fresh(1);
    const auto corner = this->fresh(2000, 0, 0.05), all = this->fresh(20000, 0, 1);
    ASSERT_EQ(mesh.insert(corner), ABACUS_OK);
    ASSERT_EQ(mesh.insert(all), ABACUS_OK);
    ASSERT_EQ(fresh.insert(all), ABACUS_OK);
    ASSERT_EQ(fresh.insert(corner), ABACUS_OK);
    EXPECT_LE(double(mesh.host.pages.size()), 1.15 * double(fresh.host.pages.size()));
    EXPECT_EQ(mesh.positions(), fresh.positions());
}

TYPED_TEST(OtherDomain, NotForAFewFarAway) {
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(1);
    PointModel<D> model;
    auto points = this->fresh(1000, 0, 1);
    model.insert(points);
    ASSERT_EQ(mesh.insert(points), ABACUS_OK);
    const Domain<D> before = this->domain(mesh);
    points = this->fresh(20, 1e9, 1e9);
    model.insert(points);
    ASSERT_EQ(mesh.insert(points), ABACUS_OK);
    EXPECT_EQ(mesh.header.facts.census.outside, 20u);
    EXPECT_EQ(this->domain(mesh).upper(), before.upper());
    int done = 1;
    ASSERT_EQ(this->rekey(mesh, done), ABACUS_OK);
    EXPECT_EQ(done, 0);
    EXPECT_EQ(mesh.header.facts.census.outside, 20u);
    model.expect(mesh);
}

TYPED_TEST(OtherDomain, WithPointsThatWait) {
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(1, little);
    PointModel<D> model;
    auto points = this->fresh(600, 0, 1);
    model.insert(points);
    ASSERT_EQ(mesh.insert(points), ABACUS_OK);
    points = this->fresh(600, -3, 5);
    model.stage(points);
    ASSERT_EQ(mesh.stage(points), ABACUS_OK);
    EXPECT_GT(mesh.header.facts.census.outside, 300u);
    int done = 0;
    ASSERT_EQ(this->rekey(mesh, done), ABACUS_OK);
    EXPECT_EQ(done, 1);
    EXPECT_EQ(mesh.header.facts.census.staged - mesh.header.facts.census.inserted, 600u);
    EXPECT_GE(this->edge(mesh), 5);
    model.expect(mesh);
    ASSERT_EQ(this->rekey(mesh, done), ABACUS_OK);
    EXPECT_EQ(done, 0);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    model.insert({});
    model.expect(mesh);
}

TYPED_TEST(OtherDomain, WhereAllPointsLieOnALine) {
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(1);
    PointModel<D> model;
    for (const double edge : {1.0, 100.0, 1e4}) {
        auto points = this->fresh(300, 0, edge);
        for (auto &p : points) p.point.fill(p.point[0]);
        model.insert(points);
        ASSERT_EQ(mesh.insert(points), ABACUS_OK);
        EXPECT_EQ(mesh.header.facts.census.vertices, 0u);
        EXPECT_GE(this->edge(mesh), 0.9 * edge);
    }
    const auto points = this->fresh(300, 0, 1e6);
    model.insert(points);
    ASSERT_EQ(mesh.insert(points), ABACUS_OK);
    model.expect(mesh);
}

TYPED_TEST(OtherDomain, HasRoomForBoxesOfAnyMagnitude) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(4);
    for (int round = 0; round < 20000; ++round) {
        Box<D> box;
        for (int axis = 0; axis < D; ++axis)
            for (double *end : {&box.lower[axis], &box.upper[axis]}) {
                const double mantissa = double(random() >> 12) * 0x1p-51 - 1;
                *end = std::ldexp(mantissa, int(random() % 2098) - 1074);
            }
        for (int axis = 0; axis < D; ++axis) {
            if (random() % 3 == 0) box.upper[axis] = box.lower[axis];
            if (box.upper[axis] < box.lower[axis]) std::swap(box.upper[axis], box.lower[axis]);
        }
        const Domain<D> domain = domain_around<D>(box.lower, box.upper);
        const Box<D> room(domain.lower(), domain.upper());
        ASSERT_TRUE(room.contains(box.lower) && room.contains(box.upper)) << round;
        for (int axis = 0; axis < D; ++axis)
            ASSERT_TRUE(std::isfinite(room.upper[axis] / 2 - room.lower[axis] / 2)) << round;
    }
}

TYPED_TEST(OtherDomain, FromOneWhereAnAxisIsFarFromZero) {
    constexpr int D = TypeParam::value;
    for (const double far : {1e200, -1e200}) {
        MeshOf<D> mesh(1);
        PointModel<D> model;
        auto points = this->fresh(10, 0, 1e-200);
        for (auto &p : points) p.point[1] = far;
        model.insert(points);
        ASSERT_EQ(mesh.insert(points), ABACUS_OK);
        points = this->fresh(300, 0, 1);
        model.insert(points);
        ASSERT_EQ(mesh.insert(points), ABACUS_OK) << mesh.error.detail;
        model.expect(mesh);
    }
}

// Inserting a few points into a large mesh does not wait until the whole mesh has new keys.
TYPED_TEST(OtherDomain, OfALargeMeshNotForAFewPoints) {
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(1);
    ASSERT_EQ(mesh.insert(this->fresh(75000, 0, 1)), ABACUS_OK);
    const Domain<D> before = this->domain(mesh);
    for (int i = 0; i < 26; ++i) ASSERT_EQ(mesh.insert(this->fresh(500, 1.3, 2)), ABACUS_OK);
    EXPECT_EQ(this->domain(mesh).upper(), before.upper());
    EXPECT_GT(mesh.header.facts.census.outside, 12000u);
    ASSERT_EQ(mesh.insert(this->fresh(2000, 1.3, 2)), ABACUS_OK);
    EXPECT_EQ(mesh.header.facts.census.outside, 0u);
    EXPECT_GE(this->edge(mesh), 3);
    EXPECT_EQ(mesh.check(), std::vector<std::string>{});
    EXPECT_EQ(mesh.header.facts.census.vertices + mesh.header.facts.census.duplicates, 90000u);
}

// One garbage coordinate among many points: the domain is that of the others.
TYPED_TEST(OtherDomain, NotAroundOnePointFarAway) {
    constexpr int D = TypeParam::value;
    for (const double far : {-3.4028234663852886e38, 1e15}) {
        auto points = this->fresh(4000, 5e5, 1000);
        MeshOf<D> mesh(1, little), plain(1, little);
        PointModel<D> model;
        ASSERT_EQ(plain.insert(points, std::size_t(1)), ABACUS_OK);
        points.insert(points.begin() + 1000, this->at(far));
        model.insert(points);
        ASSERT_EQ(mesh.insert(points, std::size_t(1)), ABACUS_OK) << mesh.error.detail;
        EXPECT_LE(this->edge(mesh), 3000);
        EXPECT_EQ(mesh.header.facts.census.outside, 0u);
        EXPECT_EQ(this->crowded(mesh), 0u);
        EXPECT_LE(double(mesh.host.pages.size()), 1.1 * double(plain.host.pages.size()) + 2);
        EXPECT_TRUE(this->fits(mesh));
        model.expect(mesh);
    }
}

// A small mesh that begins with it recovers by itself.
TYPED_TEST(OtherDomain, AfterPointsThatCameToOneCode) {
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(1);
    PointModel<D> model;
    std::vector<InputOf<D>> points{this->at(-3.4e38)};
    for (const auto &p : this->fresh(1, 0, 1)) points.push_back(p); // which of them is garbage?
    model.insert(points);
    ASSERT_EQ(mesh.insert(points), ABACUS_OK);
    EXPECT_GE(this->edge(mesh), 1e38);
    for (int i = 0; i < 400; ++i) {
        points = this->fresh(2, 0, 1);
        model.insert(points);
        ASSERT_EQ(mesh.insert(points), ABACUS_OK) << mesh.error.detail;
    }
    EXPECT_LE(this->edge(mesh), 16);
    EXPECT_EQ(this->crowded(mesh), 0u);
    model.expect(mesh);
}

// Reading a few pages shows that a given domain does not fit, or that of a mesh whose distant point
// has gone.
TYPED_TEST(OtherDomain, OnDemandWhereItHasNeverFitted) {
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(1);
    PointModel<D> model;
    mesh.header.facts.form.has_domain = 1;
    for (int i = 0; i < D; ++i)
        mesh.header.facts.form.lower[i] = -1e30, mesh.header.facts.form.upper[i] = 1e30;
    auto points = this->fresh(3000, 0, 1);
    points.push_back(this->at(1e29));
    model.insert(points);
    ASSERT_EQ(mesh.insert(points), ABACUS_OK);
    EXPECT_GT(this->crowded(mesh), 5u);
    EXPECT_FALSE(this->fits(mesh));
    model.remove({points.back()});
    std::uint64_t deleted = 0;
    ASSERT_EQ(mesh.remove({points.back()}, deleted), ABACUS_OK);
    EXPECT_FALSE(this->fits(mesh));
    int done = 0;
    ASSERT_EQ(this->rekey(mesh, done), ABACUS_OK);
    EXPECT_EQ(done, 1);
    EXPECT_LE(this->edge(mesh), 16);
    EXPECT_EQ(this->crowded(mesh), 0u);
    EXPECT_TRUE(this->fits(mesh));
    model.expect(mesh);
    ASSERT_EQ(this->rekey(mesh, done), ABACUS_OK);
    EXPECT_EQ(done, 0);
}

// If no scale would help, the search is not repeated again and again.
TYPED_TEST(OtherDomain, NotWhereNoneIsBetter) {
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(1);
    PointModel<D> model;
    for (int round = 0; round < 3; ++round) {
        std::vector<InputOf<D>> points;
        for (int cluster = 0; cluster < 5; ++cluster)
            for (const auto &p : this->fresh(400, 1e15 * cluster, 256)) points.push_back(p);
        model.insert(points);
        ASSERT_EQ(mesh.insert(points), ABACUS_OK);
    }
    const Domain<D> before = this->domain(mesh);
    int done = 1;
    ASSERT_EQ(this->rekey(mesh, done), ABACUS_OK);
    EXPECT_EQ(done, 0);
    EXPECT_EQ(mesh.header.facts.census.outside, 0u);
    EXPECT_EQ(this->domain(mesh).upper(), before.upper());
    EXPECT_TRUE(this->fits(mesh));
    const std::uint64_t found = mesh.host.calls.find, spools = mesh.host.calls.spool_create;
    ASSERT_EQ(this->rekey(mesh, done), ABACUS_OK);
    EXPECT_LE(mesh.host.calls.find - found, 40u);
    EXPECT_EQ(mesh.host.calls.spool_create, spools);
    model.expect(mesh);
}

} // namespace
} // namespace abacus::test
