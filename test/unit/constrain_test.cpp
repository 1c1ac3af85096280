// Fixed edges: after each change the mesh is the constrained Delaunay triangulation of its points
// and segments. There is only one, and it is right if and only if each edge that is not fixed
// passes the in-circle test, and exactly the edges on segments are fixed.
#include "constrain/fixing.hpp"
#include "constrain/freeing.hpp"
#include "query/values/sibson.hpp"
#include "support/mesh_in_change.hpp"
#include "support/point_sets.hpp"
#include "support/sanitized.hpp"

#include <map>
#include <set>

namespace abacus::test {
namespace {

using Segment = std::pair<Point<2>, Point<2>>;
using Edge = std::pair<Point<2>, Point<2>>; // the lesser end first

constexpr std::size_t little = 60 << 10; // a cache of about three blocks

Edge edge(const Point<2> &a, const Point<2> &b) { return a < b ? Edge{a, b} : Edge{b, a}; }

/// Whether p lies on the segment, its ends included.
bool is_on(const Segment &s, const Point<2> &p) {
    return p == s.first || p == s.second ||
           (orientation(s.first, s.second, p) == 0 && is_same_way(s.first, s.second, p) &&
            is_same_way(s.second, s.first, p));
}
/// Whether two segments cross inside both.
bool cross(const Segment &s, const Segment &t) {
    return orientation(s.first, s.second, t.first) * orientation(s.first, s.second, t.second) < 0 &&
           orientation(t.first, t.second, s.first) * orientation(t.first, t.second, s.second) < 0;
}

Fixed kind_of(std::int64_t line) { return line % 3 == 0 ? Fixed::soft : Fixed::hard; }

/// A mesh with lines of one segment each, which are numbered. Every third one is soft.
class Constrained : public LineSource {
public:
    Constrained(const std::vector<Point<2>> &points, std::size_t cache_bytes)
        : mesh(box_around<2>(points), cache_bytes) {
        mesh.delaunay.is_constrained = true;
        mesh.removal.set_lines(this);
        for (const Point<2> &p : points) this->points.insert(p);
        EXPECT_TRUE(mesh.build(points));
    }

    std::span<const abacus_segment_end> at(const Point<2> &p) override {
        ends_.clear();
        for (const auto &[line, s] : lines)
            for (const auto &[end, other] : {Segment{s.first, s.second}, {s.second, s.first}})
                if (end == p)
                    ends_.push_back(
                        {line, {other[0], other[1]}, kind_of(line) == Fixed::soft ? 1 : 0});
        return ends_;
    }

    /// Adds a line, unless it would cross another one outside of a vertex.
    bool add(std::int64_t line, const Segment &s) {
        if (s.first == s.second) return false;
        for (const auto &[other, t] : lines)
            if (cross(s, t) && !meet_in_vertex(s, t)) return false;
        // Some by funnels.
        Fixing(mesh.delaunay, line % 2 == 0 ? 256 : 1 + line % 7)
            .fix(s.first, s.second, kind_of(line));
        lines[line] = s;
        return true;
    }
    void remove(std::int64_t line) {
        const Segment s = lines.at(line);
        lines.erase(line);
        Freeing(mesh.delaunay, *this).free(s.first, s.second);
    }
    void insert(const Point<2> &p) {
        if (points.insert(p).second) mesh.insertion.insert(p, next_id_++, nullptr);
    }
    bool is_named(const Point<2> &p) { return !at(p).empty(); }
    /// Whether a line passes through p in two directions.
    bool is_crossing(const Point<2> &p) const {
        const Segment *first = nullptr;
        for (const auto &[line, s] : lines) {
            if (!is_on(s, p)) continue;
            if (first != nullptr && orientation(first->first, first->second, s.first) != 0)
                return true;
            if (first != nullptr && orientation(first->first, first->second, s.second) != 0)
                return true;
            first = &s;
        }
        return false;
    }

