// Changes of points' attributes change nothing else.
#include "points/record.hpp"
#include "support/point_model.hpp"
#include "support/sanitized.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace abacus::test {
namespace {

constexpr std::uint32_t attributes = 70; // three groups of pages, if they are apart

template <int D> class Updated {
public:
    Updated(bool apart, std::size_t cache_bytes, int count = static_cast<int>(attributes))
        : mesh(count, cache_bytes), count_(static_cast<std::size_t>(count)) {
        mesh.header.facts.columns.apart = apart;
    }

    /// Points of a kind: 0 uniform, 1 few places, 2 on a line or plane.
    std::vector<InputOf<D>> fresh(std::size_t n, int kind) {
        std::vector<InputOf<D>> points;
        for (; points.size() < n; ++next_id_) {
            Point<D> p;
            for (double &x : p)
                x = kind == 1 ? double(random() % 4)
                              : std::uniform_real_distribution<double>(0, 1)(random);
            if (kind == 2) p[D - 1] = 2 * (p[0] = double(next_id_ % 600));
            if (kind == 2 && D == 3) p[1] = 0;
            points.push_back({next_id_, p, values(count_)});
        }
        return points;
    }
    std::vector<double> values(std::size_t n) {
        std::vector<double> values(n);
        for (double &x : values) x = double(random() % 1000) / 8;
        return values;
    }
    /// Some attributes, each once, in any order.
    std::vector<std::uint32_t> some_attributes() {
        std::vector<std::uint32_t> which(count_);
        for (std::uint32_t i = 0; i < count_; ++i) which[i] = i;
        std::shuffle(which.begin(), which.end(), random);
        which.resize(1 + random() % 5);
        return which;
    }
    /// Other values for some of the present points, a few of them under another id or twice.
    std::vector<InputOf<D>> changes(std::size_t n, std::size_t width) {
        std::vector<InputOf<D>> all = model.points();
        std::shuffle(all.begin(), all.end(), random);
        if (all.size() > n) all.resize(n);
        if (all.size() > 2) all.push_back(all.front());
        for (InputOf<D> &p : all) {
            p.attributes = values(width);
            if (random() % 16 == 0) p.id = -1;
        }
        return all;
    }
    void insert(const std::vector<InputOf<D>> &points) {
        model.insert(points);
        ASSERT_EQ(mesh.insert(points), ABACUS_OK) << mesh.error.detail;
    }
    abacus_status update(const std::vector<InputOf<D>> &points,
                         const std::vector<std::uint32_t> &which, std::size_t memory = 16 << 20) {
        return update(points, which, false, memory);
    }
    /// The points have values of all attributes, followed by their old values.
    abacus_status update_exactly(const std::vector<InputOf<D>> &points) {
        std::vector<std::uint32_t> all(count_);
        std::iota(all.begin(), all.end(), 0);
        return update(points, all, true, 16 << 20);
    }

    MeshOf<D> mesh;
    PointModel<D> model;
    std::mt19937_64 random{7};
    std::uint64_t updated = 0;
    abacus_named_place missing{};

private:
    abacus_status update(const std::vector<InputOf<D>> &points,
                         const std::vector<std::uint32_t> &which, bool exactly,
                         std::size_t memory) {
        const std::size_t width = which.size() + (exactly ? count_ : 0);
        abacus_header shape = mesh.header;
        shape.facts.columns.attributes = static_cast<std::uint32_t>(width);
        abacus_stage *stage = nullptr;
        abacus_status status =
            abacus_stage_open(mesh.host.table(), &shape.facts, memory, &stage, &mesh.error);
        for (const InputOf<D> &p : points) {
            std::vector<std::uint64_t> record(record_words(D, shape.facts.columns.attributes));
            fill_record<D>(record.data(), p.id, p.point, p.attributes.data(), width);
            if (status == ABACUS_OK)
                status = abacus_stage_add(stage, record.data(), 1, &mesh.error);
        }
        if (status == ABACUS_OK)
            status = mesh.with_build([&](abacus_build *build) {
                return abacus_build_update(build, stage, which.data(), which.size(), exactly,
                                           &mesh.header, &updated, &missing, &mesh.error);
            });
        abacus_stage_close(stage);
        return status;
    }

    std::size_t count_;
    std::int64_t next_id_ = 0;
};

/// Counts the pages that have not changed.
std::size_t same_pages(const MemoryHost::Pages &before, const MemoryHost::Pages &now) {
    std::size_t same = 0;
    for (const auto &[key, page] : before) {
        const auto found = now.find(key);
        same += found != now.end() && found->second.words == page.words;
    }
    return same;
}

template <class Dimension> class Update : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Update, Dimensions);

