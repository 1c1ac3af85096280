// Many points of one place removed in one call: the result is the same as one after the other,
// without a search of the place's pages for each.
#include "points/leaving.hpp"

#include "support/oracle.hpp"
#include "support/sanitized.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

namespace abacus::test {
namespace {

using Random = std::mt19937_64;
using Points = std::vector<std::int64_t>; // ids, in the order of input
using Wants = std::vector<std::int64_t>;

/// The remaining serial numbers: each want takes the first with its id, or else, unless `exactly`,
/// the first.
std::vector<std::size_t> left_one_by_one(const Points &points, const Wants &wants, bool exactly) {
    std::vector<std::size_t> left(points.size());
    std::iota(left.begin(), left.end(), 0);
    for (const std::int64_t id : wants) {
        if (left.empty()) break;
        const auto at =
            std::find_if(left.begin(), left.end(), [&](std::size_t i) { return points[i] == id; });
        if (at != left.end())
            left.erase(at);
        else if (!exactly)
            left.erase(left.begin());
    }
    return left;
}

/// The same in one run. `parted`: not the ids but one and two attributes distinguish the points.
std::vector<std::size_t> left_together(Leaving &leaving, const Points &points, const Wants &wants,
                                       bool parted = false) {
    const auto id = [&](std::int64_t which) { return parted ? which / 9 : which; };
    std::array<double, 2> values;
    const auto attributes = [&](std::int64_t which) {
        values = {which % 3 - 1.0, which / 3 % 3 == 0 ? NAN : which / 3 % 3 / 4.0};
        return values.data();
    };
    for (const std::int64_t which : wants) leaving.want(id(which), attributes(which));
    leaving.begin();
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!leaving.offer(id(points[i]), attributes(points[i]), i)) break;
    leaving.decide();
    std::vector<std::size_t> left(points.size());
    std::iota(left.begin(), left.end(), 0);
    const auto take = [&](std::size_t i) { left.erase(std::find(left.begin(), left.end(), i)); };
    if (leaving.has_first()) take(0);
    leaving.each_other(take);
    leaving.clear();
    return left;
}

TEST(Leaving, IsAsOneAfterTheOther) {
    Random random(3);
    MemoryHost memory;
    const Host host = memory.host();
    std::array<Leaving, 2> leaving{Leaving(host, 1 << 20, false, 2),
                                   Leaving(host, 1 << 20, true, 0)};
    Leaving by_attributes(host, 1 << 20, true, 2);
    for (int round = 0; round < 20000; ++round) {
        // From ids that are all equal to ids that hardly repeat, some of them missing.
        const std::int64_t ids = 1 + static_cast<std::int64_t>(random() % 24);
        Points points(1 + random() % 24);
        for (std::int64_t &id : points) id = static_cast<std::int64_t>(random() % ids);
        Wants wants(1 + random() % 24);
        for (std::int64_t &id : wants) id = static_cast<std::int64_t>(random() % (ids + 2));
        for (const bool exactly : {false, true})
            ASSERT_EQ(left_together(leaving[exactly], points, wants),
                      left_one_by_one(points, wants, exactly))
                << testing::PrintToString(points) << testing::PrintToString(wants) << exactly;
        ASSERT_EQ(left_together(by_attributes, points, wants, true),
                  left_one_by_one(points, wants, true))
            << testing::PrintToString(points) << testing::PrintToString(wants);
    }
}

TEST(Leaving, KeepsAFewPointsOfManyForAFewWants) {
    MemoryHost memory;
    const Host host = memory.host();
    Leaving leaving(host, 1 << 20, false, 0);
    leaving.want(7, nullptr);
    leaving.want(-1, nullptr);
    leaving.begin();
    for (std::uint64_t i = 0; i < 1000000; ++i) ASSERT_TRUE(leaving.offer(7, nullptr, i));
    leaving.decide();
    EXPECT_LT(memory.peak_bytes, 64u << 10);
    std::vector<std::uint64_t> others;
    EXPECT_TRUE(leaving.has_first());
    leaving.each_other([&](std::uint64_t serial) { others.push_back(serial); });
    EXPECT_EQ(others, std::vector<std::uint64_t>{1});
}

TEST(Leaving, IsTheSameWhilePointsWait) {
    Random random(5);
    for (int round = 0; round < 400; ++round) {
        const bool exactly = round % 2 == 1;
        const std::int64_t ids = 1 + static_cast<std::int64_t>(random() % 6);
        const auto some = [&](std::int64_t more) {
            std::vector<Input> points;
            for (std::size_t n = 1 + random() % 30; n > 0; --n)
                points.push_back({static_cast<std::int64_t>(random() % (ids + more)),
                                  {double(random() % 2), 0},
                                  {double(random() % 2)}});
            return points;
        };
        const std::vector<Input> points = some(0), gone = some(2);
        MeshOf<2> mesh(1); // all on a line: no triangle
        ASSERT_EQ(mesh.insert(points), ABACUS_OK);
        std::uint64_t deleted = 0;
        ASSERT_EQ(mesh.remove(gone, deleted, 16 << 20, exactly), ABACUS_OK);

        std::multiset<std::array<double, 3>> expected, found; // id, x, attribute
        std::size_t left = 0;
        for (const double x : {0.0, 1.0}) {
            std::vector<Input> here;
            Points identities, wants;
            const auto identity = [&](const Input &p) {
                return exactly ? 2 * p.id + (p.attributes[0] != 0) : p.id;
            };
            for (const Input &p : points)
                if (p.point[0] == x) here.push_back(p), identities.push_back(identity(p));
            for (const Input &p : gone)
                if (p.point[0] == x) wants.push_back(identity(p));
            for (const std::size_t i : left_one_by_one(identities, wants, exactly)) {
                expected.insert({double(here[i].id), x, here[i].attributes[0]});
                ++left;
            }
        }
        ASSERT_EQ(deleted, points.size() - left);
        abacus_vertex_scan *scan = nullptr;
        ASSERT_EQ(abacus_vertex_scan_open(mesh.host.table(), &mesh.header.facts, mesh.cache_bytes,
                                          &scan, &mesh.error),
                  ABACUS_OK);
        abacus_vertex vertex;
        while (abacus_vertex_scan_next(scan, &vertex, &mesh.error) == ABACUS_OK)
            found.insert({double(vertex.id), vertex.point[0], vertex.attributes[0]});
        abacus_vertex_scan_close(scan);
        ASSERT_EQ(found, expected) << exactly;
    }
}

/// A mesh with several points at one place, and the points that should be there.
class Place {
public:
    explicit Place(std::size_t cache_bytes = std::size_t(64) << 20) : mesh(1, cache_bytes) {
        insert({Input{-1, {1, 0}, {0.}}, Input{-2, {0, 1}, {0.}}, Input{-3, {-1, -1}, {0.}}});
    }

