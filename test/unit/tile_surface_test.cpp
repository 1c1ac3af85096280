// The surface of a mesh in a tile, with all triangles or as a grid: it covers what the mesh covers,
// and fits that of its neighbours.
#include "support/large_mesh.hpp"
#include "tiles/tile_surface.hpp"

#include <map>
#include <memory>
#include <set>

namespace abacus::test {
namespace {

constexpr abacus_tile_memory plenty{8 << 20, 8 << 20}, little{64 << 10, 64 << 10};

double plane_at(const Point<2> &p) { return 20 + 3 * p[0] - 5 * p[1]; }
double hills_at(const Point<2> &p) { return 20 + 9 * std::sin(9 * p[0]) * std::cos(7 * p[1]); }

/// A mesh over the unit square, with its corners; `dense` points are in its lower left quarter.
template <class Height>
std::unique_ptr<MeshOf<2>> mesh_of(int points, int dense, Height height, bool reversed = false) {
    Random random(static_cast<std::uint64_t>(points) + 1);
    auto mesh = std::make_unique<MeshOf<2>>(1, ample);
    std::vector<InputOf<2>> input;
    const auto add = [&](const Point<2> &p) {
        input.push_back({static_cast<std::int64_t>(input.size()), p, {height(p)}});
    };
    for (const double x : {0.0, 1.0})
        for (const double y : {0.0, 1.0}) add({x, y});
    for (int i = 0; i < points + dense; ++i) {
        const Point<2> p = unit_point<2>(random);
        add(i < points ? p : Point<2>{p[0] / 2, p[1] / 2});
    }
    if (reversed) std::reverse(input.begin(), input.end());
    EXPECT_EQ(mesh->insert(input), ABACUS_OK);
    return mesh;
}

Arena<SurfaceCorner> surface(const Host &host, MeshOf<2> &mesh, const Box<2> &box,
                             const abacus_tile_memory &memory = plenty) {
    return tile_surface(host, mesh.header, box, TileFrame(ABACUS_TILE_OWN), 0, memory);
}

double area_of(const Arena<SurfaceCorner> &corners) {
    double twice = 0;
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        const Point<2> &a = corners[i].at, &b = corners[i + 1].at, &c = corners[i + 2].at;
        const double part = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        EXPECT_GE(part, -1e-15); // counterclockwise
        twice += part;
    }
    return twice / 2;
}

/// Places and heights on a border.
std::set<std::array<double, 3>> on(const Arena<SurfaceCorner> &corners, TileBorder border) {
    std::set<std::array<double, 3>> found;
    for (const SurfaceCorner &corner : corners)
        if ((corner.borders & border) != 0)
            found.insert({corner.at[0], corner.at[1], corner.height});
    return found;
}

TEST(TileSurface, CoversWhatTheMeshCovers) {
    for (const auto &[points, dense] :
         {std::pair{50, 0}, std::pair{2000, 0}, std::pair{300, 20000}}) {
        const auto mesh = mesh_of(points, dense, plane_at);
        const Host host = mesh->host.host();
        for (const Box<2> &box : {Box<2>{{-1, -1}, {2, 2}}, Box<2>{{0.25, 0.125}, {0.5, 0.375}},
                                  Box<2>{{0.75, 0.5}, {1.25, 1}}}) {
            const auto corners = surface(host, *mesh, box);
            const double width = std::min(1.0, box.upper[0]) - std::max(0.0, box.lower[0]);
            const double height = std::min(1.0, box.upper[1]) - std::max(0.0, box.lower[1]);
            EXPECT_NEAR(area_of(corners), width * height, 1e-12);
            EXPECT_LE(corners.size(), 3 * 3 * most_surface_triangles);
            for (const SurfaceCorner &corner : corners) {
                EXPECT_NEAR(corner.height, plane_at(corner.at), 1e-11);
                const Point<3> normal = direction_of(corner.normal);
                EXPECT_GT(normal[2], 0);
                EXPECT_NEAR(normal[0] / normal[2], -3, 1e-6);
            }
        }
        EXPECT_EQ(surface(host, *mesh, {{1.5, 0}, {2, 1}}).size(), 0u);
    }
}

TEST(TileSurface, FitsItsNeighbours) {
    // Tiles with all triangles beside others, grids beside these, and grids beside each other
    for (const auto &[points, dense] :
         {std::pair{500, 0}, std::pair{500, 60000}, std::pair{90000, 0}}) {
        const auto mesh = mesh_of(points, dense, hills_at);
        const Host host = mesh->host.host();
        constexpr int n = 4;
        std::map<std::pair<int, int>, Arena<SurfaceCorner>> tiles;
        const auto at = [](int i) { return i / static_cast<double>(n); };
        for (int x = 0; x < n; ++x)
            for (int y = 0; y < n; ++y)
                tiles.emplace(std::pair(x, y),
                              surface(host, *mesh, {{at(x), at(y)}, {at(x + 1), at(y + 1)}}));
        for (int x = 0; x < n; ++x)
            for (int y = 0; y < n; ++y) {
                const auto &tile = tiles.at({x, y});
                EXPECT_FALSE(tile.empty());
                if (x + 1 < n) {
                    EXPECT_EQ(on(tile, east_border), on(tiles.at({x + 1, y}), west_border));
                }
                if (y + 1 < n) {
                    EXPECT_EQ(on(tile, north_border), on(tiles.at({x, y + 1}), south_border));
                }
            }
    }
}

TEST(TileSurface, DoesNotDependOnTheOrderOfPointsOrOnMemory) {
    for (const int points : {800, 40000}) {
        const auto mesh = mesh_of(points, 0, hills_at), other = mesh_of(points, 0, hills_at, true);
        const Host host = mesh->host.host(), of_other = other->host.host();
        const Box<2> box{{0.1, 0.2}, {0.9, 0.8}};
        const auto all = [](const Arena<SurfaceCorner> &corners) {
            std::multiset<std::array<double, 9>> found; // triangles, from their least corner on
            for (std::size_t i = 0; i < corners.size(); i += 3) {
                std::array<std::array<double, 3>, 3> t;
                for (std::size_t k = 0; k < 3; ++k)
                    t[k] = {corners[i + k].at[0], corners[i + k].at[1], corners[i + k].height};
                std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
                found.insert({t[0][0], t[0][1], t[0][2], t[1][0], t[1][1], t[1][2], t[2][0],
                              t[2][1], t[2][2]});
            }
            return found;
        };
        const auto wanted = all(surface(host, *mesh, box));
        EXPECT_EQ(all(surface(of_other, *other, box)), wanted);
        EXPECT_EQ(all(surface(host, *mesh, box, little)), wanted);
    }
}

TEST(TileSurface, LeavesOutWhatHasNoHeight) {
    const auto missing = [](const Point<2> &p) { return p[0] < 0.5 ? plane_at(p) : NAN; };
    for (const int points : {400, 50000}) {
        const auto mesh = mesh_of(points, 0, missing);
        const Host host = mesh->host.host();
        const auto corners = surface(host, *mesh, {{0, 0}, {1, 1}});
        EXPECT_GT(area_of(corners), 0.3);
        EXPECT_LT(area_of(corners), 0.5);
        for (const SurfaceCorner &corner : corners) {
            EXPECT_LT(corner.at[0], 0.5);
            EXPECT_TRUE(std::isfinite(corner.height));
        }
        EXPECT_EQ(surface(host, *mesh, {{0.75, 0}, {1, 1}}).size(), 0u);
    }
}

TEST(TileSurface, NormalsAreFiniteBesideHugeHeights) {
    const auto steep = [](const Point<2> &p) { return p[0] > 0.9 ? 1e300 : -1e300; };
    const auto mesh = mesh_of(100, 0, steep);
    const Host host = mesh->host.host();
    const auto corners = surface(host, *mesh, {{0, 0}, {1, 1}});
    ASSERT_FALSE(corners.empty());
    for (const SurfaceCorner &corner : corners)
        for (const double x : corner.normal) EXPECT_TRUE(std::isfinite(x));
}

TEST(TileSurface, MemoryIsGivenBack) {
    const auto mesh = mesh_of(300, 30000, hills_at);
    const std::size_t before = mesh->host.bytes;
    {
        const Host host = mesh->host.host();
        surface(host, *mesh, {{0, 0}, {1, 1}});
        surface(host, *mesh, {{0.5, 0.5}, {1, 1}});
    }
    EXPECT_EQ(mesh->host.bytes, before);
}

} // namespace
} // namespace abacus::test