TYPED_TEST(Update, ChangesTheAttributesThatAreNamed) {
    // Attributes of vertices, of points equal to one, and of points that wait since they span no
    // simplex.
    constexpr int D = TypeParam::value;
    const std::size_t sizes[] = {1, 2, 10, 100, 400};
    for (const bool apart : {false, true})
        for (const int kind : {0, 1, 2})
            for (const std::size_t cache_bytes : {std::size_t(40) << 10, std::size_t(1) << 20}) {
                SCOPED_TRACE(kind);
                Updated<D> world(apart, cache_bytes);
                for (int step = 0; step < (sanitized ? 10 : 25); ++step) {
                    const std::size_t n = sizes[world.random() % std::size(sizes)];
                    if (step == 0 || world.random() % 3 == 0) {
                        const auto points = world.fresh(n, kind);
                        if (world.random() % 3 == 0) {
                            world.model.stage(points);
                            ASSERT_EQ(world.mesh.stage(points), ABACUS_OK);
                        } else {
                            world.insert(points);
                        }
                    } else {
                        const auto which = world.some_attributes();
                        const auto points = world.changes(n, which.size());
                        const std::size_t memory = step % 2 == 0 ? 16 << 20 : 64 << 10;
                        ASSERT_EQ(world.update(points, which, memory), ABACUS_OK)
                            << world.mesh.error.detail;
                        ASSERT_EQ(world.updated, points.size());
                        world.model.update(points, which);
                    }
                    world.model.expect(world.mesh);
                    if (this->HasFatalFailure()) return;
                }
            }
}

TYPED_TEST(Update, WritesOnlyPagesOfTheAttributesThatAreNamed) {
    constexpr int D = TypeParam::value;
    Updated<D> world(true, 1 << 20);
    world.insert(world.fresh(3000, 0));
    const auto simplices = world.mesh.host.pages;
    const auto before = world.mesh.host.attribute_pages;
    const auto points = world.changes(1000, 1);
    const abacus_counters counted = world.mesh.header.counters;
    ASSERT_EQ(world.update(points, {attributes - 1}), ABACUS_OK);
    world.model.update(points, {attributes - 1});
    const abacus_counters &now = world.mesh.header.counters;
    EXPECT_GT(now.stores, counted.stores);
    EXPECT_GE(now.loads - counted.loads, now.rewrites - counted.rewrites);
    EXPECT_LE(now.stores - counted.stores, before.size() / 2);
    EXPECT_GT(now.bytes_written, counted.bytes_written);
    world.model.expect(world.mesh);
    EXPECT_EQ(same_pages(simplices, world.mesh.host.pages), simplices.size());
    EXPECT_EQ(simplices.size(), world.mesh.host.pages.size());
    const std::size_t same = same_pages(before, world.mesh.host.attribute_pages);
    EXPECT_GT(same * 2, before.size()); // two groups of three
    EXPECT_LT(same, before.size());
}

TYPED_TEST(Update, LooksForNoLabels) {
    // The simplices do not change, even if attributes are in their pages.
    constexpr int D = TypeParam::value;
    std::size_t found[2];
    for (const bool labelled : {false, true}) {
        Updated<D> world(false, 1 << 20, 1);
        world.insert(world.fresh(2000, 0));
        world.mesh.header.facts.columns.labels = world.mesh.header.facts.census.labelled =
            labelled; // none is stored
        const auto points = world.changes(1000, 1);
        const std::size_t before = world.mesh.host.calls.find;
        ASSERT_EQ(world.update(points, {0}), ABACUS_OK) << world.mesh.error.detail;
        found[labelled] = world.mesh.host.calls.find - before;
        world.mesh.header.facts.columns.labels = world.mesh.header.facts.census.labelled = 0;
        world.model.update(points, {0});
        world.model.expect(world.mesh);
    }
    EXPECT_EQ(found[0], found[1]);
}