    void add(const std::vector<std::int64_t> &ids) {
        std::vector<Input> points;
        for (const std::int64_t id : ids) {
            points.push_back({id, {0, 0}, {static_cast<double>(next_++)}});
            here.push_back(points.back());
        }
        insert(points);
    }
    void remove(const std::vector<std::int64_t> &ids) {
        std::vector<Input> gone;
        std::uint64_t expected = 0, deleted = 0;
        for (const std::int64_t id : ids) {
            gone.push_back({id, {0, 0}, {0.}});
            if (here.empty()) continue;
            const auto at =
                std::find_if(here.begin(), here.end(), [&](const Input &p) { return p.id == id; });
            here.erase(at == here.end() ? here.begin() : at);
            ++expected;
        }
        ASSERT_EQ(mesh.remove(gone, deleted), ABACUS_OK) << mesh.error.detail;
        ASSERT_EQ(deleted, expected);
        ASSERT_EQ(mesh.host.violations, std::vector<std::string>{});
        ASSERT_EQ(mesh.host.bytes, 0u);
    }
    /// Compares the points, and checks which of them is the vertex.
    void expect() {
        ASSERT_EQ(mesh.check(), std::vector<std::string>{});
        ASSERT_EQ(mesh.header.facts.census.vertices, here.empty() ? 3u : 4u);
        ASSERT_EQ(mesh.header.facts.census.duplicates, here.empty() ? 0u : here.size() - 1);
        abacus_vertex_scan *scan = nullptr;
        ASSERT_EQ(abacus_vertex_scan_open(mesh.host.table(), &mesh.header.facts, mesh.cache_bytes,
                                          &scan, &mesh.error),
                  ABACUS_OK);
        std::vector<std::pair<std::int64_t, double>> found, expected;
        for (const Input &p : here) expected.push_back({p.id, p.attributes[0]});
        abacus_vertex v;
        while (abacus_vertex_scan_next(scan, &v, &mesh.error) == ABACUS_OK) {
            if (v.point[0] != 0 || v.point[1] != 0) continue;
            found.push_back({v.id, v.attributes[0]});
            EXPECT_EQ(v.vertex, here.front().id);
        }
        abacus_vertex_scan_close(scan);
        std::sort(found.begin(), found.end());
        std::sort(expected.begin(), expected.end());
        ASSERT_EQ(found, expected);
    }

