// Contours: pieces of one triangle, lines of meshes for any memory, rings, damaged pages.
#include "query/levels/contour_rings.hpp"
#include "query/levels/contours.hpp"
#include "support/point_sets.hpp"
#include "support/triangulations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

namespace abacus::test {
namespace {

struct Row {
    std::int64_t id;
    double value;
    bool is_closed;
    std::vector<Point<2>> path;

    bool operator==(const Row &) const = default;
};

abacus_host_status keep(void *context, std::int64_t id, double value, std::int32_t closed,
                        const double *path, std::size_t count) {
    Row row{id, value, closed != 0, {}};
    for (std::size_t i = 0; i < count; ++i) row.path.push_back({path[2 * i], path[2 * i + 1]});
    static_cast<std::vector<Row> *>(context)->push_back(row);
    return ABACUS_HOST_OK;
}

abacus_contouring levels_of(double interval, double base = 0, int bands = 0) {
    abacus_contouring how{};
    how.interval = interval;
    how.base = base;
    how.bands = bands;
    return how;
}

std::vector<Row> contours(MeshOf<2> &mesh, const abacus_contouring &how,
                          const abacus_window &window = {}, std::size_t memory = 1 << 24) {
    std::vector<Row> rows;
    const Host host = mesh.host.host();
    Contours(host, mesh.header, window, how, memory).each(keep, &rows);
    return rows;
}

double area(const std::vector<Point<2>> &ring) {
    double twice = 0;
    for (std::size_t i = 0; i + 1 < ring.size(); ++i)
        twice += (ring[i][0] - ring[0][0]) * (ring[i + 1][1] - ring[0][1]) -
                 (ring[i][1] - ring[0][1]) * (ring[i + 1][0] - ring[0][0]);
    return twice / 2;
}

// ---- One triangle -----------------------------------------------------------------------

/// The bands along an edge follow one another, each from where the one before ends.
TEST(ContourCut, BandsFollowOneAnotherAlongALine) {
    const abacus_contouring how = levels_of(1);
    ContourLevels levels(how);
    const ContourPoint a{{0, 0}, 1}, b{{10, 0}, 2};
    for (const auto &[from, to] : {std::pair{0.5, 3.5}, {3.5, 0.5}, {2.0, 2.5}, {1.0, 3.0}}) {
        const ContourEdge edge(a, from, b, to);
        std::vector<ContourPiece> pieces;
        cut_into_bands(
            ContourCorner{a, from, levels.rank(from), {}, 0},
            ContourCorner{b, to, levels.rank(to), {}, 0},
            [&](std::int64_t level, bool is_upper) {
                return ContourEnd{edge.crossing(levels.level(level)),
                                  {is_upper ? ContourKind::upper : ContourKind::lower, &a, &b}};
            },
            [&](const ContourPiece &piece) { pieces.push_back(piece); });
        ASSERT_EQ(pieces.size(), 1 + std::abs(levels.rank(to) - levels.rank(from)));
        EXPECT_EQ(pieces.front().tail.place, a);
        EXPECT_EQ(pieces.back().head.place, b);
        for (std::size_t i = 1; i < pieces.size(); ++i) {
            EXPECT_EQ(pieces[i].tail.place, pieces[i - 1].head.place);
            EXPECT_EQ(std::abs(pieces[i].level - pieces[i - 1].level), 1);
        }
    }
}

/// Both triangles at an edge compute the same crossing.
TEST(ContourCut, CrossingsDependOnTheEdgeAlone) {
    Random random(3);
    for (int i = 0; i < 1000; ++i) {
        const ContourPoint p{{unit(random), unit(random)}, 1}, q{{unit(random), unit(random)}, 2};
        const double value_p = unit(random), value_q = unit(random);
        for (const double level : {value_p, value_q, (value_p + value_q) / 2}) {
            const Point<2> one = ContourEdge(p, value_p, q, value_q).crossing(level);
            EXPECT_EQ(one, ContourEdge(q, value_q, p, value_p).crossing(level));
        }
        EXPECT_EQ(ContourEdge(p, value_p, q, value_q).crossing(value_p), p);
        EXPECT_EQ(ContourEdge(p, value_p, q, value_q).crossing(value_q), q);
    }
}

TEST(ContourLevels, RanksAreThoseOfTheLevels) {
    Random random(4);
    for (const double interval : {0.1, 1.0, 3e-7, 1e5}) {
        const abacus_contouring how = levels_of(interval, 0.3);
        ContourLevels levels(how);
        for (int i = 0; i < 1000; ++i) {
            const double value = i % 2 == 0
                                     ? levels.level(static_cast<std::int64_t>(random() % 1000))
                                     : (unit(random) - 0.5) * 100 * interval;
            const std::int64_t rank = levels.rank(value);
            EXPECT_LE(levels.level(rank), value);
            EXPECT_LT(value, levels.level(rank + 1));
        }
    }
    const double fixed[] = {-1, 2, 2.5};
    abacus_contouring how{};
    how.fixed = fixed;
    how.fixed_count = 3;
    ContourLevels levels(how);
    EXPECT_EQ(levels.rank(-2), -1);
    EXPECT_EQ(levels.rank(-1), 0);
    EXPECT_EQ(levels.rank(2.4), 1);
    EXPECT_EQ(levels.rank(99), 2);
    EXPECT_TRUE(std::isinf(levels.level(-1)));
    const abacus_contouring fine = levels_of(1e-9);
    EXPECT_THROW((ContourLevels(fine).rank(0), ContourLevels(fine).rank(1e9)), Error);
    levels.include({0, 1'000'000});
    levels.include({-999'000'000, -5});
    EXPECT_THROW(levels.include({0, 1'000'001}), Error);
}

// ---- Rings ------------------------------------------------------------------------------

TEST(ContourRings, ATouchingPathIsTakenApart) {
    MemoryHost store;
    const Host host = store.host();
    ContourRings rings(host);
    Arena<Point<2>> path(host);
    // Two squares that touch, with a spike at one, and a line that leads out and back.
    for (const Point<2> p : {Point<2>{0, 0},
                             {2, 0},
                             {2, 2},
                             {4, 2},
                             {4, 4},
                             {5, 5},
                             {4, 4},
                             {2, 4},
                             {2, 2},
                             {0, 2},
                             {-1, 3},
                             {-2, 3},
                             {-1, 3},
                             {0, 2},
                             {0, 0}})
        path.push_back(p);
    std::vector<double> areas;
    rings.each(path, [&](const Arena<Point<2>> &ring) {
        EXPECT_EQ(ring.size(), 5u);
        areas.push_back(area({ring.begin(), ring.end()}));
    });
    EXPECT_EQ(areas, (std::vector<double>{4, 4}));
}

/// Whether a ring has an area is exact, even if its area is no double.
TEST(ContourRings, AtTheLimitsOfDoubles) {
    constexpr double least = std::numeric_limits<double>::denorm_min();
    MemoryHost store;
    const Host host = store.host();
    ContourRings rings(host);
    const auto count = [&](const std::vector<Point<2>> &points) {
        Arena<Point<2>> path(host);
        for (const Point<2> &p : points) path.push_back(p);
        int found = 0;
        rings.each(path, [&](const Arena<Point<2>> &) { ++found; });
        return found;
    };
    for (const double unit : {least, 0x1p-700, 1.0, 0x1p1000}) {
        EXPECT_EQ(count({{0, 0}, {unit, 0}, {0, unit}, {0, 0}}), 1) << unit;
        EXPECT_EQ(count({{1, unit}, {2, 3 * unit}, {3, 6 * unit}, {1, unit}}), 1) << unit;
        EXPECT_EQ(count({{1, unit}, {2, 3 * unit}, {3, 5 * unit}, {1, unit}}), 0) << unit;
    }
}

// ---- Meshes -----------------------------------------------------------------------------

/// Heights that change from vertex to vertex, some of them levels.
double height(const Point<2> &p, std::size_t i) {
    return i % 5 == 0 ? static_cast<double>(i % 7) : 8 * p[0] * p[1] + static_cast<double>(i % 3);
}

std::vector<InputOf<2>> field(int n, unsigned seed) {
    Random random(seed);
    std::vector<InputOf<2>> points;
    for (int i = 0; i < n; ++i) {
        const Point<2> p{unit(random), unit(random)};
        points.push_back({i, p, {height(p, static_cast<std::size_t>(i))}});
    }
    return points;
}

/// The points of each line of a level, sorted, by walking from edge to edge.
std::multiset<std::multiset<Point<2>>> walked(MeshOf<2> &mesh,
                                              const std::vector<InputOf<2>> &points, double level) {
    const auto value = [&](std::int64_t id) {
        return points[static_cast<std::size_t>(id)].attributes[0];
    };
    const auto crossing = [&](const std::set<std::int64_t> &edge) {
        const auto &a = points[static_cast<std::size_t>(*edge.begin())],
                   &b = points[static_cast<std::size_t>(*edge.rbegin())];
        const ContourPoint from{a.point, a.id}, to{b.point, b.id};
        return ContourEdge(from, a.attributes[0], to, b.attributes[0]).crossing(level);
    };
    std::map<std::set<std::int64_t>, std::vector<std::set<std::int64_t>>> next;
    for (const abacus_simplex &s : mesh.simplices(false)) {
        std::vector<std::set<std::int64_t>> crossed;
        for (int i = 0; i < 3; ++i)
            if ((value(s.id[i]) < level) != (value(s.id[(i + 1) % 3]) < level))
                crossed.push_back({s.id[i], s.id[(i + 1) % 3]});
        if (crossed.size() != 2) continue;
        next[crossed[0]].push_back(crossed[1]);
        next[crossed[1]].push_back(crossed[0]);
    }
    std::multiset<std::multiset<Point<2>>> lines;
    std::set<std::set<std::int64_t>> done;
    for (const auto &[first, around] : next) {
        std::set<Point<2>> line;
        std::vector<std::set<std::int64_t>> open{first};
        while (!open.empty()) {
            const auto edge = open.back();
            open.pop_back();
            if (!done.insert(edge).second) continue;
            line.insert(crossing(edge));
            for (const auto &other : next[edge]) open.push_back(other);
        }
        if (line.size() > 1) lines.insert({line.begin(), line.end()});
    }
    return lines;
}

TEST(Contours, LinesAreThoseOfAWalk) {
    const auto points = field(3000, 5);
    MeshOf<2> mesh(1);
    ASSERT_EQ(mesh.insert(points), ABACUS_OK) << mesh.error.detail;
    const abacus_contouring how = levels_of(1);
    const auto rows = contours(mesh, how);
    ASSERT_GT(rows.size(), 100u);
    for (int level = 0; level < 12; ++level) {
        std::multiset<std::multiset<Point<2>>> lines;
        for (const Row &row : rows) {
            if (row.value != level) continue;
            const std::set<Point<2>> line(row.path.begin(), row.path.end());
            lines.insert({line.begin(), line.end()});
            EXPECT_EQ(row.is_closed, row.path.front() == row.path.back());
        }
        EXPECT_TRUE(lines == walked(mesh, points, level)) << level;
    }
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
    EXPECT_EQ(mesh.host.bytes, 0u);
}

TEST(Contours, AreTheSameWithLittleMemoryAndInAnyOrder) {
    auto points = field(4000, 6);
    MeshOf<2> mesh(1), turned(1);
    ASSERT_EQ(mesh.insert(points), ABACUS_OK);
    std::reverse(points.begin(), points.end());
    ASSERT_EQ(turned.insert(points), ABACUS_OK);
    for (const int bands : {0, 1}) {
        const abacus_contouring how = levels_of(0.125, 0, bands);
        for (const abacus_window &window :
             {abacus_window{}, abacus_window{ABACUS_BOX_WINDOW, {0.2, 0.3}, {0.6, 0.9}, {}, 0}}) {
            const auto rows = contours(mesh, how, window);
            ASSERT_GT(rows.size(), 100u);
            EXPECT_TRUE(contours(mesh, how, window, 0) == rows);
            EXPECT_TRUE(contours(turned, how, window) == rows);
        }
    }
}

TEST(Contours, BandsHaveTheAreaOfTheirWindow) {
    auto points = field(2000, 7);
    MeshOf<2> mesh(1);
    ASSERT_EQ(mesh.insert(points), ABACUS_OK);
    const abacus_contouring how = levels_of(0.5, 0, 1);
    Random random(8);
    for (int i = 0; i < 20; ++i) {
        abacus_window window{ABACUS_BOX_WINDOW, {}, {}, {}, 0};
        for (int axis = 0; axis < 2; ++axis) {
            // Some sides go through vertices.
            const double a = i % 2 == 0 ? points[random() % 100].point[axis] : unit(random);
            const double b = unit(random);
            window.lower[axis] = 0.1 + 0.8 * std::min(a, b);
            window.upper[axis] = 0.1 + 0.8 * std::max(a, b);
            if (i % 2 == 0 && a > 0.1 && a < 0.9) (a < b ? window.lower : window.upper)[axis] = a;
        }
        double sum = 0;
        for (const Row &row : contours(mesh, how, window)) {
            EXPECT_TRUE(row.is_closed);
            EXPECT_NE(area(row.path), 0);
            sum += area(row.path);
        }
        EXPECT_NEAR(sum, (window.upper[0] - window.lower[0]) * (window.upper[1] - window.lower[1]),
                    1e-9);
    }
}

TEST(Contours, HolesAndPiecesHaveRims) {
    const auto points = field(2500, 9);
    std::vector<Point<2>> places;
    for (const auto &p : points) places.push_back(p.point);
    // Squares that touch at corners, so that the rim passes there twice.
    auto t = keeping<2>(delaunay<2>(places), [](const Point<2> &c) {
        return (static_cast<int>(c[0] * 9) + static_cast<int>(c[1] * 9)) % 2 == 0;
    });
    std::map<Point<2>, double> values;
    for (const auto &p : points) values[p.point] = p.attributes[0];
    for (auto &v : t.vertices) v.attributes = {values[v.point]};
    MeshOf<2> mesh(1);
    ASSERT_EQ(mesh.load(t.vertices, t.simplices), ABACUS_OK) << mesh.error.detail;
    double whole = 0;
    for (const abacus_simplex &s : mesh.simplices(false))
        whole += area({{s.corner[0][0], s.corner[0][1]},
                       {s.corner[1][0], s.corner[1][1]},
                       {s.corner[2][0], s.corner[2][1]},
                       {s.corner[0][0], s.corner[0][1]}});
    const abacus_contouring how = levels_of(0.5, 0, 1);
    double sum = 0;
    for (const Row &row : contours(mesh, how)) sum += area(row.path);
    EXPECT_NEAR(sum, whole, 1e-9);
}

TEST(Contours, FailuresOfTheHostLeaveNothing) {
    MeshOf<2> mesh(1);
    ASSERT_EQ(mesh.insert(field(1500, 10)), ABACUS_OK);
    const abacus_contouring how = levels_of(0.125, 0, 1);
    const std::size_t count = contours(mesh, how, {}, 0).size();
    bool is_done = false;
    for (std::uint64_t n = 1; !is_done; n += 1 + n / 3) {
        mesh.host.fail_at(n);
        try {
            EXPECT_EQ(contours(mesh, how, {}, 0).size(), count);
            is_done = true;
        } catch (const HostFailure &) {
            mesh.host.recover();
        }
        mesh.host.fail_at(0);
        EXPECT_EQ(mesh.host.bytes, 0u);
    }
    is_done = false;
    for (std::uint64_t n = 1; !is_done; n += 1 + n / 3) {
        mesh.host.fail_resize_at(n);
        try {
            contours(mesh, how, {}, 0);
            is_done = true;
        } catch (const std::bad_alloc &) {
            mesh.host.recover();
        }
        mesh.host.fail_resize_at(0);
        EXPECT_EQ(mesh.host.bytes, 0u);
    }
}

TEST(Contours, WithoutRoomAreCountedAndNotWritten) {
    MeshOf<2> mesh(1);
    ASSERT_EQ(mesh.insert({{1, {0, 0}, {0}}, {2, {1, 0}, {1}}, {3, {0, 1}, {2}}, {4, {2, 2}, {3}}}),
              ABACUS_OK);
    for (const int bands : {0, 1}) {
        mesh.host.spool_room = 1e300;
        mesh.host.expected_bytes = 0;
        const std::uint64_t before = mesh.host.spooled_bytes;
        contours(mesh, levels_of(1e-4, 0, bands), {}, 0);
        // Less is expected than is written.
        const double expected = mesh.host.expected_bytes;
        EXPECT_GT(expected, 1e6);
        EXPECT_LT(expected, static_cast<double>(mesh.host.spooled_bytes - before));

        mesh.host.spool_room = expected / 4;
        const std::uint64_t writes = mesh.host.calls.spool_write;
        EXPECT_THROW(contours(mesh, levels_of(1e-4, 0, bands), {}, 0), HostFailure);
        EXPECT_EQ(mesh.host.calls.spool_write, writes);
        mesh.host.recover();
        EXPECT_EQ(contours(mesh, levels_of(1, 0, bands), {}, 0).size(), bands == 0 ? 2u : 3u);
    }
}

} // namespace
} // namespace abacus::test