TYPED_TEST(Update, ReadsEqualPointsOnce) {
    constexpr int D = TypeParam::value;
    Updated<D> world(false, 1 << 20, 1);
    world.insert(world.fresh(50, 0));
    auto equal = world.fresh(5000, 0);
    for (InputOf<D> &p : equal) p.point = world.model.points().front().point;
    world.insert(equal);
    std::reverse(equal.begin(), equal.end());
    equal.push_back(equal.front()); // the last one counts
    for (InputOf<D> &p : equal) p.attributes = world.values(1);
    const auto before = world.mesh.host.calls;
    ASSERT_EQ(world.update(equal, {0}), ABACUS_OK);
    EXPECT_EQ(world.updated, equal.size());
    EXPECT_LT(world.mesh.host.calls.find - before.find, 300u); // about fifty pages
    EXPECT_LT(world.mesh.host.calls.put - before.put, 100u);
    world.model.update(equal, {0});
    world.model.expect(world.mesh);
}

/// Points of the model with new values, followed by their old ones.
template <int D> std::vector<InputOf<D>> exact_changes(Updated<D> &world, std::size_t n) {
    std::vector<InputOf<D>> all = world.model.points();
    std::shuffle(all.begin(), all.end(), world.random);
    if (all.size() > n) all.resize(n);
    for (InputOf<D> &p : all) {
        std::vector<double> now = world.values(p.attributes.size());
        if (world.random() % 8 == 0) now[0] = p.attributes[0];
        now.insert(now.end(), p.attributes.begin(), p.attributes.end());
        p.attributes = now;
    }
    return all;
}

TYPED_TEST(Update, ExactlyChangesPointsThatAreAsTheyWere) {
    constexpr int D = TypeParam::value;
    for (const bool apart : {false, true})
        for (const int kind : {0, 1}) {
            SCOPED_TRACE(kind);
            const int count = apart ? 50 : 3;
            Updated<D> world(apart, std::size_t(64) << 10, count);
            world.insert(world.fresh(300, kind));
            for (int step = 0; step < (sanitized ? 5 : 20); ++step) {
                const auto points = exact_changes(world, 1 + world.random() % 200);
                ASSERT_EQ(world.update_exactly(points), ABACUS_OK) << world.mesh.error.detail;
                ASSERT_EQ(world.updated, points.size());
                std::vector<std::uint32_t> all(static_cast<std::size_t>(count));
                std::iota(all.begin(), all.end(), 0);
                world.model.update(points, all);
                world.model.expect(world.mesh);
                if (this->HasFatalFailure()) return;
            }
            // one with a wrong attribute, and one at another place
            auto points = exact_changes(world, 5);
            points[2].attributes.back() += 1;
            ASSERT_EQ(world.update_exactly(points), ABACUS_OK);
            EXPECT_EQ(world.updated, 4u);
            EXPECT_EQ(world.missing.id, points[2].id);
            points = exact_changes(world, 1);
            points[0].point.fill(0.25);
            ASSERT_EQ(world.update_exactly(points), ABACUS_OK);
            EXPECT_EQ(world.updated, 0u);
        }
}

/// The first attribute of all points at this point's place, in order.
template <int D> std::vector<double> values_at(MeshOf<D> &mesh, const InputOf<D> &like) {
    std::vector<double> values;
    abacus_vertex_scan *scan = nullptr;
    EXPECT_EQ(abacus_vertex_scan_open(mesh.host.table(), &mesh.header.facts, mesh.cache_bytes,
                                      &scan, &mesh.error),
              ABACUS_OK);
    abacus_vertex v;
    while (abacus_vertex_scan_next(scan, &v, &mesh.error) == ABACUS_OK)
        if (std::equal(like.point.begin(), like.point.end(), v.point))
            values.push_back(v.attributes[0]);
    abacus_vertex_scan_close(scan);
    std::sort(values.begin(), values.end());
    return values;
}