    void verify() {
        ASSERT_EQ(mesh.cache.check_invariants(), nullptr);
        std::map<Edge, std::vector<std::pair<std::array<Point<2>, 3>, int>>> sides;
        std::map<Edge, Fixed> fixed;
        std::set<Point<2>> seen;
        std::int64_t finite = 0;
        for (Key page = first_key; page < end_key;) {
            mesh.cache.trim();
            page = mesh.cache.visit(page, [&](Handle h) {
                const Simplex<2> s = mesh.cache.simplex(h);
                if (s.is_ghost()) return;
                ++finite;
                std::array<Point<2>, 3> corners;
                for (int i = 0; i < 3; ++i) corners[i] = mesh.cache.point(s.vertex[i]);
                ASSERT_GT(orientation(corners[0], corners[1], corners[2]), 0);
                for (int i = 0; i < 3; ++i) {
                    const Edge e = edge(corners[(i + 1) % 3], corners[(i + 2) % 3]);
                    sides[e].push_back({corners, i});
                    seen.insert(corners[i]);
                    if (const Fixed how = mesh.cache.fixed(make_link(h, i)); how != Fixed::no) {
                        ASSERT_EQ(fixed.emplace(e, how).first->second, how);
                    }
                }
            });
        }
        EXPECT_EQ(seen, points);
        EXPECT_EQ(finite, mesh.delaunay.simplices());
        std::int64_t hull = 0;
        for (const auto &[e, of] : sides) {
            hull += of.size() == 1;
            ASSERT_LE(of.size(), 2u);
            if (of.size() == 1 || fixed.contains(e)) continue;
            Corners<2> corners;
            for (int i = 0; i < 3; ++i) corners[i] = &of[0].first[i];
            ASSERT_LE(in_sphere(corners, of[1].first[of[1].second]), 0);
        }
        EXPECT_EQ(hull, mesh.delaunay.ghosts());
        EXPECT_EQ(2 * static_cast<std::int64_t>(points.size()) - 2 - hull, finite);
        std::map<Edge, Fixed> expected;
        for (const auto &[line, s] : lines) {
            std::vector<Point<2>> on;
            for (const Point<2> &p : points)
                if (is_on(s, p)) on.push_back(p);
            std::sort(on.begin(), on.end());
            for (std::size_t i = 1; i < on.size(); ++i) {
                Fixed &how = expected[{on[i - 1], on[i]}];
                how = std::max(how, kind_of(line));
            }
        }
        EXPECT_EQ(fixed, expected);
    }

    MeshInChange<2> mesh;
    std::map<std::int64_t, Segment> lines;
    std::set<Point<2>> points;

private:
    bool meet_in_vertex(const Segment &s, const Segment &t) const {
        return std::any_of(points.begin(), points.end(),
                           [&](const Point<2> &p) { return is_on(s, p) && is_on(t, p); });
    }

    std::vector<abacus_segment_end> ends_;
    std::int64_t next_id_ = 1'000'000;
};

struct Input {
    const char *name;
    std::size_t points;
    Point<2> (*point)(Random &);
};

Point<2> even(Random &random) {
    std::uniform_real_distribution<double> x(0, 1);
    return {x(random), x(random)};
}
Point<2> small_grid(Random &random) { return {double(random() % 12), double(random() % 12)}; }
Point<2> large_grid(Random &random) { return {double(random() % 60), double(random() % 40)}; }
Point<2> near_line(Random &random) {
    const double x = double(random() % 1000) / 1000;
    return {x, x + double(random() % 5) * 1e-16};
}
Point<2> on_circle(Random &random) {
    static constexpr int triples[][2] = {{3, 4},   {5, 12},  {8, 15}, {7, 24},
                                         {20, 21}, {12, 35}, {9, 40}, {28, 45}};
    // All on the circle of radius 32045 = 5 13 17 29, by products of these.
    double x = 1, y = 0;
    const int hypotenuse[] = {5, 13, 17, 25, 29, 37, 41, 53};
    double r = 32045;
    for (const int i : {0, 1, 2, 4}) {
        const double a = triples[i][0], b = random() % 2 ? triples[i][1] : -triples[i][1];
        const double nx = x * a - y * b, ny = x * b + y * a;
        x = nx;
        y = ny;
        r /= hypotenuse[i];
    }
    return {random() % 2 ? x : -x, random() % 2 ? y : -y};
}

const Input inputs[] = {{"Even", 400, even},
                        {"SmallGrid", 140, small_grid},
                        {"LargeGrid", 900, large_grid},
                        {"NearLine", 200, near_line},
                        {"OnCircle", 80, on_circle}};

Point<2> any_of(const std::set<Point<2>> &points, Random &random) {
    auto at = points.begin();
    std::advance(at, random() % points.size());
    return *at;
}

class ConstrainOf : public testing::TestWithParam<Input> {
protected:
    std::vector<Point<2>> points(Random &random, std::size_t n) const {
        std::vector<Point<2>> result;
        for (std::size_t i = 0; i < n; ++i) result.push_back(GetParam().point(random));
        result = distinct(result);
        std::shuffle(result.begin(), result.end(), random);
        return result;
    }
    static Point<2> any(const Constrained &mesh, Random &random) {
        return any_of(mesh.points, random);
    }
};

TEST_P(ConstrainOf, FixesEdges) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
        Random random(seed);
        Constrained mesh(points(random, GetParam().points), seed == 1 ? little : 20 * little);
        for (std::int64_t line = 0; line < 60; ++line)
            mesh.add(line, {any(mesh, random), any(mesh, random)});
        EXPECT_GT(mesh.lines.size(), 2u);
        mesh.verify();
        if (HasFatalFailure()) return;
    }
}

