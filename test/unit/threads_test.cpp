// Any number of threads make the same mesh, and end cleanly whatever fails in any of them.
#include "support/threads.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace abacus::test {
namespace {

template <class Dimension> class Threads : public ThreadsTest<Dimension> {
protected:
    using ThreadsTest<Dimension>::D, ThreadsTest<Dimension>::ids;

    /// The result of inserting these with one thread, in a few steps.
    void expect_same(const std::vector<std::vector<InputOf<D>>> &steps, std::size_t cache_bytes,
                     abacus_on_duplicate on_duplicate = ABACUS_KEEP) {
        MeshOf<D> alone(1, cache_bytes);
        for (const auto &step : steps)
            ASSERT_EQ(alone.insert(step, 16 << 20, on_duplicate), ABACUS_OK) << alone.error.detail;
        ASSERT_EQ(alone.check(), std::vector<std::string>{});
        const auto expected = ids(alone);
        for (const unsigned threads : {2, 3, 4, 7}) {
            MeshOf<D> mesh(1, cache_bytes);
            mesh.host.set_threads(threads, true);
            for (const auto &step : steps) {
                ASSERT_EQ(mesh.insert(step, 16 << 20, on_duplicate), ABACUS_OK)
                    << mesh.error.message << " " << mesh.error.detail;
                ASSERT_TRUE(all_threads_ended());
            }
            EXPECT_EQ(mesh.check(), std::vector<std::string>{});
            EXPECT_TRUE(ids(mesh) == expected) << threads << " threads";
            EXPECT_EQ(mesh.header.facts.census.vertices, alone.header.facts.census.vertices);
            EXPECT_EQ(mesh.header.facts.census.duplicates, alone.header.facts.census.duplicates);
            EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
            EXPECT_EQ(mesh.host.bytes, 0u);
        }
    }
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Threads, Dimensions);

TYPED_TEST(Threads, GiveTheSameMeshOfUniformPoints) {
    for (const std::size_t cache : {little, ample})
        this->expect_same({this->with_ids(this->uniform(1200)), this->with_ids(this->uniform(1)),
                           this->with_ids(this->uniform(400))},
                          cache);
}

TYPED_TEST(Threads, GiveTheMeshOfCgal) {
    constexpr int D = TypeParam::value;
    const auto points = this->uniform(2000);
    MeshOf<D> mesh(1);
    mesh.host.set_threads(4, true);
    ASSERT_EQ(mesh.insert(this->with_ids(points)), ABACUS_OK);
    EXPECT_EQ(mesh.positions(), cgal_simplices<D>(points));
}

TYPED_TEST(Threads, ShareMuchWorkEvenly) {
    // Without the switch for tests: large intervals, then the rest; all points at once, or in
    // batches.
    constexpr int D = TypeParam::value;
    auto points = this->uniform(D == 2 ? 150000 : 60000);
    for (std::size_t i = 0; i < 5000; ++i) points.push_back(points[i * 7]);
    const auto input = this->with_ids(points);
    MeshOf<D> alone(1);
    ASSERT_EQ(alone.insert(input), ABACUS_OK);
    const auto expected = this->ids(alone);
    for (const std::size_t cache : {ample, ample / 20}) {
        MeshOf<D> mesh(1, cache);
        mesh.host.set_threads(2, false);
        int most = 0;
        mesh.host.on_progress = [&](const abacus_progress &) {
            most = std::max(most, threads_now());
        };
        ASSERT_EQ(mesh.insert(input), ABACUS_OK);
        EXPECT_EQ(most, threads_at_first + 2);
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        EXPECT_TRUE(this->ids(mesh) == expected);
        EXPECT_EQ(mesh.header.facts.census.duplicates, 5000u);
        EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
    }
}

TYPED_TEST(Threads, GatherNoMoreThanTheirShareOfTheMemory) {
    // Points that take twice the memory of the build; almost nothing else does.
    constexpr int D = TypeParam::value;
    constexpr std::size_t cache = 8 << 20, sort = 1 << 20;
    auto input = this->with_ids(this->uniform(20000));
    for (auto &p : input) p.attributes.assign(100, p.point[0]);
    for (const auto on_duplicate : {ABACUS_KEEP, ABACUS_REPLACE}) {
        MeshOf<D> mesh(100, cache);
        mesh.header.facts.columns.apart = 1;
        mesh.host.set_threads(2, false);
        ASSERT_EQ(mesh.insert({input.begin(), input.begin() + 10}), ABACUS_OK);
        mesh.host.peak_bytes = 0;
        ASSERT_EQ(mesh.insert(input, sort, on_duplicate), ABACUS_OK) << mesh.error.message;
        EXPECT_LT(mesh.host.peak_bytes, std::size_t{14} << 20);
        EXPECT_EQ(mesh.header.facts.census.vertices, 20000u);
    }
}

TYPED_TEST(Threads, KeepTheFirstOfEqualPoints) {
    // On a coarse grid: most points are equal to others, and all are cospherical with some.
    constexpr int D = TypeParam::value;
    std::vector<Point<D>> points(3000);
    for (auto &p : points)
        for (double &x : p) x = double(this->random() % (D == 2 ? 25 : 8));
    const auto first = this->with_ids(points);
    std::shuffle(points.begin(), points.end(), this->random);
    const auto second = this->with_ids(points);
    for (const auto on_duplicate : {ABACUS_KEEP, ABACUS_REPLACE})
        this->expect_same({first, second}, little, on_duplicate);
    MeshOf<D> mesh(1);
    mesh.host.set_threads(3, true);
    ASSERT_EQ(mesh.insert(first), ABACUS_OK);
    EXPECT_EQ(mesh.insert(second, 16 << 20, ABACUS_REFUSE), ABACUS_ERROR);
    EXPECT_EQ(mesh.error.kind, ABACUS_ERROR_DUPLICATE);
    EXPECT_EQ(mesh.host.bytes, 0u);
    EXPECT_TRUE(all_threads_ended());
}

TYPED_TEST(Threads, TakeDegenerateInput) {
    constexpr int D = TypeParam::value;
    std::vector<Point<D>> line, cluster, moment;
    for (int i = 0; i < 600; ++i) {
        Point<D> p{};
        p[0] = p[1] = i;
        line.push_back(p);
        for (int axis = 0; axis < D; ++axis)
            p[axis] = 1e9 + std::ldexp(double(i * (axis + 3) % 97), -20);
        cluster.push_back(p);
        // In space each point is a neighbour of every other.
        for (int axis = 0; axis < D; ++axis) p[axis] = std::pow(i * 0.01, axis + 1);
        if (D == 2 || i < 120) moment.push_back(p);
    }
    Point<D> apart{};
    apart[D - 1] = -5000;
    line.push_back(apart);
    if (D == 3) {
        apart[1] = 777;
        line.push_back(apart);
    }
    cluster.push_back(apart);
    moment.push_back(apart);
    for (const auto *points : {&line, &cluster, &moment})
        this->expect_same({this->with_ids(*points)}, little);
}

TYPED_TEST(Threads, BuildWhatWaits) {
    constexpr int D = TypeParam::value;
    const auto points = this->uniform(2000);
    MeshOf<D> mesh(1, little);
    mesh.host.set_threads(3, true);
    ASSERT_EQ(mesh.stage(this->with_ids(points)), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.detail;
    EXPECT_EQ(mesh.positions(), cgal_simplices<D>(points));
    EXPECT_EQ(mesh.check(), std::vector<std::string>{});
}

TYPED_TEST(Threads, EndCleanlyWhereverTheHostFails) {
    constexpr int D = TypeParam::value;
    const auto first = this->with_ids(this->uniform(300)),
               more = this->with_ids(this->uniform(300));
    for (std::uint64_t n = 1, ended = 0; !ended; n += 1 + n / 6) {
        MeshOf<D> mesh(1, little);
        mesh.host.set_threads(3, true);
        ASSERT_EQ(mesh.insert(first), ABACUS_OK);
        const abacus_header before = mesh.header;
        mesh.host.fail_at(n);
        const abacus_status status = mesh.insert(more);
        ASSERT_TRUE(all_threads_ended());
        ASSERT_EQ(mesh.host.bytes, 0u);
        ASSERT_EQ(mesh.host.violations, std::vector<std::string>{});
        if (status == ABACUS_OK)
            ended = 1;
        else {
            ASSERT_EQ(status, ABACUS_HOST_ERROR) << n;
            ASSERT_EQ(mesh.header.facts.census.vertices, before.facts.census.vertices);
        }
    }
}

TYPED_TEST(Threads, EndCleanlyWhenTheirMemoryRunsOut) {
    constexpr int D = TypeParam::value;
    const auto first = this->with_ids(this->uniform(300)),
               more = this->with_ids(this->uniform(300));
    int failures = 0;
    for (std::size_t kilobytes = 4;; kilobytes += 1 + kilobytes / 6, ++failures) {
        MeshOf<D> mesh(1, little);
        mesh.host.set_threads(3, true);
        ASSERT_EQ(mesh.insert(first), ABACUS_OK);
        const abacus_header before = mesh.header;
        mesh.host.limit_threads(kilobytes << 10);
        const abacus_status status = mesh.insert(more);
        ASSERT_TRUE(all_threads_ended());
        ASSERT_EQ(mesh.host.bytes, 0u);
        ASSERT_EQ(mesh.host.violations, std::vector<std::string>{});
        if (status == ABACUS_OK) break;
        ASSERT_EQ(status, ABACUS_ERROR);
        ASSERT_EQ(mesh.error.kind, ABACUS_ERROR_MEMORY) << mesh.error.message;
        ASSERT_EQ(mesh.header.facts.census.vertices, before.facts.census.vertices);
    }
    EXPECT_GT(failures, 5);
}

TYPED_TEST(Threads, AreCounted) {
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(1, little);
    ASSERT_EQ(mesh.insert(this->with_ids(this->uniform(500))), ABACUS_OK);
    EXPECT_EQ(mesh.header.counters.passes, 0u);
    EXPECT_EQ(mesh.header.counters.waited_ns, 0u);
    mesh.host.set_threads(3, true);
    std::uint32_t most = 0;
    mesh.host.on_progress = [&](const abacus_progress &p) { most = std::max(most, p.threads); };
    ASSERT_EQ(mesh.insert(this->with_ids(this->uniform(3000))), ABACUS_OK);
    EXPECT_GT(mesh.header.counters.passes, 1u);
    EXPECT_GT(mesh.header.counters.put_off, 100u);
    EXPECT_GT(mesh.header.counters.waited_ns, 0u);
    EXPECT_GT(most, 0u);
    EXPECT_LE(most, 3u);
}

TYPED_TEST(Threads, EndCleanlyWhenTheyAreCancelled) {
    constexpr int D = TypeParam::value;
    const auto first = this->with_ids(this->uniform(300)),
               more = this->with_ids(this->uniform(3000));
    MeshOf<D> mesh(1, little);
    mesh.host.set_threads(3, true);
    ASSERT_EQ(mesh.insert(first), ABACUS_OK);
    bool were_at_work = false;
    mesh.host.on_progress = [&](const abacus_progress &) {
        if (threads_now() == threads_at_first) return;
        were_at_work = true;
        mesh.host.cancel();
    };
    EXPECT_EQ(mesh.insert(more), ABACUS_HOST_ERROR);
    EXPECT_TRUE(were_at_work);
    EXPECT_TRUE(all_threads_ended());
    EXPECT_EQ(mesh.host.bytes, 0u);
}

TYPED_TEST(Threads, FindDamagedPages) {
    constexpr int D = TypeParam::value;
    const auto first = this->with_ids(this->uniform(4000)),
               more = this->with_ids(this->uniform(3000));
    MeshOf<D> mesh(1, little);
    mesh.host.set_threads(3, true);
    ASSERT_EQ(mesh.insert(first), ABACUS_OK);
    auto page =
        std::next(mesh.host.pages.begin(), static_cast<std::ptrdiff_t>(mesh.host.pages.size() / 2));
    page->second.bytes()[page->second.size / 2] ^= 1;
    EXPECT_EQ(mesh.insert(more), ABACUS_ERROR);
    EXPECT_EQ(mesh.error.kind, ABACUS_ERROR_CORRUPTED);
    EXPECT_TRUE(all_threads_ended());
    EXPECT_EQ(mesh.host.bytes, 0u);
}

} // namespace
} // namespace abacus::test