TYPED_TEST(Update, ExactlyTakesEachOfEqualPointsOnce) {
    // Rows that agree in everything except attributes, or even in these; one of them is the vertex.
    constexpr int D = TypeParam::value;
    for (const bool apart : {false, true}) {
        Updated<D> world(apart, 1 << 20, 1);
        const auto around = world.fresh(50, 0);
        ASSERT_EQ(world.mesh.insert(around), ABACUS_OK);
        InputOf<D> point = around[0];
        for (const double value : {1., 2., 2., 3.}) {
            point.attributes = {value};
            ASSERT_EQ(world.mesh.insert({point}), ABACUS_OK);
        }
        const auto change = [&](const std::vector<std::pair<double, double>> &changes) {
            std::vector<InputOf<D>> points;
            for (const auto &[from, to] : changes) {
                points.push_back(point);
                points.back().attributes = {to, from};
            }
            ASSERT_EQ(world.update_exactly(points), ABACUS_OK) << world.mesh.error.detail;
        };
        const double first = around[0].attributes[0];
        change({{2, 3}, {3, 2}, {1, 2}, {2, 2.5}, {first, -1}});
        EXPECT_EQ(world.updated, 5u);
        EXPECT_EQ(values_at<D>(world.mesh, point), (std::vector<double>{-1, 2, 2, 2.5, 3}));
        change({{2, 7}, {2, 7}, {2, 7}}); // there are only two
        EXPECT_EQ(world.updated, 2u);
        EXPECT_EQ(world.missing.id, point.id);
        point.id = -5; // not in the mesh
        change({{3, 4}});
        EXPECT_EQ(world.updated, 0u);
        EXPECT_EQ(world.mesh.check(), std::vector<std::string>{});
    }
}

TYPED_TEST(Update, SaysWhichPointIsMissing) {
    constexpr int D = TypeParam::value;
    for (const bool apart : {false, true})
        for (const int kind : {0, 2}) {
            Updated<D> world(apart, 1 << 20, 1);
            world.insert(world.fresh(50, kind));
            auto points = world.changes(20, 1);
            const std::size_t there = points.size();
            Point<D> nowhere;
            nowhere.fill(0.5);
            points.insert(points.begin() + 5, {777, nowhere, {1.}});
            ASSERT_EQ(world.update(points, {0}), ABACUS_OK);
            EXPECT_EQ(world.updated, there);
            EXPECT_EQ(world.missing.id, 777);
            EXPECT_TRUE(std::equal(nowhere.begin(), nowhere.end(), world.missing.point));
        }
    Updated<D> empty(false, 1 << 20, 1);
    ASSERT_EQ(empty.update({{1, Point<D>{}, {1.}}}, {0}), ABACUS_OK);
    EXPECT_EQ(empty.updated, 0u);
    EXPECT_EQ(empty.missing.id, 1);
    EXPECT_EQ(empty.mesh.header.facts.form.has_domain, 0u);
}

TYPED_TEST(Update, LosesNothingWhenAnythingFails) {
    // A failing call of the host becomes an error, and no memory is lost.
    constexpr int D = TypeParam::value;
    for (const bool apart : {false, true}) {
        Updated<D> world(apart, 64 << 10, 3);
        world.insert(world.fresh(300, 0));
        const auto points = world.changes(100, 1);
        for (std::uint64_t at = 0;; at += sanitized ? 7 : 1) {
            Updated<D> tried(apart, 64 << 10, 3);
            tried.mesh.host.restore(world.mesh.host);
            tried.mesh.header = world.mesh.header;
            tried.mesh.host.fail_at(at);
            const abacus_status status = tried.update(points, {1});
            EXPECT_EQ(tried.mesh.host.bytes, 0u);
            if (status == ABACUS_OK) break;
            ASSERT_EQ(status, ABACUS_HOST_ERROR);
        }
    }
}

} // namespace
} // namespace abacus::test
