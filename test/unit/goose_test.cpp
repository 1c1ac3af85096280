// Goose makes the same triangulation as Abacus and CGAL, from rows that it finds only by boxes.
#include "geometry/box.hpp"
#include "geometry/conflict.hpp"
#include "goose/circumbox.hpp"
#include "goose/rim.hpp"
#include "support/memory_rtree.hpp"
#include "support/oracle.hpp"
#include "support/point_sets.hpp"
#include "support/sanitized.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace abacus::test {
namespace {

template <int D> struct GooseRun {
    abacus_status operator()(const std::vector<Point<D>> &points, std::size_t memory = 1 << 20) {
        return mesh.with_stage(number<D>(points), memory, [&](abacus_stage *stage) {
            const abacus_status ended = abacus_stage_end(stage, &mesh.header.facts, &mesh.error);
            if (ended != ABACUS_OK) return ended;
            return abacus_goose_run(mesh.host.table(), tree.table(), stage, &mesh.header.facts,
                                    &figures, &mesh.error);
        });
    }

    MeshOf<D> mesh;
    MemoryRTree<D> tree;
    abacus_goose_figures figures{};
};

// Even fewer with a sanitizer.
const std::size_t scale = sanitized ? 3 : 1;

/// Points of the set in random order; few, since testing all boxes is slow.
template <int D> std::vector<Point<D>> some_points(const PointSet<D> &set, std::size_t most) {
    Random random(11);
    std::vector<Point<D>> points = set.points(random);
    std::shuffle(points.begin(), points.end(), random);
    points.resize(std::min(points.size(), most));
    return points;
}

template <int D> void expect_triangulation(const std::vector<Point<D>> &points) {
    GooseRun<D> goose;
    ASSERT_EQ(goose(points), ABACUS_OK) << goose.mesh.error.message << goose.mesh.error.detail;
    EXPECT_EQ(positions_of<D>(goose.tree.simplices(false)), cgal_simplices<D>(points));

    const abacus_goose_figures &figures = goose.figures;
    EXPECT_EQ(figures.simplices, goose.tree.simplices(false).size());
    EXPECT_EQ(figures.ghosts, goose.tree.simplices(true).size());
    EXPECT_EQ(figures.created - figures.deleted, goose.tree.rows.size());
    EXPECT_EQ(goose.tree.unlinked, 0u);
    EXPECT_GE(figures.found, figures.deleted);
    EXPECT_GE(figures.total_ns, figures.search_ns + figures.test_ns + figures.unlink_ns +
                                    figures.erase_ns + figures.insert_ns);
    if (figures.vertices > 0) {
        EXPECT_EQ(figures.vertices + figures.duplicates, points.size());
    }

    MeshOf<D> abacus;
    ASSERT_EQ(abacus.insert(number<D>(points)), ABACUS_OK);
    EXPECT_EQ(abacus.header.facts.census.vertices, figures.vertices);
    EXPECT_EQ(abacus.header.facts.census.ghosts, figures.ghosts);
}

class GooseIn2D : public testing::TestWithParam<PointSet<2>> {};
TEST_P(GooseIn2D, EqualsCgal) { expect_triangulation<2>(some_points(GetParam(), 1200 / scale)); }
INSTANTIATE_TEST_SUITE_P(Inputs, GooseIn2D, testing::ValuesIn(point_sets<2>()),
                         [](const auto &info) { return info.param.name; });

class GooseIn3D : public testing::TestWithParam<PointSet<3>> {};
TEST_P(GooseIn3D, EqualsCgal) { expect_triangulation<3>(some_points(GetParam(), 250 / scale)); }
INSTANTIATE_TEST_SUITE_P(Inputs, GooseIn3D, testing::ValuesIn(point_sets<3>()),
                         [](const auto &info) { return info.param.name; });

TEST(Goose, GivesRowsAsAbacusHandsThemOut) {
    const std::vector<Point<2>> points = unit_square_points(500, 3);
    GooseRun<2> goose;
    ASSERT_EQ(goose(points), ABACUS_OK);
    Mesh abacus;
    ASSERT_EQ(abacus.insert(number(points)), ABACUS_OK);
    const auto ids = [](const std::vector<abacus_simplex> &simplices) {
        std::vector<std::array<std::int64_t, 3>> rows;
        for (const abacus_simplex &s : simplices) rows.push_back({s.id[0], s.id[1], s.id[2]});
        std::sort(rows.begin(), rows.end());
        return rows;
    };
    EXPECT_EQ(ids(goose.tree.simplices(false)), ids(abacus.simplices(false)));
}

TEST(Goose, HoldsPointsUntilTheySpanASimplex) {
    std::vector<Point<2>> line;
    for (int i = 0; i < 1000; ++i) line.push_back({i + 0.0, 2.0 * i});
    GooseRun<2> flat;
    ASSERT_EQ(flat(line), ABACUS_OK);
    EXPECT_EQ(flat.figures.vertices, 0u);
    EXPECT_TRUE(flat.tree.rows.empty());
    EXPECT_TRUE(flat.mesh.host.spools.empty());
    line.push_back({3, 3});
    line.push_back({3, 6}); // already there
    expect_triangulation<2>(line);

    GooseRun<3> nothing;
    EXPECT_EQ(nothing({}), ABACUS_OK);
    EXPECT_TRUE(nothing.tree.rows.empty());
}

TEST(Goose, TheFirstOfEqualPointsGivesTheId) {
    GooseRun<2> goose;
    ASSERT_EQ(goose({{0, 0}, {1, 0}, {0, 1}, {0, 0}, {1, 0}, {-0.0, 0}}), ABACUS_OK);
    EXPECT_EQ(goose.figures.duplicates, 3u);
    const auto simplices = goose.tree.simplices(false);
    ASSERT_EQ(simplices.size(), 1u);
    EXPECT_EQ(simplices[0].id[0], 0);
    EXPECT_EQ(simplices[0].id[1], 1);
    EXPECT_EQ(simplices[0].id[2], 2);
}

TEST(Goose, FindsTheRimOfACavityByTheFacetsThatComeOnce) {
    const auto triangle = [](Point<2> a, Point<2> b, Point<2> c) {
        abacus_simplex s{};
        std::copy(a.begin(), a.end(), s.corner[0]);
        std::copy(b.begin(), b.end(), s.corner[1]);
        std::copy(c.begin(), c.end(), s.corner[2]);
        return s;
    };
    MemoryHost memory;
    const Host host = memory.host();
    RimOfRows<2> rim(host);
    const abacus_simplex lower = triangle({0, 0}, {1, 0}, {1, 1}),
                         upper = triangle({0, 0}, {1, 1}, {0, 1}),
                         other = triangle({1, 1}, {0, 0}, {5, 0});
    abacus_simplex ghost = triangle({1, 0}, {0, 0}, {0, 0});
    ghost.ghost = 1;

    const abacus_simplex *square[] = {&lower, &upper, &ghost};
    int outer = 0, infinite = 0;
    for (const auto &facet : rim.find(square)) {
        EXPECT_FALSE(facet.row == 0 && facet.facet == 1); // the diagonal
        EXPECT_FALSE(facet.row == 0 && facet.facet == 2); // below it the ghost
        ++(facet.number[0] == rim.at_infinity ? infinite : outer);
    }
    EXPECT_EQ(outer, 3);
    EXPECT_EQ(infinite, 2);
    const abacus_simplex *no_ball[] = {&lower, &upper, &other};
    EXPECT_THROW(rim.find(no_ball), Error);
}

// ---- Boxes ---------------------------------------------------------------------------------

template <int D>
abacus_boxed_simplex boxed(const Circumboxes<D> &boxes, const std::vector<Point<D>> &corners) {
    abacus_boxed_simplex row{};
    row.simplex.ghost = corners.size() == D;
    for (std::size_t i = 0; i < corners.size(); ++i)
        std::copy(corners[i].begin(), corners[i].end(), row.simplex.corner[i]);
    boxes.enclose(row);
    return row;
}

template <int D> abacus_header domain(double lower, double upper) {
    abacus_header header{};
    header.facts.form.dimension = D;
    header.facts.form.has_domain = 1;
    std::fill_n(header.facts.form.lower, D, lower);
    std::fill_n(header.facts.form.upper, D, upper);
    return header;
}

TEST(Circumbox, IsThatOfTheSphereRoundedOutwards) {
    const Circumboxes<2> flat(domain<2>(-10, 10));
    const auto circle = boxed<2>(flat, {{5, 0}, {-3, 4}, {0, -5}});
    const Circumboxes<3> solid(domain<3>(-10, 10));
    const auto sphere = boxed<3>(solid, {{3, 0, 0}, {0, 3, 0}, {1, 2, 2}, {-2, -1, 2}});
    for (int k = 0; k < 3; ++k) {
        if (k < 2) {
            EXPECT_LE(circle.lower[k], -5);
            EXPECT_GE(circle.upper[k], 5);
            EXPECT_NEAR(circle.lower[k], -5, 1e-13);
            EXPECT_NEAR(circle.upper[k], 5, 1e-13);
        }
        EXPECT_LE(sphere.lower[k], -3);
        EXPECT_GE(sphere.upper[k], 3);
        EXPECT_NEAR(sphere.lower[k], -3, 1e-13);
        EXPECT_NEAR(sphere.upper[k], 3, 1e-13);
    }
}

TEST(Circumbox, OfAGhostIsItsShareOfTheDomain) {
    const Circumboxes<2> flat(domain<2>(0, 8));
    // The half-plane is on the left: it has the corner (8, 8). Reversed, it needs the whole domain.
    auto row = boxed<2>(flat, {{2, 8}, {8, 5}});
    EXPECT_LE(row.lower[0], 2);
    EXPECT_NEAR(row.lower[0], 2, 1e-14);
    EXPECT_LE(row.lower[1], 5);
    EXPECT_NEAR(row.lower[1], 5, 1e-14);
    EXPECT_EQ(row.upper[0], 8);
    EXPECT_EQ(row.upper[1], 8);
    row = boxed<2>(flat, {{8, 5}, {2, 8}});
    for (int k = 0; k < 2; ++k) {
        EXPECT_EQ(row.lower[k], 0);
        EXPECT_EQ(row.upper[k], 8);
    }
    // If the facet is on the border of the domain, only the border is left.
    row = boxed<2>(flat, {{8, 3}, {8, 1}});
    EXPECT_EQ(row.lower[0], 8);
    EXPECT_EQ(row.upper[0], 8);

    const Circumboxes<3> solid(domain<3>(0, 8));
    const auto top = boxed<3>(solid, {{0, 0, 7}, {8, 0, 7}, {0, 8, 7}});
    EXPECT_EQ(top.lower[2], 7);
    EXPECT_EQ(top.upper[2], 8);
    EXPECT_EQ(top.lower[0], 0);
    EXPECT_EQ(top.upper[1], 8);
}

/// The box contains every point of the domain in conflict, also for needles.
TEST(Circumbox, HoldsEveryPointInConflict) {
    Random random(5);
    int conflicts = 0;
    for (const double flatness : {1.0, 1e-9, 1e-15, 1e-300}) {
        for (int n = 0; n < 400; ++n) {
            std::array<Point<2>, 3> t;
            for (Point<2> &p : t) p = {unit(random), 0.5 + flatness * (unit(random) - 0.5)};
            const int turn = orientation(t[0], t[1], t[2]);
            if (turn == 0) continue;
            if (turn < 0) std::swap(t[0], t[1]);
            const Circumboxes<2> boxes(domain<2>(0, 1));
            const auto finite = boxed<2>(boxes, {t[0], t[1], t[2]});
            const auto ghost = boxed<2>(boxes, {t[0], t[1]});
            const auto inside = [&](const abacus_boxed_simplex &row, const Point<2> &p) {
                Point<2> at;
                boxes.scale(p, at.data());
                return row.lower[0] <= at[0] && at[0] <= row.upper[0] && row.lower[1] <= at[1] &&
                       at[1] <= row.upper[1];
            };
            for (int i = 0; i < 40; ++i) {
                const double spread = i % 2 ? 1 : flatness;
                const Point<2> p{unit(random), 0.5 + spread * (unit(random) - 0.5)};
                if (in_sphere({&t[0], &t[1], &t[2]}, p) > 0) {
                    EXPECT_TRUE(inside(finite, p));
                    ++conflicts;
                }
                if (orientation(t[0], t[1], p) >= 0) {
                    EXPECT_TRUE(inside(ghost, p));
                }
            }
        }
    }
    EXPECT_GT(conflicts, 5000);
}

template <int D> void expect_conflicts_in_boxes() {
    Random random(6);
    int conflicts = 0;
    for (int n = 0; n < 4000; ++n) {
        // Each axis of its own magnitude, or each coordinate.
        const bool is_by_axis = n % 2 == 0;
        std::array<int, D> exponent;
        const auto draw = [&](int &e) { e = int(random() % 2098) - 1074; };
        for (int &e : exponent) draw(e);
        Box<D> box;
        std::vector<Point<D>> points(D + 6);
        for (Point<D> &p : points) {
            for (int k = 0; k < D; ++k) {
                if (!is_by_axis) draw(exponent[k]);
                const double mantissa = 2 * unit(random) - 1;
                p[k] = std::ldexp(mantissa, exponent[k]);
            }
            box.extend(p);
        }
        Corners<D> corners;
        for (int i = 0; i <= D; ++i) corners[i] = &points[i];
        const int turn = orientation<D>(corners);
        if (turn == 0) continue;
        if (turn < 0) std::swap(points[0], points[1]);
        abacus_header header = domain<D>(0, 0);
        std::copy_n(box.lower.begin(), D, header.facts.form.lower);
        std::copy_n(box.upper.begin(), D, header.facts.form.upper);
        const Circumboxes<D> boxes(header);
        const auto finite = boxed<D>(boxes, {points.begin(), points.begin() + D + 1});
        const auto ghost = boxed<D>(boxes, {points.begin(), points.begin() + D});
        for (std::size_t i = D + 1; i < points.size(); ++i) {
            const Point<D> &p = points[i];
            const auto expect_in = [&](const abacus_boxed_simplex &row) {
                ++conflicts;
                Point<D> at;
                boxes.scale(p, at.data());
                for (int k = 0; k < D; ++k)
                    EXPECT_TRUE(row.lower[k] <= at[k] && at[k] <= row.upper[k]) << n;
            };
            if (side_of_simplex<D>(corners, p) == Side::inside) expect_in(finite);
            if (side_of_ghost<D>(corners, p) == Side::inside) expect_in(ghost);
        }
    }
    EXPECT_GT(conflicts, 4000);
}
TEST(Circumbox, HoldsEveryPointInConflictOfAnyMagnitude) {
    expect_conflicts_in_boxes<2>();
    expect_conflicts_in_boxes<3>();
}

TEST(Circumbox, BringsDomainsToASizeThatBoxesCanHave) {
    EXPECT_EQ(Circumboxes<2>(domain<2>(0, 1)).unit(), 1);
    EXPECT_EQ(Circumboxes<2>(domain<2>(-1e8, 1e8)).unit(), 1);
    for (const double size : {1e-3, 1e-9, 1e-300, 1e-310, 1e100, 1.7e308}) {
        const Circumboxes<2> boxes(domain<2>(-size, size));
        EXPECT_EQ(std::ilogb(boxes.unit()), std::log2(boxes.unit())) << size;
        const auto row = boxed<2>(boxes, {{-size, -size}, {size, -size}, {0, size}});
        const double width = row.upper[0] - row.lower[0];
        EXPECT_GE(width, 0x1p-99) << size;
        EXPECT_LE(width, 0x1p301) << size;
    }
    // Near 0 there is a least distance, so that no area underflows.
    const Circumboxes<2> boxes(domain<2>(-1, 1));
    const auto row = boxed<2>(boxes, {{0, 0}, {1e-60, 0}, {0, 1e-60}});
    for (int k = 0; k < 2; ++k) {
        EXPECT_EQ(row.lower[k], -0x1p-100);
        EXPECT_EQ(row.upper[k], 0x1p-100);
    }
}

// ---- Failures ------------------------------------------------------------------------------

TEST(Goose, FailsCleanlyWhereverTheDatabaseFails) {
    const std::vector<Point<2>> points = unit_square_points(60, 4);
    GooseRun<2> sound;
    ASSERT_EQ(sound(points), ABACUS_OK);
    for (std::uint64_t n = 1; n <= sound.tree.calls; ++n) {
        GooseRun<2> goose;
        goose.tree.fail_at = n;
        ASSERT_EQ(goose(points), ABACUS_HOST_ERROR) << n;
        EXPECT_EQ(goose.mesh.host.bytes, 0u) << n;
    }
    for (std::uint64_t n = 1; n < 40; ++n) {
        GooseRun<2> goose;
        goose.mesh.host.fail_resize_at(n);
        const abacus_status status = goose(points);
        EXPECT_EQ(goose.mesh.host.bytes, 0u) << n;
        if (status == ABACUS_OK) return;
        EXPECT_EQ(status, ABACUS_ERROR);
        EXPECT_EQ(goose.mesh.error.kind, ABACUS_ERROR_MEMORY);
    }
    FAIL() << "it allocates more often than that";
}

TEST(Goose, EndsWhenItIsCancelled) {
    GooseRun<3> goose;
    std::vector<Point<3>> points;
    for (int i = 0; i < 200; ++i) points.push_back({i % 7 + 0.0, i % 11 + 0.0, i % 13 + 0.0});
    goose.mesh.host.on_progress = [&](const abacus_progress &progress) {
        if (progress.phase == ABACUS_PHASE_INSERTING) goose.mesh.host.cancel();
    };
    EXPECT_EQ(goose(points), ABACUS_HOST_ERROR);
    EXPECT_EQ(goose.mesh.host.bytes, 0u);
}

TEST(Goose, NoticesASearchThatFindsNothing) {
    GooseRun<2> goose;
    goose.tree.blind = true;
    EXPECT_EQ(goose(unit_square_points(10, 5)), ABACUS_ERROR);
    EXPECT_EQ(goose.mesh.error.kind, ABACUS_ERROR_CORRUPTED);
}

} // namespace
} // namespace abacus::test
