// Regions: after each change every triangle is in the region that its outlines or seeds give it. Of
// outlines that is checked in whole numbers: how often a ray from the middle of a triangle crosses
// them. Of seeds, by flooding all triangles in memory.
#include "constrain/fixing.hpp"
#include "constrain/freeing.hpp"
#include "constrain/region_cuts.hpp"
#include "geometry/rational.hpp"
#include "query/scan/region_sizes.hpp"
#include "support/mesh_in_change.hpp"
#include "support/point_sets.hpp"
#include "support/sanitized.hpp"

#include <map>
#include <set>

namespace abacus::test {
namespace {

using Segment = std::pair<Point<2>, Point<2>>;
using Ring = std::vector<Point<2>>;

constexpr std::size_t little = 60 << 10, memory = 4 << 20;

std::vector<Segment> segments_of(const Ring &ring) {
    std::vector<Segment> segments;
    for (std::size_t i = 1; i < ring.size(); ++i) segments.emplace_back(ring[i - 1], ring[i]);
    return segments;
}
Ring box_ring(double x, double y, double side) {
    return {{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}, {x, y}};
}

/// A mesh on a grid, with lines, whose regions are those of its outlines and seeds.
class Regioned : public LineSource {
public:
    Regioned(Random &random, int side, std::size_t points, std::size_t cache_bytes)
        : side_(side), mesh({{{0, 0}}, {{double(side), double(side)}}}, cache_bytes) {
        mesh.delaunay.is_constrained = true;
        mesh.removal.set_lines(this);
        std::vector<Point<2>> list{{0, 0}, {double(side), 0}, {0, double(side)}};
        for (std::size_t i = 0; i < points; ++i) list.push_back(any(random));
        list = distinct(list);
        this->points.insert(list.begin(), list.end());
        EXPECT_TRUE(mesh.build(list));
    }

    Point<2> any(Random &random) const {
        return {double(random() % (side_ + 1)), double(random() % (side_ + 1))};
    }
    std::span<const abacus_segment_end> at(const Point<2> &p) override {
        ends_.clear();
        for (const auto &[line, ring] : lines)
            for (const auto &[a, b] : segments_of(ring))
                for (const auto &[end, other] : {Segment{a, b}, Segment{b, a}})
                    if (end == p) ends_.push_back({line, {other[0], other[1]}, 0});
        return ends_;
    }
    void insert(const Point<2> &p) {
        if (points.insert(p).second) mesh.insertion.insert(p, next_id_++, nullptr);
    }
    void add_line(std::int64_t line, const Ring &ring) {
        for (const Point<2> &p : ring) insert(p);
        lines[line] = ring;
        for (const auto &[a, b] : segments_of(ring))
            Fixing(mesh.delaunay, 3).fix(a, b, Fixed::hard);
    }
    bool fill(const std::map<RegionNumber, std::vector<std::int64_t>> &outlines,
              const std::map<RegionNumber, std::vector<Point<2>>> &seeds,
              abacus_region_fault &fault) {
        RegionParts parts(mesh.cache.host(), memory);
        for (const auto &[region, of] : outlines)
            for (const std::int64_t line : of)
                for (const auto &[a, b] : segments_of(lines.at(line)))
                    parts.add_outline(region, a, b);
        for (const auto &[region, of] : seeds)
            for (const Point<2> &p : of) parts.add_seed(region, p);
        const bool is_sound =
            Regions(mesh.delaunay, memory)
                .fill(
                    parts,
                    [&](RegionNumber region, const Box<2> &box) { boxes[region].extend(box); },
                    fault);
        parts.close();
        return is_sound;
    }
    /// A line that the regions of these seeds follow.
    void cut(std::int64_t line, const Ring &ring,
             const std::map<RegionNumber, std::vector<Point<2>>> &seeds) {
        add_line(line, ring);
        RegionParts parts(mesh.cache.host(), memory);
        for (const auto &[region, of] : seeds)
            for (const Point<2> &p : of) parts.add_seed(region, p);
        RegionCuts cuts(mesh.delaunay, memory);
        for (const auto &[a, b] : segments_of(ring)) cuts.add(a, b);
        abacus_region_fault fault{};
        EXPECT_TRUE(cuts.finish(parts, fault)) << fault.kind;
        parts.close();
    }
    void clear_seeds(const std::map<RegionNumber, std::vector<Point<2>>> &seeds) {
        RegionParts parts(mesh.cache.host(), memory);
        for (const auto &[region, of] : seeds)
            for (const Point<2> &p : of) parts.add_seed(region, p);
        Regions(mesh.delaunay, memory).clear(parts);
        parts.close();
    }

