// Loading triangulations made elsewhere: the same mesh comes back, Delaunay or not; anything that
// is not a triangulation is refused, and the faulty parts are named.
#include "support/lattice.hpp"
#include "support/triangulations.hpp"

#include <gtest/gtest.h>

namespace abacus::test {
namespace {

constexpr std::size_t tiny = 1, little = 60 << 10, ample = 64 << 20;

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

/// Loads in another order; everything given must be there again, and be sound.
template <int D>
void expect_loads(MeshOf<D> &mesh, Triangulation<D> t, abacus_delaunay delaunay,
                  std::size_t memory = ample) {
    t.shuffle(3);
    ASSERT_EQ(mesh.load(t.vertices, t.simplices, memory), ABACUS_OK)
        << mesh.error.message << ' ' << mesh.error.detail;
    EXPECT_EQ(mesh.loaded_as, delaunay);
    EXPECT_EQ(mesh.header.facts.standing, static_cast<std::uint32_t>(delaunay));
    EXPECT_EQ(mesh.header.facts.census.simplices, t.simplices.size());
    EXPECT_EQ(mesh.header.facts.census.vertices, t.vertices.size());
    EXPECT_EQ(stored<D>(mesh), sorted<D>(t.simplices));
    EXPECT_EQ(mesh.check(), std::vector<std::string>{});
    EXPECT_TRUE(mesh.host.spools.empty());
    EXPECT_EQ(mesh.host.bytes, 0u);
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
}

template <class Dimension> class Load : public testing::Test {
protected:
    static constexpr int D = Dimension::value;
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Load, Dimensions);

TYPED_TEST(Load, DelaunayTriangulationsBecomeFullMeshes) {
    constexpr int D = TestFixture::D;
    for (const auto &points : {random_points<D>(3000, 1), grid<D>(D == 2 ? 40 : 10)})
        for (const std::size_t memory : {tiny, ample}) {
            MeshOf<D> mesh(0, little);
            expect_loads<D>(mesh, delaunay<D>(points), ABACUS_DELAUNAY, memory);
            MeshOf<D> built(0, little);
            ASSERT_EQ(built.stage(number<D>(points)), ABACUS_OK);
            ASSERT_EQ(built.build(), ABACUS_OK);
            EXPECT_EQ(mesh.positions(), built.positions());
            EXPECT_EQ(mesh.header.facts.census.ghosts, built.header.facts.census.ghosts);
            // Points can be added to it: the same as building the whole mesh.
            auto all = points;
            const auto more = random_points<D>(500, 2);
            all.insert(all.end(), more.begin(), more.end());
            ASSERT_EQ(mesh.stage(number<D>(more)), ABACUS_OK);
            ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.detail;
            EXPECT_EQ(mesh.positions(), cgal_simplices<D>(all));
            EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        }
}

TYPED_TEST(Load, PagesAreWellFilled) {
    constexpr int D = TestFixture::D;
    MeshOf<D> mesh;
    expect_loads<D>(mesh, delaunay<D>(random_points<D>(D == 2 ? 15000 : 3000, 5)), ABACUS_DELAUNAY);
    std::size_t bytes = 0;
    for (const auto &[key, page] : mesh.host.pages) bytes += page.size;
    EXPECT_GT(bytes, mesh.host.pages.size() * ABACUS_PAGE_BYTES * 75 / 100);
}

TYPED_TEST(Load, OtherTriangulationsAreMarked) {
    constexpr int D = TestFixture::D;
    auto t = delaunay<D>(random_points<D>(1500, 4));
    flip(t, 300, 5);
    for (const std::size_t memory : {tiny, ample}) {
        MeshOf<D> mesh(0, little);
        expect_loads<D>(mesh, t, ABACUS_NOT_DELAUNAY, memory);
        for (const abacus_status status :
             {mesh.stage(number<D>(random_points<D>(5, 1))), mesh.build()}) {
            EXPECT_EQ(status, ABACUS_ERROR);
            EXPECT_EQ(mesh.error.kind, ABACUS_ERROR_STATE);
            EXPECT_STRNE(mesh.error.hint, "");
        }
    }
}

TYPED_TEST(Load, CosphericalPointsMustBeTriangulatedAsAbacusWould) {
    constexpr int D = TestFixture::D;
    // One cell of a grid, mirrored: Delaunay except for the perturbation, but another
    // triangulation.
    auto t = delaunay<D>(grid<D>(2));
    MeshOf<D> same(0), mirrored(0);
    expect_loads<D>(same, t, ABACUS_DELAUNAY);
    for (auto &v : t.vertices) v.point[0] = 1 - v.point[0];
    expect_loads<D>(mirrored, t, ABACUS_WEAKLY_DELAUNAY);
}

/// Five tetrahedra in each cube; the inner ones alternate so that they fit together.
Triangulation<3> cubes_in_five(int n) {
    const auto id = [n](int x, int y, int z) {
        return static_cast<std::int64_t>((x * (n + 1) + y) * (n + 1) + z);
    };
    Triangulation<3> t;
    for (int x = 0; x <= n; ++x)
        for (int y = 0; y <= n; ++y)
            for (int z = 0; z <= n; ++z)
                t.vertices.push_back({id(x, y, z), {double(x), double(y), double(z)}});
    for (int x = 0; x < n; ++x)
        for (int y = 0; y < n; ++y)
            for (int z = 0; z < n; ++z) {
                const int odd = (x + y + z) % 2;
                const auto corner = [&](int i) {
                    return id(x + ((i & 1) ^ odd), y + (i >> 1 & 1), z + (i >> 2 & 1));
                };
                for (const auto &s : {Ids<3>{0, 3, 5, 6}, Ids<3>{1, 0, 3, 5}, Ids<3>{2, 0, 3, 6},
                                      Ids<3>{4, 0, 5, 6}, Ids<3>{7, 3, 5, 6}}) {
                    Ids<3> named;
                    for (int i = 0; i < 4; ++i) named[i] = corner(static_cast<int>(s[i]));
                    t.simplices.push_back(named);
                }
            }
    return t;
}

TEST(LoadInSpace, GridsOfOtherProgramsAreWeaklyDelaunay) {
    for (const int n : {1, 4}) {
        MeshOf<3> mesh(0, little);
        expect_loads<3>(mesh, cubes_in_five(n), ABACUS_WEAKLY_DELAUNAY);
    }
    // A vertex moved by a bit.
    for (const double to : {4 - 0x1p-50, 4 + 0x1p-50}) {
        auto t = cubes_in_five(4);
        t.vertices.back().point = {4, 4, to};
        MeshOf<3> mesh(0, little);
        expect_loads<3>(mesh, t, ABACUS_NOT_DELAUNAY);
    }
}

TYPED_TEST(Load, VerticesAreTriangulatedAnewIfThatIsWanted) {
    constexpr int D = TestFixture::D;
    auto mirrored = delaunay<D>(grid<D>(4));
    for (auto &v : mirrored.vertices) v.point[0] = -v.point[0];
    auto flipped = delaunay<D>(random_points<D>(500, 4));
    flip(flipped, 100, 5);
    const auto hollow =
        keeping<D>(delaunay<D>(grid<D>(6)), [](const auto &c) { return c[0] > 3 || c[1] > 2; });
    const auto same = delaunay<D>(random_points<D>(300, 6));
    for (const auto &t : {mirrored, flipped, hollow, same})
        for (const std::size_t memory : {tiny, ample}) {
            MeshOf<D> mesh(0, little);
            ASSERT_EQ(mesh.load(t.vertices, t.simplices, memory, true, true), ABACUS_OK)
                << mesh.error.message;
            ASSERT_EQ(mesh.build(), ABACUS_OK);
            std::vector<Point<D>> points;
            for (const auto &v : t.vertices) points.push_back(v.point);
            EXPECT_EQ(mesh.positions(), cgal_simplices<D>(points));
            EXPECT_EQ(mesh.header.facts.standing, 0u);
            EXPECT_EQ(mesh.check(), std::vector<std::string>{});
            EXPECT_TRUE(mesh.host.spools.empty());
            EXPECT_EQ(mesh.host.bytes, 0u);
        }
}

TYPED_TEST(Load, HolesPiecesAndPinches) {
    constexpr int D = TestFixture::D;
    const auto full = delaunay<D>(grid<D>(D == 2 ? 20 : 7));
    const double middle = D == 2 ? 9.5 : 3;
    const auto distance = [&](const Point<D> &p) {
        double sum = 0;
        for (const double x : p) sum += (x - middle) * (x - middle);
        return std::sqrt(sum);
    };
    const double r = middle / 2;
    std::vector<Triangulation<D>> cases;
    cases.push_back(keeping<D>(full, [&](const auto &c) { return distance(c) > r; })); // a hole
    cases.push_back(keeping<D>(full, [&](const auto &c) {                              // two pieces
        return distance(c) > 1.5 * r || distance(c) < 0.7 * r;
    }));
    cases.push_back(keeping<D>(full, [&](const auto &c) { // a chess board: pinched everywhere
        int sum = 0;
        for (const double x : c) sum += static_cast<int>(x);
        return sum % 2 == 0;
    }));
    auto apart = delaunay<D>(random_points<D>(100, 8)); // two convex pieces
    auto moved = apart;
    for (auto &v : moved.vertices) v.point[0] += 5;
    apart.add(moved, 100000);
    cases.push_back(apart);
    auto touching = delaunay<D>(grid<D>(3)); // two cubes that share a corner
    moved = touching;
    std::map<Point<D>, std::int64_t> ids;
    for (auto &v : moved.vertices) {
        for (double &x : v.point) x += 2;
        v.id += 100000;
    }
    for (auto &s : moved.simplices)
        for (auto &id : s) {
            id += 100000;
            if (moved.point(id) == touching.point(-7 + 3 * (D == 2 ? 8 : 26)))
                id = -7 + 3 * (D == 2 ? 8 : 26);
        }
    touching.add(moved, 0);
    touching.tidy();
    cases.push_back(touching);
    for (std::size_t i = 0; i < cases.size(); ++i)
        for (const std::size_t memory : {tiny, ample}) {
            SCOPED_TRACE("case " + std::to_string(i));
            MeshOf<D> mesh(0, little);
            expect_loads<D>(mesh, cases[i], ABACUS_NOT_CONVEX, memory);
        }
}

TYPED_TEST(Load, AttributesAndIdsStay) {
    constexpr int D = TestFixture::D;
    auto t = delaunay<D>(random_points<D>(800, 11));
    for (auto &v : t.vertices) v.attributes = {v.point[0] * 2, v.point[1] - 1};
    MeshOf<D> mesh(2, little);
    expect_loads<D>(mesh, t, ABACUS_DELAUNAY);
}

TYPED_TEST(Load, NothingAtAll) {
    constexpr int D = TestFixture::D;
    MeshOf<D> mesh(0);
    ASSERT_EQ(mesh.load({}, {}), ABACUS_OK) << mesh.error.message;
    EXPECT_EQ(mesh.header.facts.census.simplices, 0u);
    EXPECT_EQ(mesh.check(), std::vector<std::string>{});
}

TYPED_TEST(Load, TightClustersSpreadOverPages) {
    constexpr int D = TestFixture::D;
    auto points = random_points<D>(1200, 12);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (double &x : points[i]) x = static_cast<double>(i % 3) + x * 1e-12;
    MeshOf<D> mesh(0, little);
    expect_loads<D>(mesh, delaunay<D>(points), ABACUS_DELAUNAY);
    EXPECT_GT(mesh.host.pages.size(), 5u);
    EXPECT_NE(mesh.host.pages.rbegin()->first.part, 0u);
}

// ---- Faults ----------------------------------------------------------------------------

/// The error of loading.
template <int D> std::string refusal(Triangulation<D> t, bool reorient = true, bool mix = true) {
    if (mix) t.shuffle(6);
    MeshOf<D> mesh(0);
    const abacus_status status = mesh.load(t.vertices, t.simplices, ample, reorient);
    EXPECT_TRUE(mesh.host.pages.empty() || status == ABACUS_OK);
    EXPECT_EQ(mesh.host.bytes, 0u);
    if (status == ABACUS_OK) return "";
    EXPECT_EQ(mesh.error.kind, ABACUS_ERROR_ARGUMENT);
    EXPECT_STRNE(mesh.error.hint, "");
    EXPECT_EQ(mesh.header.facts.census.simplices, 0u);
    return mesh.error.message;
}

Triangulation<2> square() {
    return {{{1, {0, 0}}, {2, {4, 0}}, {3, {4, 4}}, {4, {0, 4}}}, {{1, 2, 3}, {1, 3, 4}}};
}

TEST(LoadFaults, InThePlane) {
    EXPECT_EQ(refusal(square()), "");
    const auto with = [](auto change) {
        auto t = square();
        change(t);
        return refusal(t, true, false);
    };
    EXPECT_EQ(with([](auto &t) {
                  t.vertices.push_back({2, {9, 9}});
              }),
              "two vertices have the id 2");
    EXPECT_EQ(with([](auto &t) {
                  t.vertices.push_back({5, {4, 4}});
                  t.simplices.push_back({5, 2, 4});
              }),
              "vertices 3 and 5 have the same coordinates");
    EXPECT_EQ(with([](auto &t) {
                  t.vertices.push_back({-5, {4, 4}});
                  t.simplices.push_back({-5, 2, 4});
              }),
              "vertices -5 and 3 have the same coordinates");
    EXPECT_EQ(with([](auto &t) { // in no simplex: omitted, wherever it is
                  t.vertices.insert(t.vertices.end(), {{5, {9, 9}}, {6, {4, 4}}, {-3, {1, 2}}});
              }),
              "");
    EXPECT_EQ(with([](auto &t) { t.simplices[1][2] = 7; }),
              "simplex (1, 3, 7) names vertex 7, which does not exist");
    EXPECT_EQ(with([](auto &t) { t.simplices[1][2] = -7; }),
              "simplex (1, 3, -7) names vertex -7, which does not exist");
    EXPECT_EQ(with([](auto &t) { t.simplices[1][2] = 1; }),
              "simplex (1, 3, 1) has the same vertex twice");
    EXPECT_EQ(with([](auto &t) {
                  t.vertices.push_back({5, {2, 2}});
                  t.simplices.push_back({1, 5, 3});
              }),
              "simplex (1, 5, 3) is flat");
    EXPECT_EQ(with([](auto &t) {
                  t.simplices.push_back({3, 1, 2});
              }),
              "simplex (1, 2, 3) is given twice");
    EXPECT_EQ(with([](auto &t) {
                  t.vertices.push_back({5, {1, 3.5}});
                  t.simplices.push_back({1, 3, 5});
              }),
              "facet (1, 3) belongs to 3 simplices");
    EXPECT_EQ(with([](auto &t) {
                  t.vertices.push_back({5, {3, 1}});
                  t.simplices[1] = {1, 3, 5};
                  t.vertices.erase(t.vertices.begin() + 3);
              }),
              "simplices (1, 2, 3) and (1, 3, 5) overlap");
    EXPECT_EQ(
        refusal(Triangulation<2>{// a hanging node
                                 {{1, {0, 0}}, {2, {4, 0}}, {3, {0, 4}}, {4, {2, 0}}, {5, {0, -4}}},
                                 {{1, 2, 3}, {1, 5, 4}}}),
        "simplices (1, 2, 3) and (1, 4, 5) meet in more than a common face");
    EXPECT_EQ(with([](auto &t) { // far from one another in the complex
                  t.vertices.insert(t.vertices.end(), {{5, {1, 0.5}}, {6, {9, 1}}, {7, {9, 2}}});
                  t.simplices.push_back({5, 6, 7});
              }),
              "simplices (1, 2, 3) and (5, 6, 7) overlap");
    EXPECT_EQ(with([](auto &t) { // inside, touching nothing
                  t.vertices.insert(t.vertices.end(), {{5, {2, 0.5}}, {6, {3, 0.5}}, {7, {3, 1}}});
                  t.simplices.push_back({5, 6, 7});
              }),
              "simplices (1, 2, 3) and (5, 6, 7) overlap");
    EXPECT_EQ(with([](auto &t) { // two edges cross; no vertex inside
                  t.vertices.insert(t.vertices.end(), {{5, {-1, 1}}, {6, {5, 1}}, {7, {2, -9}}});
                  t.simplices.push_back({5, 6, 7});
              })
                  .substr(0, 9),
              "simplices");
    EXPECT_EQ(with([](auto &t) { // beside it, but with a corner in the middle of an edge
                  t.vertices.insert(t.vertices.end(), {{5, {4, 2}}, {6, {6, 1}}, {7, {6, 3}}});
                  t.simplices.push_back({5, 6, 7});
              }),
              "simplices (1, 2, 3) and (5, 6, 7) meet in more than a common face");
    EXPECT_EQ(with([](auto &t) { // at a common corner, and into the mesh
                  t.vertices.insert(t.vertices.end(), {{5, {2, 3}}, {6, {3, 5}}});
                  t.simplices.push_back({3, 6, 5});
              })
                  .substr(0, 9),
              "simplices");
    EXPECT_EQ(with([](auto &t) { // around a shared corner, without overlap
                  t.vertices.insert(t.vertices.end(), {{5, {5, 6}}, {6, {6, 5}}});
                  t.simplices.push_back({3, 6, 5});
              }),
              "");
    auto turned = square();
    std::swap(turned.simplices[1][0], turned.simplices[1][1]);
    EXPECT_EQ(refusal(turned, true, false), "");
    EXPECT_EQ(refusal(turned, false, false), "simplex (3, 1, 4) has negative orientation");
    EXPECT_EQ(refusal(square(), false, false), "");
}

TEST(LoadFaults, ACoverThatIsLocallySound) {
    // A fan of triangles that goes around its centre twice: every facet has two sides.
    Triangulation<2> t;
    t.vertices.push_back({0, {0, 0}});
    for (int i = 0; i < 10; ++i)
        t.vertices.push_back({1 + i,
                              {(1 + 0.05 * i) * std::cos(i * 0.4 * 3.14159265358979),
                               (1 + 0.05 * i) * std::sin(i * 0.4 * 3.14159265358979)}});
    for (int i = 0; i < 10; ++i) t.simplices.push_back({0, 1 + i, 1 + (i + 1) % 10});
    EXPECT_EQ(refusal(t).substr(0, 9), "simplices");
}

Triangulation<3> two_tetrahedra() {
    return {{{1, {0, 0, 0}}, {2, {4, 0, 0}}, {3, {0, 4, 0}}, {4, {0, 0, 4}}, {5, {0, 0, -4}}},
            {{1, 2, 3, 4}, {1, 2, 3, 5}}};
}

TEST(LoadFaults, InSpace) {
    EXPECT_EQ(refusal(two_tetrahedra()), "");
    const auto with = [](auto change) {
        auto t = two_tetrahedra();
        change(t);
        return refusal(t, true, false);
    };
    EXPECT_EQ(with([](auto &t) {
                  t.vertices.push_back({6, {3, 3, 0}});
                  t.simplices.push_back({1, 2, 3, 6});
              }),
              "simplex (1, 2, 3, 6) is flat");
    EXPECT_EQ(with([](auto &t) {
                  t.vertices.push_back({6, {1, 1, 1}});
                  t.simplices.push_back({1, 2, 3, 6});
              }),
              "facet (1, 2, 3) belongs to 3 simplices");
    EXPECT_EQ(with([](auto &t) { t.vertices[4].point[2] = 3; }),
              "simplices (1, 2, 3, 4) and (1, 2, 3, 5) overlap");
    const auto beside = [&](Point<3> a, Point<3> b, Point<3> c, Point<3> d) {
        return with([&](auto &t) {
            t.vertices.insert(t.vertices.end(), {{6, a}, {7, b}, {8, c}, {9, d}});
            t.simplices.push_back({6, 7, 8, 9});
        });
    };
    EXPECT_EQ(beside({1, 1, 0.5}, {1.1, 1, 0.5}, {1, 1.1, 0.5}, {1, 1, 0.6}), // inside
              "simplices (1, 2, 3, 4) and (6, 7, 8, 9) overlap");
    EXPECT_EQ(beside({0.5, 0.5, 0.5}, {9, 9, 9}, {9, 8, 9}, {8, 9, 9}).substr(0, 9), "simplices");
    EXPECT_EQ(beside({-1, -1, 1}, {5, -1, 1}, {-1, -9, 2}, {-1, -9, -2}), "");    // clear of it
    EXPECT_EQ(beside({-1, 1, 1}, {5, 1, 1}, {5, 1, 1.5}, {5, 2, 1}).substr(0, 9), // pierces it
              "simplices");
    EXPECT_EQ(beside({2, -1, 0}, {2, -9, 1}, {2, -9, -1}, {3, -9, 0}), ""); // clear of it
    EXPECT_EQ(beside({2, 0, 0}, {2, -9, 1}, {2, -9, -1}, {3, -9, 0}), // touches an edge's middle
              "simplices (1, 2, 3, 4) and (6, 7, 8, 9) meet in more than a common face");
    EXPECT_EQ(beside({1, 0, 1}, {2, -9, 1}, {2, -9, -1}, {3, -9, 0}), // a face's middle
              "simplices (1, 2, 3, 4) and (6, 7, 8, 9) meet in more than a common face");
    EXPECT_EQ(with([](auto &t) { // one edge in common, faces crossing behind it
                  t.vertices.insert(t.vertices.end(), {{6, {1, -2, 1}}, {7, {1, 3, 0.5}}});
                  t.simplices.push_back({1, 2, 6, 7});
              })
                  .substr(0, 9),
              "simplices");
    EXPECT_EQ(with([](auto &t) { // one edge in common, clear of the others
                  t.vertices.insert(t.vertices.end(), {{6, {1, -2, 1}}, {7, {1, -2, -1}}});
                  t.simplices.push_back({1, 2, 6, 7});
              }),
              "");
    EXPECT_EQ(
        with([](auto &t) { // one vertex in common, and through the opposite face
            t.vertices.insert(t.vertices.end(), {{6, {5, 5, 4}}, {7, {5, 4, 5}}, {8, {4, 5, 5}}});
            t.simplices.push_back({1, 6, 7, 8});
        })
            .substr(0, 9),
        "simplices");
}

/// One vertex of a sound mesh moves at random: the mesh is refused exactly if a simplex turns over.
TEST(LoadFaults, OneMovedVertexIsFoundExactlyWhenItTurnsASimplex) {
    const auto sound = delaunay<2>(random_points<2>(150, 21));
    std::mt19937_64 random(22);
    std::uniform_real_distribution<double> shift(-0.1, 0.1);
    int refused = 0, taken = 0;
    for (int round = 0; round < 200; ++round) {
        auto t = sound;
        auto &v = t.vertices[random() % t.vertices.size()];
        for (double &x : v.point) x += shift(random);
        // A moved inner vertex leaves the mesh sound if and only if no triangle turns over.
        std::map<std::int64_t, Point<2>> at;
        for (const auto &vertex : t.vertices) at[vertex.id] = vertex.point;
        int links = 0, turned = 0;
        std::map<std::int64_t, int> around;
        for (std::size_t s = 0; s < t.simplices.size(); ++s) {
            const auto &ids = t.simplices[s];
            turned += orientation(at[ids[0]], at[ids[1]], at[ids[2]]) <= 0;
            if (std::count(ids.begin(), ids.end(), v.id) == 0) continue;
            for (const auto id : ids)
                if (id != v.id) ++around[id];
        }
        for (const auto &[id, n] : around) links += n == 1;
        if (links > 0) continue; // on the hull
        const std::string said = refusal(t);
        EXPECT_EQ(said.empty(), turned == 0) << said;
        said.empty() ? ++taken : ++refused;
    }
    EXPECT_GT(refused, 20);
    EXPECT_GT(taken, 20);
}

} // namespace
} // namespace abacus::test
