// Lines of a mesh that is loaded: edges that are fixed come back with their places, edges between
// cocircular vertices are counted, and then the mesh is as one made of the same points and lines.
#include "support/oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <set>

namespace abacus::test {
namespace {

constexpr std::size_t tiny = 1, little = 60 << 10, ample = 64 << 20;
constexpr int side = 40;

using Edge = std::array<std::int64_t, 2>;

/// A square of cells, each cut along one of its diagonals, and edges of it.
struct Grid {
    std::vector<Input> vertices;
    std::vector<std::uint64_t> triangles; // three ids each
    std::vector<Edge> edges;
    std::set<Edge> diagonals; // from below to above, either way

    explicit Grid(unsigned seed) {
        std::mt19937 random(seed);
        const auto add_triangle = [&](auto... id) {
            (triangles.push_back(static_cast<std::uint64_t>(id)), ...);
        };
        for (int x = 0; x < side; ++x)
            for (int y = 0; y < side; ++y) {
                const std::int64_t a = id(x, y), b = id(x + 1, y), c = id(x + 1, y + 1),
                                   d = id(x, y + 1);
                vertices.push_back({a, {double(x), double(y)}});
                if (x + 1 < side) edges.push_back({a, b});
                if (y + 1 < side) edges.push_back({d, a});
                if (x + 1 == side || y + 1 == side) continue;
                if (random() % 2 == 0) {
                    add_triangle(a, b, c);
                    add_triangle(c, d, a);
                    diagonals.insert({a, c});
                } else {
                    add_triangle(a, b, d);
                    add_triangle(c, d, b);
                    diagonals.insert({b, d});
                }
            }
        edges.insert(edges.end(), diagonals.begin(), diagonals.end());
        std::shuffle(edges.begin(), edges.end(), random);
    }
    static std::int64_t id(int x, int y) { return 1000 * x + y - 500; }
    static Point<2> place(std::int64_t id) {
        return {double((id + 500) / 1000), double((id + 500) % 1000)};
    }
};

abacus_segments *open_segments(Mesh &mesh, const std::vector<Edge> &edges) {
    abacus_segments *segments = nullptr;
    EXPECT_EQ(
        abacus_segments_open(mesh.host.table(), &mesh.header.facts, little, &segments, &mesh.error),
        ABACUS_OK);
    for (const auto &[a, b] : edges) {
        const Point<2> p = Grid::place(a), q = Grid::place(b);
        const abacus_segment segment{{{p[0], p[1]}, {q[0], q[1]}}, 0};
        EXPECT_EQ(abacus_segments_add(segments, &segment, 1, &mesh.error), ABACUS_OK);
    }
    return segments;
}

void close_segments(Mesh &mesh, abacus_segments *segments) {
    EXPECT_EQ(abacus_segments_end(segments, &mesh.error), ABACUS_OK);
    abacus_segments_close(segments);
}

/// Fixes edges, and then restores ties unless there are none.
void fix(Mesh &mesh, const std::vector<Edge> &edges, abacus_segments *ties) {
    mesh.header.facts.census.lines = 1;
    mesh.header.facts.standing = ABACUS_CONSTRAINED;
    abacus_segments *segments = open_segments(mesh, edges);
    const abacus_status status = mesh.with_build([&](abacus_build *build) {
        const abacus_status fixed = abacus_build_fix(build, segments, &mesh.header, &mesh.error);
        return fixed == ABACUS_OK && ties != nullptr
                   ? abacus_build_restore(build, ties, &mesh.header, &mesh.error)
                   : fixed;
    });
    EXPECT_EQ(status, ABACUS_OK) << mesh.error.message;
    close_segments(mesh, segments);
}

/// An open load of the grid with these edges on line 7.
abacus_load *open_load(Mesh &mesh, const Grid &grid, const std::vector<Edge> &edges,
                       std::size_t memory) {
    abacus_load *load = nullptr;
    EXPECT_EQ(
        abacus_load_open(mesh.host.table(), &mesh.header.facts, memory, 1, 0, &load, &mesh.error),
        ABACUS_OK);
    for (const Input &vertex : grid.vertices) {
        std::array<std::uint64_t, 3> record{static_cast<std::uint64_t>(vertex.id)};
        std::memcpy(record.data() + 1, vertex.point.data(), sizeof vertex.point);
        EXPECT_EQ(abacus_load_vertices(load, record.data(), 1, &mesh.error), ABACUS_OK);
    }
    EXPECT_EQ(
        abacus_load_simplices(load, grid.triangles.data(), grid.triangles.size() / 3, &mesh.error),
        ABACUS_OK);
    EXPECT_EQ(abacus_load_lines(load, nullptr, 0, &mesh.error), ABACUS_OK);
    for (const auto &[a, b] : edges) {
        const std::uint64_t row[] = {7, static_cast<std::uint64_t>(a),
                                     static_cast<std::uint64_t>(b)};
        EXPECT_EQ(abacus_load_lines(load, row, 1, &mesh.error), ABACUS_OK);
    }
    return load;
}

void expect_edges(abacus_load *load, const std::vector<Edge> &edges) {
    std::array<abacus_loaded_edge, 7> fetched;
    std::vector<bool> seen(edges.size());
    std::size_t count = 0;
    abacus_error error{};
    while (abacus_load_edges(load, fetched.data(), fetched.size(), &count, &error) == ABACUS_OK &&
           count > 0)
        for (std::size_t i = 0; i < count; ++i) {
            const abacus_loaded_edge &edge = fetched[i];
            const auto row = static_cast<std::size_t>(edge.row - 1);
            ASSERT_LT(row, edges.size());
            EXPECT_FALSE(seen[row]);
            seen[row] = true;
            EXPECT_EQ(edge.line, 7);
            for (std::size_t end : {0, 1}) {
                EXPECT_EQ(edge.ids[end], edges[row][end]);
                const Point<2> p = Grid::place(edge.ids[end]);
                EXPECT_EQ(edge.ends[end][0], p[0]);
                EXPECT_EQ(edge.ends[end][1], p[1]);
            }
        }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), false), 0);
}

