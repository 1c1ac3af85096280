// Points straight into the triangulation, without vertex pages in between, and points that equal a
// vertex.
#include "support/oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

namespace abacus::test {
namespace {

constexpr std::size_t little = 40 << 10;

using Random = std::mt19937_64;

template <class Dimension> class Insert : public testing::Test {
protected:
    static constexpr int D = Dimension::value;
    using Points = std::vector<Point<D>>;

    template <class Coordinate> Points make(int n, Coordinate coordinate) {
        Points points(n);
        for (Point<D> &p : points)
            for (double &x : p) x = coordinate();
        return points;
    }
    Points uniform(int n) {
        return make(n, [&] { return std::uniform_real_distribution<double>(0, 1)(random); });
    }
    /// On the line through 0 with direction (1, 2, ...).
    Points line(int n) {
        Points points;
        for (int i = 0; i < n; ++i) {
            points.emplace_back();
            for (int axis = 0; axis < D; ++axis)
                points.back()[axis] = (axis + 1) * double(i % 5000);
        }
        return points;
    }
    void expect_mesh(MeshOf<D> &mesh, const Points &points) {
        EXPECT_EQ(mesh.positions(), cgal_simplices<D>(points));
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        EXPECT_EQ(mesh.header.facts.census.vertices + mesh.header.facts.census.duplicates +
                      mesh.header.facts.census.staged - mesh.header.facts.census.inserted,
                  points.size());
        EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
        EXPECT_EQ(mesh.host.bytes, 0u);
    }

    Random random{5};
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Insert, Dimensions);

TYPED_TEST(Insert, GivesTheMeshOfAllPointsAndNoVertexPages) {
    constexpr int D = TypeParam::value;
    for (const std::size_t memory : {std::size_t(1), std::size_t(16) << 20}) {
        MeshOf<D> mesh(0, little);
        std::vector<Point<D>> all;
        for (const int n : {3000, 1, 500, 1, 1}) {
            const auto more = this->uniform(n);
            all.insert(all.end(), more.begin(), more.end());
            ASSERT_EQ(mesh.insert(number<D>(more), memory), ABACUS_OK) << mesh.error.detail;
        }
        this->expect_mesh(mesh, all);
        EXPECT_TRUE(mesh.host.staged_pages.empty());
        EXPECT_EQ(mesh.header.facts.census.staged, 0u);
    }
}

TYPED_TEST(Insert, WaitsForASimplex) {
    // Few and many points on a line, more than memory holds; then the mesh begins.
    constexpr int D = TypeParam::value;
    for (const int n : {0, 1, 2, 300, 4096, 12000}) {
        MeshOf<D> mesh;
        auto all = this->line(n);
        ASSERT_EQ(mesh.insert(number<D>(all)), ABACUS_OK);
        EXPECT_EQ(mesh.header.facts.census.vertices, 0u);
        EXPECT_EQ(mesh.header.facts.census.staged, std::uint64_t(n));
        this->expect_mesh(mesh, all);
        for (const int more : {1, 100}) {
            const auto points = this->uniform(more);
            all.insert(all.end(), points.begin(), points.end());
            ASSERT_EQ(mesh.insert(number<D>(points)), ABACUS_OK) << mesh.error.detail;
            this->expect_mesh(mesh, all);
        }
        EXPECT_GT(mesh.header.facts.census.simplices, 0u);
        EXPECT_TRUE(mesh.host.staged_pages.empty());
    }
}

TYPED_TEST(Insert, BeginsWhereverTheSimplexIs) {
    // The points that span it come first, last, or in the middle of the order.
    constexpr int D = TypeParam::value;
    for (const int n : {100, 5000, 9000}) {
        auto all = this->line(n);
        const auto others = this->uniform(D + 1);
        all.insert(all.end(), others.begin(), others.end());
        MeshOf<D> mesh;
        ASSERT_EQ(mesh.insert(number<D>(all)), ABACUS_OK) << mesh.error.detail;
        this->expect_mesh(mesh, all);
    }
}

TYPED_TEST(Insert, InsertsFirstWhatWaits) {
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(0, little);
    auto all = this->uniform(800);
    ASSERT_EQ(mesh.stage(number<D>(all)), ABACUS_OK);
    auto again = number<D>(all); // so these are duplicates with other ids
    for (InputOf<D> &input : again) input.id += 1000;
    ASSERT_EQ(mesh.insert(again), ABACUS_OK);
    EXPECT_EQ(mesh.header.facts.census.duplicates, 800u);
    for (const abacus_simplex &s : mesh.simplices(false))
        for (int i = 0; i <= D; ++i) EXPECT_LT(s.id[i], 1000);
    all.insert(all.end(), all.begin(), all.begin() + 800);
    this->expect_mesh(mesh, all);
}

TYPED_TEST(Insert, KeepsEveryRepeatedPoint) {
    // Few places, one of them very frequent: more equal points than fit a page, in batches.
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(1, little);
    std::map<std::int64_t, InputOf<D>> given;
    std::map<Point<D>, std::int64_t> vertex;
    std::vector<Point<D>> all;
    for (const int n : {700, 1500, 1, 2000}) {
        std::vector<InputOf<D>> batch;
        for (int i = 0; i < n; ++i) {
            Point<D> p{};
            if (this->random() % 2)
                for (double &x : p) x = double(this->random() % 4);
            const auto id = static_cast<std::int64_t>(given.size());
            batch.push_back({id, p, {double(id) / 2}});
            given[id] = batch.back();
            vertex.emplace(p, id);
            all.push_back(p);
        }
        ASSERT_EQ(mesh.insert(batch, 1), ABACUS_OK) << mesh.error.detail;
    }
    EXPECT_GT(mesh.host.repeated_pages.size(), 8u);
    this->expect_mesh(mesh, all);
    abacus_vertex_scan *scan = nullptr;
    ASSERT_EQ(
        abacus_vertex_scan_open(mesh.host.table(), &mesh.header.facts, little, &scan, &mesh.error),
        ABACUS_OK);
    abacus_vertex v;
    while (abacus_vertex_scan_next(scan, &v, &mesh.error) == ABACUS_OK) {
        const auto found = given.find(v.id);
        ASSERT_NE(found, given.end());
        const Point<D> &p = found->second.point;
        EXPECT_TRUE(std::equal(p.begin(), p.end(), v.point));
        EXPECT_EQ(v.attributes[0], found->second.attributes[0]);
        EXPECT_EQ(v.vertex, vertex.at(p));
        given.erase(found);
    }
    abacus_vertex_scan_close(scan);
    EXPECT_TRUE(given.empty());
}

} // namespace
} // namespace abacus::test
