// Locating and walking in loaded meshes that are not Delaunay, not convex, in pieces: compared with
// brute force over all simplices.
#include "support/containment.hpp"
#include "support/lattice.hpp"
#include "support/triangulations.hpp"

#include <gtest/gtest.h>

namespace abacus::test {
namespace {

constexpr std::size_t little = 60 << 10, ample = 64 << 20;

/// Vertices, middles of pairs, which lie on facets in grids, and arbitrary places.
template <int D> std::vector<Point<D>> targets(const Triangulation<D> &t, int n) {
    std::mt19937_64 random(31);
    std::uniform_real_distribution<double> shift(-1, 1);
    std::vector<Point<D>> result;
    for (int i = 0; i < n; ++i) {
        const auto &a = t.vertices[random() % t.vertices.size()].point,
                   &b = t.vertices[random() % t.vertices.size()].point;
        Point<D> middle, beside;
        for (int k = 0; k < D; ++k) {
            middle[k] = (a[k] + b[k]) / 2;
            beside[k] = a[k] + shift(random);
        }
        result.insert(result.end(), {a, middle, beside});
    }
    return result;
}

template <int D> std::vector<Triangulation<D>> meshes() {
    const auto full = delaunay<D>(grid<D>(D == 2 ? 30 : 7));
    const double middle = D == 2 ? 14.5 : 3;
    const auto distance = [&](const Point<D> &p) {
        double sum = 0;
        for (const double x : p) sum += (x - middle) * (x - middle);
        return std::sqrt(sum);
    };
    std::vector<Triangulation<D>> result;
    result.push_back(keeping<D>(full, [&](const auto &c) { // shells
        return static_cast<int>(3 * distance(c) / middle) % 2 == 0;
    }));
    result.push_back(keeping<D>(full, [&](const auto &c) { // pinched everywhere
        int sum = 0;
        for (const double x : c) sum += static_cast<int>(x);
        return sum % 2 == 0;
    }));
    std::mt19937_64 random(32);
    std::vector<Point<D>> points(600);
    for (auto &p : points)
        for (double &x : p) x = static_cast<double>(random() % 1000) / 100;
    result.push_back(delaunay<D>(points));
    flip(result.back(), 400, 33);
    return result;
}

template <class Dimension> class LoadQuery : public testing::Test {
protected:
    static constexpr int D = Dimension::value;
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(LoadQuery, Dimensions);

TYPED_TEST(LoadQuery, LocatesTheFirstOfTheSimplicesAroundThePoint) {
    constexpr int D = TestFixture::D;
    for (const auto &t : meshes<D>()) {
        MeshOf<D> mesh(0);
        ASSERT_EQ(mesh.load(t.vertices, t.simplices), ABACUS_OK) << mesh.error.message;
        ASSERT_NE(mesh.header.facts.standing, 0u);
        const auto all = mesh.simplices(false);
        OpenMeshOf<D> large(mesh, ample), small(mesh, little);
        int inside = 0, outside = 0;
        for (const Point<D> &p : targets(t, 300)) {
            const abacus_simplex *expected = nullptr;
            for (const abacus_simplex &s : all)
                if (contains<D>(s, p) && (expected == nullptr || rank<D>(s) < rank<D>(*expected)))
                    expected = &s;
            ++(expected == nullptr ? outside : inside);
            for (OpenMeshOf<D> *open : {&large, &small}) {
                abacus_simplex found;
                const abacus_status status = open->locate(p, found);
                ASSERT_EQ(status, expected == nullptr ? ABACUS_END : ABACUS_OK)
                    << open->error.message;
                if (expected != nullptr) {
                    EXPECT_EQ(rank<D>(found), rank<D>(*expected));
                }
            }
        }
        EXPECT_GT(inside, 100);
        EXPECT_GT(outside, 10);
        EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
    }
}

TYPED_TEST(LoadQuery, WalksAcrossEveryFacet) {
    constexpr int D = TestFixture::D;
    for (const auto &t : meshes<D>()) {
        MeshOf<D> mesh(0);
        ASSERT_EQ(mesh.load(t.vertices, t.simplices), ABACUS_OK) << mesh.error.message;
        OpenMeshOf<D> open(mesh, little);
        std::map<std::vector<std::int64_t>, int> uses;
        const auto all = mesh.simplices(false);
        const auto facet = [](const abacus_simplex &s, int i) {
            std::vector<std::int64_t> ids;
            for (int k = 0; k <= D; ++k)
                if (k != i) ids.push_back(s.id[k]);
            std::sort(ids.begin(), ids.end());
            return ids;
        };
        for (const auto &s : all)
            for (int i = 0; i <= D; ++i) ++uses[facet(s, i)];
        std::uint64_t boundary = 0;
        for (const auto &s : all)
            for (int i = 0; i <= D; ++i) {
                abacus_simplex next;
                const abacus_status status = open.walk(s, i, next);
                const bool leads = uses[facet(s, i)] == 2;
                boundary += !leads;
                ASSERT_EQ(status, leads ? ABACUS_OK : ABACUS_END) << open.error.message;
                if (!leads) continue;
                EXPECT_NE(rank<D>(next), rank<D>(s));
                bool shared = false;
                for (int k = 0; k <= D; ++k) shared = shared || facet(next, k) == facet(s, i);
                EXPECT_TRUE(shared);
            }
        EXPECT_EQ(boundary, mesh.header.facts.census.ghosts);
    }
}

TYPED_TEST(LoadQuery, BoxesOfPagesMayStandForSeveral) {
    constexpr int D = TestFixture::D;
    constexpr int side = D == 2 ? 110 : 18;
    const auto full = delaunay<D>(grid<D>(side));
    const auto t = keeping<D>(full, [](const auto &c) { return static_cast<int>(c[0]) % 2 == 0; });
    MeshOf<D> mesh(0);
    ASSERT_EQ(mesh.load(t.vertices, t.simplices), ABACUS_OK) << mesh.error.message;
    ASSERT_GT(mesh.host.pages.size(), 20u); // more than the boxes that a small cache allows
    OpenMeshOf<D> open(mesh, 1);
    std::mt19937_64 random(41);
    for (int i = 0; i < 200; ++i) {
        Point<D> p;
        for (double &x : p) x = static_cast<double>(random() % (100 * (side - 1))) / 100;
        abacus_simplex found;
        const bool filled = static_cast<int>(p[0]) % 2 == 0 || p[0] == std::floor(p[0]);
        ASSERT_EQ(open.locate(p, found), filled ? ABACUS_OK : ABACUS_END);
        if (filled) {
            EXPECT_TRUE(contains<D>(found, p));
        }
    }
}

} // namespace
} // namespace abacus::test