    Mesh mesh;
    std::vector<Input> here;

private:
    void insert(const std::vector<Input> &points) {
        ASSERT_EQ(mesh.insert(points), ABACUS_OK) << mesh.error.detail;
    }

    int next_ = 0;
};

TEST(Leaving, TakesPointsOfOnePlaceAsOneAfterTheOther) {
    Random random(5);
    // The small cache takes some dozens at a time, the large one all of them.
    for (const std::size_t cache_bytes : {std::size_t(40) << 10, std::size_t(16) << 20}) {
        Place place(cache_bytes);
        for (int step = 0; step < (sanitized ? 50 : 150); ++step) {
            const std::int64_t ids = 1 + static_cast<std::int64_t>(random() % 2000);
            std::vector<std::int64_t> some(1 + random() % 900);
            for (std::int64_t &id : some) id = static_cast<std::int64_t>(random() % ids);
            if (random() % 2 == 0)
                place.add(some);
            else
                place.remove(some);
            place.expect();
            if (testing::Test::HasFatalFailure()) return;
        }
    }
}

/// Counts the calls for pages while half of n points of a place are removed.
std::uint64_t calls_to_take_half(std::size_t n, Random *random, std::int64_t id_offset) {
    std::vector<std::int64_t> ids(n);
    std::iota(ids.begin(), ids.end(), 0);
    Place place;
    place.add(ids);
    if (random != nullptr) std::shuffle(ids.begin(), ids.end(), *random);
    ids.resize(n / 2);
    for (std::int64_t &id : ids) id += id_offset;
    const MemoryHost::Calls before = place.mesh.host.calls;
    place.remove(ids);
    const MemoryHost::Calls &after = place.mesh.host.calls;
    const std::uint64_t calls = after.find + after.next + after.put + after.erase -
                                (before.find + before.next + before.put + before.erase);
    place.expect();
    return calls;
}

TEST(Leaving, ReadsAndWritesThePagesOfAPlaceAFewTimes) {
    // In the order of input, in any order, and by unknown ids.
    Random random(7);
    const std::size_t n = sanitized ? 5000 : 20000, points_a_page = 100; // at least
    EXPECT_LT(calls_to_take_half(n, nullptr, 0), 8 * n / points_a_page);
    EXPECT_LT(calls_to_take_half(n, &random, 0), 8 * n / points_a_page);
    EXPECT_LT(calls_to_take_half(n, nullptr, 1 << 20), 8 * n / points_a_page);
}

} // namespace
} // namespace abacus::test