TEST_P(ConstrainOf, ChangesLikeAFreshMesh) {
    const int steps = sanitized ? 150 : 600;
    for (unsigned seed = 1; seed <= 3; ++seed) {
        Random random(seed);
        Constrained mesh(points(random, GetParam().points / 3 + 4),
                         seed == 1 ? little : 20 * little);
        std::int64_t next_line = 0;
        for (int step = 0; step < steps; ++step) {
            const unsigned what = random() % 8;
            if (what < 2) {
                mesh.add(next_line++, {any(mesh, random), any(mesh, random)});
            } else if (what < 3 && !mesh.lines.empty()) {
                auto at = mesh.lines.begin();
                std::advance(at, random() % mesh.lines.size());
                mesh.remove(at->first);
            } else if (what < 5) {
                mesh.insert(GetParam().point(random));
            } else if (what < 6 && !mesh.lines.empty()) { // the middle of an edge, nearly
                auto at = mesh.lines.begin();
                std::advance(at, random() % mesh.lines.size());
                const Segment &s = at->second;
                mesh.insert({(s.first[0] + s.second[0]) / 2, (s.first[1] + s.second[1]) / 2});
            } else if (mesh.points.size() > 8) {
                const Point<2> p = any(mesh, random);
                if (mesh.is_named(p) || mesh.is_crossing(p)) {
                    EXPECT_THROW(mesh.mesh.removal.remove(p), Error);
                } else {
                    const Removed removed = mesh.mesh.removal.remove(p);
                    if (removed == Removed::collapses) break;
                    ASSERT_EQ(removed, Removed::removed);
                    mesh.points.erase(p);
                }
            }
            if (step % 25 == 0 || step + 1 == steps) mesh.verify();
            if (HasFatalFailure() || HasNonfatalFailure()) {
                ADD_FAILURE() << "seed " << seed << ", step " << step << ", kind " << what;
                return;
            }
        }
    }
}

TEST_P(ConstrainOf, RefusesCrossings) {
    Random random(5);
    Constrained mesh(points(random, GetParam().points), 20 * little);
    int refused = 0;
    for (std::int64_t line = 0; line < 40; ++line) {
        const Segment s{any(mesh, random), any(mesh, random)};
        if (mesh.add(line, s) || s.first == s.second) continue;
        EXPECT_THROW(Fixing(mesh.mesh.delaunay).fix(s.first, s.second, Fixed::hard), Error);
        ++refused;
        break; // what has been fixed before the crossing stays
    }
    EXPECT_GT(refused, 0);
}

INSTANTIATE_TEST_SUITE_P(Inputs, ConstrainOf, testing::ValuesIn(inputs),
                         [](const auto &info) { return info.param.name; });

TEST(Constrain, StarOfAThousandSegments) {
    std::vector<Point<2>> points{{0.5, 0.5}};
    Random random(9);
    while (points.size() < 1001) points.push_back(even(random));
    Constrained mesh(points, 20 * little);
    std::int64_t line = 0;
    for (const Point<2> &p : points) mesh.add(line++, {points[0], p});
    mesh.verify();
    while (!mesh.lines.empty()) mesh.remove(mesh.lines.begin()->first);
    mesh.verify();
}

