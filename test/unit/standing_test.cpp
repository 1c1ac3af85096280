// What a mesh with fixed edges means for reading: all that needs no empty circumspheres is the same
// as of any mesh.
#include "query/lines/line_scan.hpp"
#include "support/flipped_mesh.hpp"

#include <abacus/check.h>
#include <abacus/shapes.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace abacus::test {
namespace {

constexpr std::size_t little = 60 << 10, ample = 64 << 20;

void build(Mesh &mesh, int points) {
    auto input = number(unit_square_points(points, 8));
    for (auto &p : input) p.attributes = {p.point[0] + 2 * p.point[1]};
    ASSERT_EQ(mesh.stage(input), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.message;
}

Point<2> somewhere(Random &random) { return {1.2 * unit(random) - 0.1, 1.2 * unit(random) - 0.1}; }

abacus_simplex none() { return {}; }
bool is_same(const abacus_simplex &a, const abacus_simplex &b) {
    return a.code == b.code && std::equal(a.id, a.id + 3, b.id);
}

/// All simplices that contain a place; the first by comes_before() comes first.
std::vector<abacus_simplex> around(const std::vector<abacus_simplex> &all, const Point<2> &p) {
    std::vector<abacus_simplex> found;
    for (const abacus_simplex &s : all) {
        std::array<Point<2>, 3> corner;
        for (int i = 0; i < 3; ++i) corner[i] = {s.corner[i][0], s.corner[i][1]};
        if (in_simplex<2>({&corner[0], &corner[1], &corner[2]}, p) >= 0) found.push_back(s);
    }
    std::sort(found.begin(), found.end(), comes_before<2>);
    return found;
}

TEST(ConstrainedMeshes, AreLocatedIn) {
    Mesh mesh(1);
    build(mesh, 3000);
    ASSERT_GT(flip_edges(mesh, 20000, 9), 5000);
    call_constrained(mesh);
    const auto all = mesh.simplices(false);
    EXPECT_EQ(all.size(), mesh.header.facts.census.simplices);
    const Host host = mesh.host.host();
    Random random(10);
    for (const std::size_t bytes : {ample, little}) {
        Reader<2> reader(host, mesh.header.facts, bytes);
        for (int i = 0; i < 500; ++i) {
            Point<2> p = somewhere(random);
            if (i % 3 == 0) { // a vertex
                const auto &s = all[random() % all.size()];
                p = {s.corner[0][0], s.corner[0][1]};
            }
            const auto expected = around(all, p);
            abacus_simplex found = none();
            ASSERT_EQ(reader.locate(p, found), !expected.empty());
            EXPECT_TRUE(expected.empty() || is_same(found, expected[0]));
            std::vector<abacus_simplex> star;
            reader.star(p, [&](const abacus_simplex &s) { star.push_back(s); });
            EXPECT_EQ(star.size(), expected.size());
            EXPECT_EQ(reader.vertex_at(p).has_value(), i % 3 == 0);
        }
    }
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
}

/// Lengths of the pieces of lines, and the triangles.
std::vector<abacus_simplex> along(Mesh &mesh, const Point<2> &a, const Point<2> &b) {
    const Host host = mesh.host.host();
    Reader<2> reader(host, mesh.header.facts, ample);
    std::vector<abacus_simplex> pieces;
    double left = 0;
    bool is_first = true;
    LineScan<2>(reader, Line<2>::between(a, b)).each([&](const LinePiece<2> &piece) {
        EXPECT_TRUE(is_first || piece.enters.at == left);
        left = piece.leaves.at;
        is_first = false;
        pieces.push_back(piece.simplex);
        return true;
    });
    return pieces;
}

TEST(ConstrainedMeshes, AreCrossedByLines) {
    Mesh mesh(1);
    build(mesh, 2000);
    flip_edges(mesh, 20000, 11);
    call_constrained(mesh);
    const auto all = mesh.simplices(false);
    Random random(12);
    for (int i = 0; i < 20; ++i) {
        const Point<2> a = somewhere(random), b = somewhere(random);
        const auto pieces = along(mesh, a, b);
        std::size_t crossed = 0;
        for (const abacus_simplex &s : all) { // no vertex is on the line
            int sides[3];
            std::array<Point<2>, 3> corner;
            for (int k = 0; k < 3; ++k) {
                corner[k] = {s.corner[k][0], s.corner[k][1]};
                sides[k] = orientation(a, b, corner[k]);
            }
            const Corners<2> corners{&corner[0], &corner[1], &corner[2]};
            bool meets = in_simplex<2>(corners, a) >= 0 || in_simplex<2>(corners, b) >= 0;
            for (int k = 0; k < 3; ++k) {
                const Point<2> &p = corner[k], &q = corner[(k + 1) % 3];
                meets |= sides[k] * sides[(k + 1) % 3] < 0 &&
                         orientation(p, q, a) * orientation(p, q, b) < 0;
            }
            crossed += meets;
        }
        EXPECT_EQ(pieces.size(), crossed);
    }
}

abacus_host_status keep_row(void *context, const abacus_outline_row *row) {
    static_cast<std::vector<std::int64_t> *>(context)->push_back(row->vertex);
    return ABACUS_HOST_OK;
}

TEST(ConstrainedMeshes, HaveTheHullOfTheirPoints) {
    Mesh mesh(1);
    build(mesh, 2000);
    const abacus_outline_kind hull{};
    std::vector<std::int64_t> rows[2];
    for (auto &ring : rows) {
        abacus_error error{};
        ASSERT_EQ(abacus_outline(mesh.host.table(), &mesh.header.facts, &hull, ample, ample,
                                 keep_row, &ring, &error),
                  ABACUS_OK)
            << error.message;
        flip_edges(mesh, 5000, 13);
        call_constrained(mesh);
    }
    EXPECT_FALSE(rows[0].empty());
    EXPECT_EQ(rows[0], rows[1]);
}

TEST(ConstrainedMeshes, AreChecked) {
    Mesh mesh(1);
    build(mesh, 2000);
    call_constrained(mesh);
    EXPECT_EQ(mesh.check(), std::vector<std::string>{});
    mesh.header.facts.census.vertices += 2;
    mesh.header.facts.census.simplices += 4;
    EXPECT_FALSE(mesh.check().empty());
    mesh.header.facts.census.simplices -= 4;
    EXPECT_FALSE(mesh.check().empty()); // Euler's relation, and the stars
    mesh.header.facts.census.vertices -= 2;
    flip_edges(mesh, 1, 14); // an edge that is not fixed
    EXPECT_FALSE(mesh.check().empty());
}

TEST(ConstrainedMeshes, AreInterpolated) {
    Mesh mesh(1);
    build(mesh, 500);
    flip_edges(mesh, 5000, 15);
    call_constrained(mesh);
    mesh.header.facts.census.soft_lines = 1;
    OpenMesh open(mesh, ample);
    abacus_interpolation how{};
    how.method = ABACUS_LINEAR;
    how.attributes = 1;
    how.extent = {};
    double value = 0;
    ASSERT_EQ(open.interpolate(how, {0.4, 0.5}, &value), ABACUS_OK);
    EXPECT_NEAR(value, 1.4, 1e-12);
    how.method = ABACUS_NEAREST;
    ASSERT_EQ(open.interpolate(how, {0.4, 0.5}, &value), ABACUS_OK);
    EXPECT_NEAR(value, 1.4, 0.2);
    how.method = ABACUS_NATURAL;
    ASSERT_EQ(open.interpolate(how, {0.4, 0.5}, &value), ABACUS_OK);
    EXPECT_NEAR(value, 1.4, 1e-12);
}

TEST(ConstrainedMeshes, HaveNoVoronoiCellsAndNoAlphaShape) {
    Mesh mesh(1);
    build(mesh, 100);
    call_constrained(mesh);
    abacus_error error{};
    abacus_outline_kind alpha{};
    alpha.has_alpha = 1;
    alpha.alpha = 1;
    std::vector<std::int64_t> rows;
    EXPECT_EQ(abacus_outline(mesh.host.table(), &mesh.header.facts, &alpha, ample, ample, keep_row,
                             &rows, &error),
              ABACUS_ERROR);
    EXPECT_EQ(error.kind, ABACUS_ERROR_STATE);
    EXPECT_STREQ(error.message, "an alpha shape needs a Delaunay mesh");
    EXPECT_STREQ(error.detail, "The mesh has lines, whose edges are fixed.");
}

} // namespace
} // namespace abacus::test