void expect_as_made_anew(std::size_t fixed, std::size_t memory, std::size_t cache) {
    const Grid grid(static_cast<unsigned>(fixed + 1));
    std::vector<Edge> edges(grid.edges.begin(),
                            grid.edges.begin() + static_cast<std::ptrdiff_t>(fixed));
    if (!edges.empty()) edges.push_back({edges[0][1], edges[0][0]}); // once more, turned
    Mesh mesh(0, cache), fresh;
    abacus_load *load = open_load(mesh, grid, edges, memory);
    abacus_delaunay delaunay = ABACUS_NOT_CONVEX;
    ASSERT_EQ(abacus_load_check(load, &delaunay, &mesh.error), ABACUS_OK) << mesh.error.message;
    EXPECT_EQ(delaunay, ABACUS_WEAKLY_DELAUNAY);
    expect_edges(load, edges);
    ASSERT_EQ(abacus_load_write(load, 0, &mesh.header, &mesh.error), ABACUS_OK);
    EXPECT_EQ(mesh.header.facts.standing, ABACUS_DELAUNAY);
    abacus_segments *ties = open_segments(mesh, {});
    std::uint64_t count = 0;
    ASSERT_EQ(abacus_load_ties(load, ties, &count, &mesh.error), ABACUS_OK);
    abacus_load_close(load);
    fix(mesh, edges, ties);
    close_segments(mesh, ties);
    EXPECT_EQ(mesh.check(), std::vector<std::string>{});
    EXPECT_TRUE(mesh.host.spools.empty());

    ASSERT_EQ(fresh.insert(grid.vertices), ABACUS_OK);
    fix(fresh, edges, nullptr);
    // of the diagonals that are not fixed, those that are not made anew
    const auto made = fresh.positions();
    EXPECT_EQ(mesh.positions(), made);
    std::uint64_t others = 0;
    for (const Edge &diagonal : grid.diagonals) {
        const Point<2> p = Grid::place(diagonal[0]), q = Grid::place(diagonal[1]);
        const auto has = [&](const Positions<2> &triangle, const Point<2> &corner) {
            return std::find(triangle.begin(), triangle.end(), corner) != triangle.end();
        };
        others += std::none_of(made.begin(), made.end(),
                               [&](const auto &t) { return has(t, p) && has(t, q); });
    }
    EXPECT_EQ(count, others);
}

TEST(LoadLines, WithoutLinesTiesAreFlipped) { expect_as_made_anew(0, ample, ample); }
TEST(LoadLines, FewEdges) { expect_as_made_anew(100, ample, ample); }
TEST(LoadLines, ManyEdgesInLittleMemory) { expect_as_made_anew(2500, tiny, little); }

TEST(LoadLines, NamesEdgesThatAreMissing) {
    const Grid grid(5);
    Mesh mesh;
    abacus_load *load = open_load(mesh, grid, {{-500, -498}, {-500, 12345}, {-499, -499}}, ample);
    abacus_delaunay delaunay = ABACUS_DELAUNAY;
    EXPECT_EQ(abacus_load_check(load, &delaunay, &mesh.error), ABACUS_ERROR);
    EXPECT_STREQ(mesh.error.message, "line 7 has an edge from vertex -499 to itself");
    abacus_load_close(load);
    load = open_load(mesh, grid, {{-500, -498}, {-500, 12345}}, tiny);
    EXPECT_EQ(abacus_load_check(load, &delaunay, &mesh.error), ABACUS_ERROR);
    EXPECT_NE(std::string(abacus_load_detail(load))
                  .find("\nline 7 names vertex 12345, which no simplex has"),
              std::string::npos);
    EXPECT_NE(std::string(abacus_load_detail(load))
                  .find("\nline 7 names edge (-500, -498), which no simplex has"),
              std::string::npos);
    abacus_load_close(load);
}

TEST(LoadLines, NeedThePlane) {
    MeshOf<3> solid;
    abacus_load *load = nullptr;
    ASSERT_EQ(
        abacus_load_open(solid.host.table(), &solid.header.facts, ample, 1, 0, &load, &solid.error),
        ABACUS_OK);
    EXPECT_EQ(abacus_load_lines(load, nullptr, 0, &solid.error), ABACUS_ERROR);
    abacus_load_close(load);
}

} // namespace
} // namespace abacus::test