// What lies beyond a hard edge is not seen; linear data come back.
TEST(Constrain, NaturalNeighboursEndAtHardEdges) {
    Random random(21);
    std::vector<Point<2>> points{{0.1, 0.5}, {0.9, 0.5}};
    while (points.size() < 400) points.push_back(even(random));
    Constrained mesh(points, 20 * little);
    ASSERT_TRUE(mesh.add(1, {points[0], points[1]}));
    for (std::int64_t line = 2; line < 30; ++line)
        mesh.add(line, {any_of(mesh.points, random), any_of(mesh.points, random)});
    for (std::int64_t line = 30; line < 130; ++line) { // edges of the mesh already
        const Point<2> p = any_of(mesh.points, random);
        const auto distance = [&](const Point<2> &q) {
            return q == p ? 9 : std::hypot(q[0] - p[0], q[1] - p[1]);
        };
        mesh.add(line, {p, *std::min_element(mesh.points.begin(), mesh.points.end(),
                                             [&](const Point<2> &a, const Point<2> &b) {
                                                 return distance(a) < distance(b);
                                             })});
    }
    Sibson<2> sibson(mesh.mesh.host());
    int natural = 0;
    for (int i = 0; i < 3000; ++i) {
        Point<2> p = even(random);
        if (i % 10 == 0) p = {0.1 + 0.8 * p[0], 0.5}; // on a line
        const Link at = vertex_at(mesh.mesh.delaunay, p);
        ASSERT_EQ(at, unset);
        const Handle h = mesh.mesh.delaunay.locate(p, mesh.mesh.cache.domain().code(p), no_handle);
        if (mesh.mesh.cache.simplex(h).is_ghost()) continue;
        const bool found = sibson.find(mesh.mesh.cache, h, p, true);
        if (i % 10 == 0) {
            EXPECT_FALSE(found);
        }
        if (!found) continue;
        ++natural;
        Point<2> mean{};
        for (std::size_t n = 0; n < sibson.count(); ++n) {
            const Point<2> &v = mesh.mesh.cache.point(sibson.vertex(n));
            EXPECT_GE(sibson.weight(n), 0);
            for (int axis = 0; axis < 2; ++axis) mean[axis] += sibson.weight(n) * v[axis];
            for (const auto &[line, s] : mesh.lines)
                EXPECT_FALSE(kind_of(line) == Fixed::hard && sibson.weight(n) > 0 &&
                             cross(s, {p, v}));
        }
        for (int axis = 0; axis < 2; ++axis) EXPECT_NEAR(mean[axis], p[axis], 1e-9);
    }
    EXPECT_GT(natural, 2000);
}

/// The weights of natural neighbours by their places; nothing if there are none.
std::map<Point<2>, double> natural_neighbours(Constrained &of, const Point<2> &p, bool has_soft) {
    Delaunay<2> &mesh = of.mesh.delaunay;
    Cache<2> &cache = of.mesh.cache;
    Sibson<2> sibson(of.mesh.host());
    std::map<Point<2>, double> weights;
    const Handle h = mesh.locate(p, cache.domain().code(p), no_handle);
    if (!cache.simplex(h).is_ghost() && sibson.find(cache, h, p, has_soft))
        for (std::size_t n = 0; n < sibson.count(); ++n)
            weights[cache.point(sibson.vertex(n))] = sibson.weight(n);
    mesh.finish(mesh.anywhere);
    return weights;
}

// They are those of the mesh without soft lines, to the last bit.
TEST(Constrain, NaturalNeighboursSeeAcrossSoftEdges) {
    Random random(22);
    for (const double height : {1.0, 1e-3, 1e-7})
        for (const bool is_grid : {false, true}) {
            std::vector<Point<2>> points;
            for (int i = 0; i < 300; ++i)
                points.push_back(is_grid ? Point<2>{(i % 20) / 32.0, (i / 20) / 32.0 * height}
                                         : even(random));
            for (Point<2> &p : points)
                if (!is_grid) p[1] *= height;
            Constrained both(points, 20 * little), hard(points, 20 * little);
            for (std::int64_t line = 1; line < 120; ++line) {
                const Segment s{any_of(both.points, random), any_of(both.points, random)};
                if (both.add(line, s) && kind_of(line) == Fixed::hard) {
                    ASSERT_TRUE(hard.add(line, s));
                }
            }
            std::size_t natural = 0, soft = 0;
            for (const auto &[line, s] : both.lines) soft += kind_of(line) == Fixed::soft;
            ASSERT_GT(soft, 3u);
            for (int i = 0; i < 1000; ++i) {
                Point<2> p = even(random);
                p[1] *= height;
                if (i % 4 == 0) { // close to a line, or on it
                    const Segment &s = std::next(both.lines.begin(), i % both.lines.size())->second;
                    const double t = even(random)[0];
                    for (int axis = 0; axis < 2; ++axis)
                        p[axis] = s.first[axis] + t * (s.second[axis] - s.first[axis]);
                }
                if (both.points.contains(p)) continue;
                const auto expected = natural_neighbours(hard, p, false);
                EXPECT_EQ(natural_neighbours(both, p, true), expected);
                EXPECT_EQ(natural_neighbours(hard, p, true), expected);
                natural += !expected.empty();
            }
            EXPECT_GT(natural, is_grid ? 100u : 500u);
        }
}

TEST(Constrain, EndsMustBeVertices) {
    Random random(9);
    std::vector<Point<2>> points;
    while (points.size() < 100) points.push_back(even(random));
    Constrained mesh(points, 20 * little);
    for (const Point<2> &p : {Point<2>{0.5, 0.5}, {2, 2}, {-1, 0.5}}) {
        EXPECT_THROW(Fixing(mesh.mesh.delaunay).fix(points[0], p, Fixed::hard), Error);
        EXPECT_THROW(Fixing(mesh.mesh.delaunay).fix(p, points[0], Fixed::soft), Error);
    }
}

} // namespace
} // namespace abacus::test