    /// Calls visit(corners, region, is_fixed) for all triangles.
    template <class Visit> void each(Visit visit) {
        for (Key page = first_key; page < end_key;) {
            mesh.cache.trim();
            page = mesh.cache.visit(page, [&](Handle h) {
                const Simplex<2> &s = mesh.cache.simplex(h);
                if (s.is_ghost()) {
                    EXPECT_EQ(mesh.cache.region(h), no_region);
                    return;
                }
                std::array<Point<2>, 3> corners;
                std::array<bool, 3> is_fixed;
                for (int i = 0; i < 3; ++i) {
                    corners[i] = mesh.cache.point(s.vertex[i]);
                    is_fixed[i] = mesh.cache.is_fixed(make_link(h, i));
                }
                visit(corners, mesh.cache.region(h), is_fixed);
            });
        }
    }

    /// Of each triangle, the number of its region by the outlines.
    void expect_outlines(const std::map<RegionNumber, std::vector<std::int64_t>> &outlines) {
        ASSERT_EQ(mesh.cache.check_invariants(), nullptr);
        each([&](const auto &corners, RegionNumber region, const auto &) {
            RegionNumber expected = no_region;
            for (const auto &[number, of] : outlines) {
                bool is_inside = false;
                for (const std::int64_t line : of)
                    for (const auto &[a, b] : segments_of(lines.at(line)))
                        is_inside ^= crosses_ray(corners, a, b);
                if (is_inside) expected = number;
            }
            ASSERT_EQ(region, expected);
        });
    }
    /// The same by the seeds.
    void expect_seeds(const std::map<RegionNumber, std::vector<Point<2>>> &seeds) {
        ASSERT_EQ(mesh.cache.check_invariants(), nullptr);
        using Edge = std::pair<Point<2>, Point<2>>;
        std::vector<std::array<Point<2>, 3>> triangles;
        std::vector<RegionNumber> regions;
        std::map<Edge, std::vector<std::size_t>> free_edges;
        each([&](const auto &corners, RegionNumber region, const auto &is_fixed) {
            for (int i = 0; i < 3; ++i)
                if (!is_fixed[i])
                    free_edges[std::minmax(corners[(i + 1) % 3], corners[(i + 2) % 3])].push_back(
                        triangles.size());
            triangles.push_back(corners);
            regions.push_back(region);
            for (const Point<2> &p : corners)
                EXPECT_TRUE(region == no_region || boxes.at(region).contains(p));
        });
        std::vector<std::size_t> parent(triangles.size());
        for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = i;
        const auto root = [&](std::size_t i) {
            while (parent[i] != i) i = parent[i] = parent[parent[i]];
            return i;
        };
        for (const auto &[edge, of] : free_edges)
            if (of.size() == 2) parent[root(of[0])] = root(of[1]);
        std::map<std::size_t, RegionNumber> expected;
        for (const auto &[number, of] : seeds)
            for (const Point<2> &p : of)
                for (std::size_t i = 0; i < triangles.size(); ++i)
                    if (contains(triangles[i], p)) expected[root(i)] = number;
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            const auto found = expected.find(root(i));
            ASSERT_EQ(regions[i], found == expected.end() ? no_region : found->second);
        }
    }

    const int side_;
    MeshInChange<2> mesh;
    std::map<std::int64_t, Ring> lines;
    std::set<Point<2>> points;
    std::map<RegionNumber, Box<2>> boxes; // that were reported

private:
    static bool contains(const std::array<Point<2>, 3> &t, const Point<2> &p) {
        for (int i = 0; i < 3; ++i)
            if (orientation(t[i], t[(i + 1) % 3], p) < 0) return false;
        return true;
    }
    /// Whether the ray to the left of the triangle's middle crosses the segment, in thirds of whole
    /// numbers.
    static bool crosses_ray(const std::array<Point<2>, 3> &t, const Point<2> &a,
                            const Point<2> &b) {
        const auto whole = [](double x) { return static_cast<std::int64_t>(x); };
        const std::int64_t x = whole(t[0][0] + t[1][0] + t[2][0]),
                           y = whole(t[0][1] + t[1][1] + t[2][1]), ax = 3 * whole(a[0]),
                           ay = 3 * whole(a[1]), bx = 3 * whole(b[0]), by = 3 * whole(b[1]);
        if ((ay > y) == (by > y)) return false;
        const std::int64_t turn = (bx - ax) * (y - ay) - (by - ay) * (x - ax);
        return by > ay ? turn < 0 : turn > 0;
    }

