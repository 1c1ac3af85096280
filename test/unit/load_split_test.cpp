// Split nodes: meshes cut along faults, whose two sides have vertices of their own at the same
// places. The loaded mesh comes back unchanged; every question is answered as by brute force.
#include "support/containment.hpp"
#include "support/lattice.hpp"
#include "support/triangulations.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <numeric>

namespace abacus::test {
namespace {

constexpr std::size_t tiny = 1, little = 60 << 10, ample = 64 << 20;

/// Splits the vertices of facets that are faults, according to their middles: one for each part of
/// the star that is connected across other facets. The attribute of a vertex is its id.
template <int D>
Triangulation<D> cut(const Triangulation<D> &t,
                     const std::function<bool(const Point<D> &)> &is_fault) {
    std::map<std::int64_t, Point<D>> at;
    for (const auto &v : t.vertices) at[v.id] = v.point;
    std::vector<std::size_t> parent(t.simplices.size() * (D + 1)); // of corners
    std::iota(parent.begin(), parent.end(), 0);
    const auto find = [&](std::size_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    std::map<std::vector<std::int64_t>, std::size_t> sides;
    for (std::size_t s = 0; s < t.simplices.size(); ++s)
        for (int i = 0; i <= D; ++i) {
            std::vector<std::int64_t> facet;
            Point<D> middle{};
            for (int k = 0; k <= D; ++k) {
                if (k == i) continue;
                facet.push_back(t.simplices[s][k]);
                for (int axis = 0; axis < D; ++axis)
                    middle[axis] += at[t.simplices[s][k]][axis] / D;
            }
            if (is_fault(middle)) continue;
            std::sort(facet.begin(), facet.end());
            const auto [other, is_new] = sides.emplace(facet, s);
            if (is_new) continue;
            const Ids<D> &a = t.simplices[s], &b = t.simplices[other->second];
            for (int k = 0; k <= D; ++k)
                for (int l = 0; l <= D; ++l)
                    if (a[k] == b[l])
                        parent[find(s * (D + 1) + k)] = find(other->second * (D + 1) + l);
        }
    Triangulation<D> result;
    std::map<std::size_t, std::int64_t> ids; // for each part
    std::map<std::int64_t, int> parts;       // for each vertex
    for (std::size_t s = 0; s < t.simplices.size(); ++s) {
        Ids<D> simplex;
        for (int k = 0; k <= D; ++k) {
            const std::int64_t id = t.simplices[s][k];
            const auto [part, is_new] = ids.emplace(find(s * (D + 1) + k), 0);
            if (is_new) {
                part->second = id + 1000000 * parts[id]++;
                result.vertices.push_back(
                    {part->second, at[id], {static_cast<double>(part->second)}});
            }
            simplex[k] = part->second;
        }
        result.simplices.push_back(simplex);
    }
    return result;
}

template <int D> std::vector<Triangulation<D>> meshes() {
    const int n = D == 2 ? 24 : 6;
    const double middle = n / 2;
    const auto square = delaunay<D>(grid<D>(n));
    const auto is_on = [=](const Point<D> &p, int axis) { return p[axis] == middle; };
    std::vector<Triangulation<D>> result;
    // From one side to the other; up to a tip inside; crossing; every second layer.
    result.push_back(cut<D>(square, [=](const auto &p) { return is_on(p, 0); }));
    result.push_back(cut<D>(square, [=](const auto &p) { return is_on(p, 0) && p[1] < middle; }));
    result.push_back(cut<D>(square, [=](const auto &p) { return is_on(p, 0) || is_on(p, 1); }));
    result.push_back(cut<D>(square, [=](const auto &p) {
        return std::fmod(p[D - 1], 2) == 0 && (is_on(p, 0) || p[0] < middle);
    }));
    // Along arbitrary facets of random points.
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Point<D>> points(D == 2 ? 400 : 150);
    for (auto &p : points)
        for (double &x : p) x = unit(random);
    result.push_back(cut<D>(delaunay<D>(points), [](const auto &p) {
        return static_cast<int>(10 * p[0]) % 2 == 0 && p[1] < 0.7;
    }));
    return result;
}

template <int D> std::vector<Ids<D>> sorted(std::vector<Ids<D>> simplices) {
    for (auto &s : simplices) std::sort(s.begin(), s.end());
    std::sort(simplices.begin(), simplices.end());
    return simplices;
}

template <int D> std::vector<Ids<D>> stored(MeshOf<D> &mesh) {
    std::vector<Ids<D>> result;
    for (const abacus_simplex &s : mesh.simplices(false)) {
        Ids<D> ids;
        std::copy_n(s.id, D + 1, ids.begin());
        result.push_back(ids);
    }
    return sorted<D>(result);
}

/// Counts the vertices that share their places.
template <int D> std::uint64_t split(const Triangulation<D> &t) {
    std::map<Point<D>, std::uint64_t> at;
    for (const auto &v : t.vertices) ++at[v.point];
    std::uint64_t n = 0;
    for (const auto &[p, here] : at) n += here > 1 ? here : 0;
    return n;
}

template <int D> std::uint64_t boundary(const Triangulation<D> &t) {
    std::map<std::vector<std::int64_t>, int> uses;
    for (const Ids<D> &s : t.simplices)
        for (int i = 0; i <= D; ++i) {
            std::vector<std::int64_t> facet;
            for (int k = 0; k <= D; ++k)
                if (k != i) facet.push_back(s[k]);
            std::sort(facet.begin(), facet.end());
            ++uses[facet];
        }
    return static_cast<std::uint64_t>(
        std::count_if(uses.begin(), uses.end(), [](const auto &use) { return use.second == 1; }));
}

template <class Dimension> class LoadSplit : public testing::Test {
protected:
    static constexpr int D = Dimension::value;
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(LoadSplit, Dimensions);

TYPED_TEST(LoadSplit, WhatIsGivenIsThereAndSound) {
    constexpr int D = TestFixture::D;
    for (const auto &t : meshes<D>())
        for (const int attributes : {0, 1}) {
            const std::size_t memory = attributes > 0 ? tiny : ample;
            MeshOf<D> mesh(attributes, little);
            mesh.split_nodes = true;
            if (attributes > 0) mesh.host.set_threads(3, true);
            ASSERT_EQ(mesh.load(t.vertices, t.simplices, memory), ABACUS_OK)
                << mesh.error.message << ' ' << mesh.error.detail;
            EXPECT_NE(mesh.header.facts.standing, 0u);
            EXPECT_GT(mesh.header.facts.census.split, 0u);
            EXPECT_EQ(mesh.header.facts.census.split, split(t));
            EXPECT_EQ(mesh.header.facts.census.vertices, t.vertices.size());
            EXPECT_EQ(mesh.header.facts.census.ghosts, boundary(t));
            EXPECT_EQ(stored<D>(mesh), sorted<D>(t.simplices));
            EXPECT_EQ(mesh.check(), std::vector<std::string>{});
            EXPECT_TRUE(mesh.host.spools.empty());
            EXPECT_EQ(mesh.host.bytes, 0u);
            EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
            --mesh.header.facts.census.split;
            EXPECT_NE(mesh.check(), std::vector<std::string>{});
        }
}

TYPED_TEST(LoadSplit, PagesDoNotDependOnTheOrderOfRows) {
    constexpr int D = TestFixture::D;
    for (auto t : meshes<D>()) {
        const auto pages = [&](std::size_t memory) {
            MeshOf<D> mesh(1);
            mesh.split_nodes = true;
            EXPECT_EQ(mesh.load(t.vertices, t.simplices, memory), ABACUS_OK) << mesh.error.message;
            std::vector<std::vector<unsigned char>> bytes;
            for (auto &[key, page] : mesh.host.pages)
                bytes.emplace_back(page.bytes(), page.bytes() + page.size);
            return bytes;
        };
        const auto expected = pages(ample);
        for (unsigned seed = 1; seed <= 3; ++seed) {
            std::mt19937_64 random(seed);
            std::shuffle(t.vertices.begin(), t.vertices.end(), random);
            std::shuffle(t.simplices.begin(), t.simplices.end(), random);
            EXPECT_EQ(pages(seed == 1 ? tiny : ample), expected);
        }
    }
}

TYPED_TEST(LoadSplit, TwoAtOnePlaceAreRefusedUnlessTheyAreWanted) {
    constexpr int D = TestFixture::D;
    const auto t = meshes<D>()[0];
    MeshOf<D> mesh(1);
    EXPECT_EQ(mesh.load(t.vertices, t.simplices), ABACUS_ERROR);
    EXPECT_NE(std::string(mesh.error.message).find("have the same coordinates"), std::string::npos);
    // The option alone changes nothing.
    const auto whole = delaunay<D>(grid<D>(5));
    MeshOf<D> one, other;
    other.split_nodes = true;
    ASSERT_EQ(one.load(whole.vertices, whole.simplices), ABACUS_OK);
    ASSERT_EQ(other.load(whole.vertices, whole.simplices), ABACUS_OK);
    EXPECT_EQ(other.header.facts.census.split, 0u);
    EXPECT_EQ(other.header.facts.standing, one.header.facts.standing);
}

/// Simplices with vertices of their own at the places of others.
TYPED_TEST(LoadSplit, OverlapsAreFound) {
    constexpr int D = TestFixture::D;
    const auto all = meshes<D>();
    for (const auto &t : {all[0], all[2], all[4]}) {
        const auto fails = [&](const Triangulation<D> &broken) {
            MeshOf<D> mesh(1);
            mesh.split_nodes = true;
            return mesh.load(broken.vertices, broken.simplices) == ABACUS_ERROR &&
                   mesh.error.kind == ABACUS_ERROR_ARGUMENT &&
                   (std::string(mesh.error.message).find(" overlap") != std::string::npos ||
                    std::string(mesh.error.message).find("meet in more than a common face") !=
                        std::string::npos);
        };
        Triangulation<D> twice = t;
        twice.add(t, 50000000);
        EXPECT_TRUE(fails(twice)); // the whole mesh
        for (std::size_t i = 0; i < t.simplices.size(); i += t.simplices.size() / 7) {
            Triangulation<D> one = t, part;
            part.vertices = t.vertices;
            part.simplices = {t.simplices[i]};
            part.tidy();
            one.add(part, 50000000);
            EXPECT_TRUE(fails(one)); // one simplex
        }
        // Every second simplex: all facets of the copies are free.
        Triangulation<D> half = t, some;
        some.vertices = t.vertices;
        for (std::size_t i = 0; i < t.simplices.size(); i += 2)
            some.simplices.push_back(t.simplices[i]);
        some.tidy();
        half.add(some, 50000000);
        EXPECT_TRUE(fails(half));
    }
}

/// Each simplex with vertices of its own: nothing but faults.
TYPED_TEST(LoadSplit, AllMayBeFaults) {
    constexpr int D = TestFixture::D;
    const auto t = cut<D>(delaunay<D>(grid<D>(D == 2 ? 12 : 4)), [](const auto &) { return true; });
    EXPECT_EQ(t.vertices.size(), t.simplices.size() * (D + 1));
    MeshOf<D> mesh(1, little);
    mesh.split_nodes = true;
    ASSERT_EQ(mesh.load(t.vertices, t.simplices), ABACUS_OK) << mesh.error.message;
    EXPECT_EQ(mesh.header.facts.census.ghosts, t.simplices.size() * (D + 1));
    EXPECT_EQ(stored<D>(mesh), sorted<D>(t.simplices));
    EXPECT_EQ(mesh.check(), std::vector<std::string>{});
}

TYPED_TEST(LoadSplit, LocatesAndInterpolatesOnTheSideThatContainsThePlace) {
    constexpr int D = TestFixture::D;
    for (const auto &t : meshes<D>()) {
        MeshOf<D> mesh(1);
        mesh.split_nodes = true;
        ASSERT_EQ(mesh.load(t.vertices, t.simplices), ABACUS_OK) << mesh.error.message;
        const auto all = mesh.simplices(false);
        OpenMeshOf<D> large(mesh, ample), small(mesh, little);
        abacus_interpolation how{};
        how.extent = {};
        how.attributes = 1;
        std::mt19937_64 random(31);
        std::uniform_real_distribution<double> shift(-0.1, 0.1);
        for (int i = 0; i < 300; ++i) {
            const abacus_simplex &near = all[random() % all.size()];
            Point<D> p{};
            for (int axis = 0; axis < D; ++axis) {
                if (i % 3 == 0) p[axis] = near.corner[0][axis];
                if (i % 3 == 1) p[axis] = (near.corner[0][axis] + near.corner[1][axis]) / 2;
                if (i % 3 == 2) p[axis] = near.corner[0][axis] + shift(random);
            }
            const abacus_simplex *expected = nullptr;
            for (const abacus_simplex &s : all)
                if (contains<D>(s, p) && (expected == nullptr || rank<D>(s) < rank<D>(*expected)))
                    expected = &s;
            for (OpenMeshOf<D> *open : {&large, &small}) {
                abacus_simplex found;
                ASSERT_EQ(open->locate(p, found), expected == nullptr ? ABACUS_END : ABACUS_OK)
                    << open->error.message;
                if (expected == nullptr) continue;
                EXPECT_EQ(rank<D>(found), rank<D>(*expected));
                double value;
                ASSERT_EQ(open->interpolate(how, p, &value), ABACUS_OK);
                const auto [least, greatest] =
                    std::minmax_element(expected->id, expected->id + D + 1);
                EXPECT_GE(value, static_cast<double>(*least) - 1e-6);
                EXPECT_LE(value, static_cast<double>(*greatest) + 1e-6);
                if (i % 3 != 0) continue;
                for (int k = 0; k <= D; ++k)
                    if (std::equal(p.begin(), p.end(), expected->corner[k])) {
                        EXPECT_EQ(value, static_cast<double>(expected->id[k]));
                    }
            }
        }
    }
}

TYPED_TEST(LoadSplit, NoWalkCrossesAFault) {
    constexpr int D = TestFixture::D;
    for (const auto &t : meshes<D>()) {
        MeshOf<D> mesh(1);
        mesh.split_nodes = true;
        ASSERT_EQ(mesh.load(t.vertices, t.simplices), ABACUS_OK) << mesh.error.message;
        OpenMeshOf<D> open(mesh, little);
        std::uint64_t ends = 0;
        for (const abacus_simplex &s : mesh.simplices(false))
            for (int i = 0; i <= D; ++i) {
                abacus_simplex next;
                const abacus_status status = open.walk(s, i, next);
                ASSERT_NE(status, ABACUS_ERROR) << open.error.message;
                ends += status == ABACUS_END;
                int shared = 0;
                for (int k = 0; k <= D && status == ABACUS_OK; ++k)
                    shared += std::find(next.id, next.id + D + 1, s.id[k]) != next.id + D + 1;
                EXPECT_EQ(shared, status == ABACUS_OK ? D : 0);
            }
        EXPECT_EQ(ends, boundary(t));
    }
}

} // namespace
} // namespace abacus::test