    std::vector<abacus_segment_end> ends_;
    std::int64_t next_id_ = 1'000'000;
};

/// Inserts points and removes vertices, on lines too.
void change(Regioned &mesh, Random &random, int steps) {
    for (int step = 0; step < steps; ++step) {
        if (random() % 3 > 0) {
            mesh.insert(mesh.any(random));
            continue;
        }
        auto at = mesh.points.begin();
        std::advance(at, random() % mesh.points.size());
        const Point<2> p = *at;
        if (!mesh.at(p).empty()) continue;
        try {
            if (mesh.mesh.removal.remove(p) == Removed::removed) mesh.points.erase(p);
        } catch (const Error &) { // lines would cross there
        }
    }
}

TEST(Regions, OutlinesFollowParityThroughChanges) {
    for (unsigned seed = 1; seed <= (sanitized ? 2u : 6u); ++seed) {
        Random random(seed);
        Regioned mesh(random, 40, 300, seed % 2 == 0 ? little : 20 * little);
        mesh.add_line(1, box_ring(4, 4, 20));
        mesh.add_line(2, box_ring(8, 8, 8));   // a hole
        mesh.add_line(3, box_ring(10, 10, 4)); // an island in it
        mesh.add_line(4, box_ring(24, 4, 12)); // shares a part of an edge with the first
        mesh.add_line(5, {{24, 24}, {36, 24}, {30, 36}, {24, 24}}); // touches it in a vertex
        mesh.add_line(6, box_ring(0, 0, 4));
        mesh.add_line(7, {{12, 30}, {14, 34}}); // a line in no region
        const std::map<RegionNumber, std::vector<std::int64_t>> outlines{
            {1, {1, 2, 3, 5}}, {2, {4}}, {9, {6}}};
        abacus_region_fault fault{};
        ASSERT_TRUE(mesh.fill(outlines, {}, fault));
        mesh.expect_outlines(outlines);
        for (int round = 0; round < 4; ++round) {
            change(mesh, random, 150);
            mesh.expect_outlines(outlines);
            if (HasFatalFailure()) return;
        }
        // A line across the first region changes none.
        mesh.add_line(8, {{4, 6}, {24, 6}});
        mesh.expect_outlines(outlines);
        mesh.lines.erase(8);
        Freeing(mesh.mesh.delaunay, mesh).free({4, 6}, {24, 6});
        mesh.expect_outlines(outlines);
    }
}

TEST(Regions, PartsThatOverlapLeaveThoseOfOddParity) {
    Random random(3);
    Regioned mesh(random, 30, 200, little);
    mesh.add_line(1, box_ring(2, 2, 10));
    mesh.add_line(2, {{12, 2}, {22, 2}, {22, 12}, {12, 12}, {12, 2}});
    mesh.add_line(3,
                  {{2, 2}, {22, 2}, {22, 20}, {2, 20}, {2, 2}}); // around both, along their edges
    const std::map<RegionNumber, std::vector<std::int64_t>> outlines{{5, {1, 2, 3}}};
    abacus_region_fault fault{};
    ASSERT_TRUE(mesh.fill(outlines, {}, fault));
    mesh.expect_outlines(outlines);
    change(mesh, random, 200);
    mesh.expect_outlines(outlines);
}

TEST(Regions, SeedsFillUpToFixedEdges) {
    for (unsigned seed = 1; seed <= (sanitized ? 1u : 4u); ++seed) {
        Random random(seed + 100);
        Regioned mesh(random, 40, 300, seed % 2 == 0 ? little : 20 * little);
        mesh.add_line(1, box_ring(4, 4, 20));
        mesh.add_line(2, box_ring(8, 8, 8));
        mesh.add_line(3, {{24, 10}, {36, 10}, {36, 20}, {24, 20}});
        const std::map<RegionNumber, std::vector<Point<2>>> seeds{
            {1, {{6, 6}, {22.5, 22.5}}}, {2, {{10.5, 10.25}}}, {3, {{30, 15}}}};
        abacus_region_fault fault{};
        ASSERT_TRUE(mesh.fill({}, seeds, fault)) << fault.kind;
        mesh.expect_seeds(seeds);
        for (int round = 0; round < 4; ++round) {
            change(mesh, random, 100);
            mesh.expect_seeds(seeds);
            if (HasFatalFailure()) return;
        }
        // A new ring takes its inside away from the first region.
        mesh.cut(4, box_ring(17, 17, 3), seeds);
        mesh.expect_seeds(seeds);
        mesh.clear_seeds(seeds);
        mesh.expect_seeds({});
    }
}

/// Whether two segments have more in common than a vertex.
bool cross(const Segment &s, const Segment &t) {
    const int a = orientation(s.first, s.second, t.first),
              b = orientation(s.first, s.second, t.second),
              c = orientation(t.first, t.second, s.first),
              d = orientation(t.first, t.second, s.second);
    return (a == 0 && b == 0) || (a * b < 0 && c * d < 0);
}

/// A line with up to four segments that crosses no other one; empty if none was found.
Ring any_line(const Regioned &mesh, Random &random, bool is_ring) {
    for (int attempt = 0; attempt < 50; ++attempt) {
        Ring line;
        for (unsigned i = 0; i < 2 + random() % 3; ++i) line.push_back(mesh.any(random));
        if (is_ring) line.push_back(line.front());
        std::vector<Segment> before;
        for (const auto &[number, ring] : mesh.lines)
            for (const Segment &s : segments_of(ring)) before.push_back(s);
        bool is_free = true;
        for (const Segment &s : segments_of(line)) {
            is_free = is_free && s.first != s.second;
            for (const Segment &t : before) is_free = is_free && !cross(s, t);
            before.push_back(s);
        }
        if (is_free) return line;
    }
    return {};
}

TEST(Regions, NewLinesCutOffWhatNoSeedReaches) {
    for (unsigned seed = 1; seed <= (sanitized ? 3u : 30u); ++seed) {
        Random random(seed + 500);
        Regioned mesh(random, 24, 150, seed % 2 == 0 ? little : 20 * little);
        mesh.add_line(1, box_ring(1, 1, 22));
        // A seed is on no line: lines have whole corners, and are not that long.
        const auto within = [&] { return double(1 + random() % 999'982) / 999'983; };
        std::map<RegionNumber, std::vector<Point<2>>> seeds;
        for (RegionNumber region = 1; region <= 1 + seed % 2; ++region)
            for (unsigned i = 0; i < (region == 2 ? 1 : 1 + seed % 3); ++i)
                seeds[region].push_back({1 + 22 * within(), 1 + 22 * within()});
        abacus_region_fault fault{};
        if (seeds.size() == 2) {
            mesh.add_line(2, {{1, 8}, {23, 16}});
            const auto is_above = [](const Point<2> &p) {
                return orientation(Point<2>{1, 8}, Point<2>{23, 16}, p) > 0;
            };
            for (Point<2> &p : seeds[1])
                if (is_above(p)) p = {24 - p[0], 24 - p[1]};
            for (Point<2> &p : seeds[2])
                if (!is_above(p)) p = {24 - p[0], 24 - p[1]};
        }
        ASSERT_TRUE(mesh.fill({}, seeds, fault)) << fault.kind;
        mesh.expect_seeds(seeds);
        for (std::int64_t line = 10; line < 40; ++line) {
            const Ring ring = any_line(mesh, random, random() % 2 == 0);
            if (ring.empty()) continue;
            mesh.cut(line, ring, seeds);
            mesh.expect_seeds(seeds);
            if (line % 8 == 0) change(mesh, random, 20);
            mesh.expect_seeds(seeds);
            if (HasFailure()) return;
        }
    }
}

TEST(Regions, FaultsNamePlaces) {
    Random random(7);
    Regioned mesh(random, 30, 200, little);
    mesh.add_line(1, box_ring(2, 2, 10));
    mesh.add_line(2, {{2, 20}, {10, 20}, {10, 26}});
    mesh.add_line(3, box_ring(4, 4, 4));
    abacus_region_fault fault{};
    const auto expect = [&](abacus_region_fault_kind kind, RegionNumber other) {
        EXPECT_EQ(fault.kind, kind);
        EXPECT_EQ(fault.region, 7u);
        EXPECT_EQ(fault.other, other);
    };
    EXPECT_FALSE(mesh.fill({{7, {2}}}, {}, fault));
    expect(ABACUS_REGION_OPEN, 0);
    EXPECT_EQ(fault.place[0], 2);
    EXPECT_EQ(fault.place[1], 20);
    EXPECT_FALSE(mesh.fill({{7, {1, 1}}}, {}, fault));
    expect(ABACUS_REGION_EMPTY, 0);
    EXPECT_FALSE(mesh.fill({}, {{7, {{29.5, 29.5}}}}, fault));
    expect(fault.kind == ABACUS_REGION_LEAK ? ABACUS_REGION_LEAK : ABACUS_REGION_SEED_OUTSIDE, 0);
    EXPECT_FALSE(mesh.fill({}, {{7, {{1000, 3}}}}, fault));
    expect(ABACUS_REGION_SEED_OUTSIDE, 0);
    EXPECT_FALSE(mesh.fill({}, {{7, {{2, 5}}}}, fault));
    expect(ABACUS_REGION_SEED_FIXED, 0);
    EXPECT_FALSE(mesh.fill({}, {{7, {{2, 2}}}}, fault));
    expect(ABACUS_REGION_SEED_FIXED, 0);
    // The first attempts have been given up, as a transaction is: a mesh of its own for each.
    for (const bool is_inner_first : {true, false}) {
        Regioned other(random, 30, 200, little);
        other.add_line(1, box_ring(2, 2, 10));
        other.add_line(3, box_ring(4, 4, 4));
        ASSERT_TRUE(other.fill({{1, {is_inner_first ? 3 : 1}}}, {}, fault));
        EXPECT_FALSE(other.fill({{7, {is_inner_first ? 1 : 3}}}, {}, fault));
        expect(ABACUS_REGION_TWICE, 1);
    }
}

TEST(Regions, LargeOnesAreFloodedWithLittleMemory) {
    Random random(11);
    Regioned mesh(random, 400, sanitized ? 4000 : 25000, little);
    mesh.add_line(1, box_ring(10, 10, 380));
    mesh.add_line(2, box_ring(100, 100, 50));
    const std::map<RegionNumber, std::vector<std::int64_t>> outlines{{1, {1, 2}}};
    abacus_region_fault fault{};
    ASSERT_TRUE(mesh.fill(outlines, {}, fault));
    mesh.expect_outlines(outlines);
    EXPECT_GT(mesh.mesh.cache.counters.evictions, 0u);
}

/// The area of the only region of a mesh, in a ring of all its points.
double area_in(const Ring &ring) {
    const std::vector<Point<2>> points(ring.begin(), ring.end() - 1);
    MeshInChange<2> mesh(box_around<2>(points), 20 * little);
    mesh.delaunay.is_constrained = true;
    EXPECT_TRUE(mesh.build(points));
    RegionParts parts(mesh.cache.host(), memory);
    for (const auto &[a, b] : segments_of(ring)) {
        Fixing(mesh.delaunay, 3).fix(a, b, Fixed::hard);
        parts.add_outline(1, a, b);
    }
    abacus_region_fault fault{};
    EXPECT_TRUE(Regions(mesh.delaunay, memory)
                    .fill(
                        parts, [](RegionNumber, const Box<2> &) {}, fault));
    parts.close();
    mesh.cache.flush();
    mesh.header().facts.census.vertices = points.size();
    mesh.header().facts.census.simplices = static_cast<std::uint64_t>(mesh.delaunay.simplices());
    Reader<2> reader(mesh.cache.host(), mesh.header(), 20 * little);
    double area = -1;
    region_sizes(reader, memory, [&](const abacus_region_size &size) { area = size.area; });
    return area;
}

/// Areas are rounded once, however small or great the coordinates are.
TEST(Regions, AreasAtTheLimitsOfDoubles) {
    const auto box = [](const Point<2> &lower, const Point<2> &upper) {
        return Ring{lower, {upper[0], lower[1]}, upper, {lower[0], upper[1]}, lower};
    };
    const Point<2> far{1e300, 1e10};
    for (const Ring &ring :
         {box(far, {std::nextafter(far[0], 2e300), std::nextafter(far[1], 2e10)}),
          box({1e-200, 3e-170}, {1.5e-160, 7e-150}), box({-1e-160, 3}, {7e-160, 3.5}),
          box({0, 0}, {1.1e-160, 1.3e-160}), box({0, 0}, {3e-170, 1e-170}),
          box({0, 0}, {1.2e154, 1.2e154}), box({-3e200, 0}, {1e200, 1e-200})}) {
        exact::Rational twice = 0;
        for (const auto &[a, b] : segments_of(ring))
            twice += exact::Rational(a[0]) * exact::Rational(b[1]) -
                     exact::Rational(b[0]) * exact::Rational(a[1]);
        EXPECT_EQ(area_in(ring), exact::nearest_double(exact::Rational(twice / 2))) << ring[2][0];
    }
    EXPECT_EQ(area_in(box({-1e200, 0}, {1e200, 1e150})), HUGE_VAL);
}

} // namespace
} // namespace abacus::test
