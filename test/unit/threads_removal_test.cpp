// Any number of threads remove points: the same mesh, and a clean end whatever fails.
#include "support/point_model.hpp"
#include "support/point_sets.hpp"
#include "support/sanitized.hpp"
#include "support/threads.hpp"

#include <cmath>

namespace abacus::test {
namespace {

template <class Dimension> class ThreadsRemoval : public ThreadsTest<Dimension> {
protected:
    static constexpr int D = ThreadsTest<Dimension>::D;
    using Inputs = std::vector<InputOf<D>>;

    void fill(MeshOf<D> &mesh, const Inputs &points) {
        ASSERT_EQ(mesh.insert(points), ABACUS_OK) << mesh.error.detail;
    }
    /// A share of these, in random order.
    Inputs some(Inputs points, double share) {
        std::shuffle(points.begin(), points.end(), this->random);
        points.resize(static_cast<std::size_t>(share * static_cast<double>(points.size())));
        return points;
    }
    void insert(MeshOf<D> &mesh, PointModel<D> &model, const Inputs &points) {
        model.insert(points);
        ASSERT_EQ(mesh.insert(points), ABACUS_OK) << mesh.error.detail;
    }
    void remove(MeshOf<D> &mesh, PointModel<D> &model, const Inputs &points) {
        std::uint64_t deleted = 0;
        const std::uint64_t expected = model.remove(points);
        ASSERT_EQ(mesh.remove(points, deleted), ABACUS_OK)
            << mesh.error.message << " " << mesh.error.detail;
        ASSERT_EQ(deleted, expected);
        ASSERT_TRUE(all_threads_ended());
        model.expect(mesh);
    }
    /// All points come, half of them leave, come again, and all leave: with this many threads.
    void come_and_go(const std::vector<Point<D>> &points, std::size_t cache_bytes,
                     const std::vector<unsigned> &numbers_of_threads = {2, 3, 4, 7}) {
        const Inputs all = this->with_ids(points);
        for (const unsigned threads : numbers_of_threads) {
            SCOPED_TRACE(threads);
            MeshOf<D> mesh(1, cache_bytes);
            PointModel<D> model;
            mesh.host.set_threads(threads, true);
            insert(mesh, model, all);
            const Inputs half = some(all, 0.5);
            remove(mesh, model, half);
            if (this->HasFatalFailure()) return;
            insert(mesh, model, half);
            model.expect(mesh);
            remove(mesh, model, some(all, 0.9));
            remove(mesh, model, model.points());
            if (this->HasFatalFailure()) return;
            EXPECT_TRUE(mesh.host.pages.empty());
        }
    }
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(ThreadsRemoval, Dimensions);

TYPED_TEST(ThreadsRemoval, GivesTheMeshOfThePointsLeft) {
    const auto points = this->uniform(TypeParam::value == 2 ? 700 : 300);
    for (const std::size_t cache : {little, ample}) this->come_and_go(points, cache);
}

TYPED_TEST(ThreadsRemoval, TakesHardInput) {
    constexpr int D = TypeParam::value;
    for (const auto &set : point_sets<D>()) {
        SCOPED_TRACE(set.name);
        auto points = set.points(this->random);
        std::shuffle(points.begin(), points.end(), this->random);
        points.resize(std::min<std::size_t>(points.size(), sanitized ? 60 : 150));
        this->come_and_go(points, little, {2, 7});
        if (this->HasFatalFailure()) return;
    }
}

TYPED_TEST(ThreadsRemoval, TakesTheRightOnesOfEqualPoints) {
    // By their ids, by other ids, more often than they exist, and where there are none.
    constexpr int D = TypeParam::value;
    std::vector<Point<D>> points(1000);
    for (auto &p : points)
        for (double &x : p) x = double(this->random() % (D == 2 ? 28 : 9));
    const auto all = this->with_ids(points);
    for (const unsigned threads : {2, 4, 7}) {
        MeshOf<D> mesh(1, little);
        PointModel<D> model;
        mesh.host.set_threads(threads, true);
        this->insert(mesh, model, all);
        for (int step = 0; step < 4; ++step) {
            auto wanted = this->some(all, 0.3);
            for (auto &p : wanted)
                if (this->random() % 4 == 0) p.id = -1;
            for (int i = 0; i < 60; ++i) wanted.push_back(wanted[i % 3]);
            wanted.push_back({-1, this->uniform(1)[0], {0.}});
            this->remove(mesh, model, wanted);
            if (this->HasFatalFailure()) return;
        }
        EXPECT_GT(mesh.header.facts.census.vertices, 0u);
        EXPECT_GT(mesh.header.facts.census.duplicates, 0u);
    }
}

TYPED_TEST(ThreadsRemoval, TakesOnlyWhatAgreesExactly) {
    constexpr int D = TypeParam::value;
    auto all = this->with_ids(this->uniform(1500));
    for (int i = 0; i < 300; ++i) all.push_back(all[i]), all.back().id += 5000;
    auto wanted = all, taken = all;
    taken.clear();
    for (std::size_t i = 0; i < all.size(); ++i)
        if (i % 3 == 0)
            wanted[i].attributes[0] += 1;
        else if (i % 3 == 1)
            taken.push_back(all[i]);
        else
            wanted[i].id += 20000;
    for (int i = 0; i < 200; ++i) wanted.push_back(taken[i]); // a second time
    std::shuffle(wanted.begin(), wanted.end(), this->random);
    for (const unsigned threads : {1, 2, 3, 7}) {
        MeshOf<D> mesh(1);
        this->fill(mesh, all);
        PointModel<D> model;
        model.insert(all);
        mesh.host.set_threads(threads, true);
        std::uint64_t deleted = 0;
        ASSERT_EQ(mesh.remove(wanted, deleted, 16 << 20, true), ABACUS_OK) << mesh.error.detail;
        EXPECT_EQ(deleted, model.remove(taken));
        model.expect(mesh);
    }
}

TYPED_TEST(ThreadsRemoval, TakesHubsAcrossBorders) {
    // The centre of a circle or sphere is a neighbour of all points on it.
    constexpr int D = TypeParam::value;
    std::vector<Point<D>> points;
    for (int i = 0; i < (sanitized ? 150 : 500); ++i) {
        const double angle = 2.39996322972865332 * i, z = D == 2 ? 0 : (i + 0.5) / 250 - 1;
        const double r = std::sqrt(std::max(0.0, 1 - z * z));
        Point<D> p{r * std::cos(angle), r * std::sin(angle)};
        if (D == 3) p[D - 1] = z;
        points.push_back(p);
        if (i % 3 == 0) { // and some outside
            for (double &x : p) x *= 1.5;
            points.push_back(p);
        }
    }
    points.push_back(Point<D>{});
    points.push_back(Point<D>{1e-7, 1e-8});
    auto hubs = this->with_ids(points);
    this->come_and_go(points, little);
    hubs.erase(hubs.begin(), hubs.end() - 2);
    const auto crowd = this->with_ids({points.begin(), points.end() - 2});
    for (const unsigned threads : {2, 7}) {
        MeshOf<D> mesh(1, little);
        PointModel<D> model;
        mesh.host.set_threads(threads, true);
        this->insert(mesh, model, crowd);
        this->insert(mesh, model, hubs);
        this->remove(mesh, model, hubs);
        if (this->HasFatalFailure()) return;
    }
}

TYPED_TEST(ThreadsRemoval, TriangulatesTheRestWhereThatCostsLess) {
    // Inside a ring, so that the whole ring are neighbours of some of the leaving points, and then
    // of others. It lies in the interval of one thread, which finds that out.
    constexpr int D = TypeParam::value;
    Point<D> centre;
    centre.fill(0.2);
    const auto distance = [&](const Point<D> &p) {
        double squares = 0;
        for (int i = 0; i < D; ++i) squares += (p[i] - centre[i]) * (p[i] - centre[i]);
        return std::sqrt(squares);
    };
    auto field = this->uniform(D == 2 ? 80000 : 45000);
    std::erase_if(field, [&](const Point<D> &p) { return distance(p) < 0.05; });
    std::vector<Point<D>> ring, hubs = this->uniform(60);
    for (int i = 0; i < (D == 2 ? 3000 : 600); ++i) {
        const double angle = 6.283185307179586 * i / (D == 2 ? 3000 : 600);
        Point<D> p = centre;
        p[0] += 0.03 * std::cos(angle);
        p[1] += 0.03 * std::sin(angle);
        ring.push_back(p);
    }
    for (Point<D> &p : hubs)
        for (int i = 0; i < D; ++i) p[i] = centre[i] + (p[i] - 0.5) * 0.002;
    const auto leave = this->some(this->with_ids(field), 0.9), more = this->with_ids(hubs);
    MeshOf<D> mesh(1);
    PointModel<D> model;
    this->insert(mesh, model, leave);
    this->insert(mesh, model, this->with_ids(ring));
    this->insert(mesh, model, more);
    mesh.host.set_threads(2, false);
    auto all = leave;
    all.insert(all.end(), more.begin(), more.end());
    const std::uint64_t before = mesh.header.counters.removals;
    this->remove(mesh, model, all);
    EXPECT_LT(mesh.header.counters.removals - before, all.size());
}

TYPED_TEST(ThreadsRemoval, LeavesPointsThatWait) {
    // On a line or in a plane, except for one point, without which they span no simplex.
    constexpr int D = TypeParam::value;
    std::vector<Point<D>> flat;
    for (int i = 0; i < 900; ++i) {
        Point<D> p{double(i % 30), double(i % 30)};
        if (D == 3) p[D - 1] = i / 30; // NOLINT(bugprone-integer-division)
        flat.push_back(p);
    }
    Point<D> apart{};
    apart[0] = -5000;
    const auto all = this->with_ids(flat), one = this->with_ids({apart});
    for (const unsigned threads : {2, 4}) {
        MeshOf<D> mesh(1, little);
        PointModel<D> model;
        mesh.host.set_threads(threads, true);
        this->insert(mesh, model, all);
        this->insert(mesh, model, one);
        auto leave = this->some(all, 0.5);
        leave.insert(leave.begin() + 100, one[0]);
        this->remove(mesh, model, leave);
        if (this->HasFatalFailure()) return;
        EXPECT_EQ(mesh.header.facts.census.vertices, 0u);
        EXPECT_GT(mesh.header.facts.census.staged, mesh.header.facts.census.inserted);
        this->insert(mesh, model, one);
        model.expect(mesh);
    }
}

TYPED_TEST(ThreadsRemoval, SharesMuchWorkEvenly) {
    // Without the switch for tests: large intervals, then the rest; all points at once, or in
    // batches.
    constexpr int D = TypeParam::value;
    auto points = this->uniform(D == 2 ? 200000 : 80000);
    for (std::size_t i = 0; i < 3000; ++i) points.push_back(points[i * 7]);
    const auto input = this->with_ids(points);
    const auto leave = this->some(input, 0.6);
    MeshOf<D> alone(1);
    this->fill(alone, input);
    std::uint64_t deleted = 0;
    ASSERT_EQ(alone.remove(leave, deleted), ABACUS_OK);
    const auto expected = this->ids(alone);
    for (const std::size_t cache : {ample, ample / 20}) {
        MeshOf<D> mesh(1, cache);
        this->fill(mesh, input);
        mesh.host.set_threads(2, false);
        int most = 0;
        std::uint64_t done = 0, phases = 0;
        mesh.host.on_progress = [&](const abacus_progress &progress) {
            most = std::max(most, threads_now());
            if (progress.phase != ABACUS_PHASE_DELETING) return;
            ++phases;
            EXPECT_GE(progress.done, done);
            EXPECT_LE(progress.done, progress.total);
            done = progress.done;
        };
        std::uint64_t deleted_here = 0;
        ASSERT_EQ(mesh.remove(leave, deleted_here), ABACUS_OK) << mesh.error.detail;
        EXPECT_EQ(deleted_here, deleted);
        EXPECT_EQ(most, threads_at_first + 2);
        EXPECT_GT(phases, 2u);
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        EXPECT_TRUE(this->ids(mesh) == expected);
        EXPECT_EQ(mesh.header.facts.census.duplicates, alone.header.facts.census.duplicates);
        EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
        EXPECT_EQ(mesh.host.bytes, 0u);
    }
}

TYPED_TEST(ThreadsRemoval, EndsCleanlyWhereverTheHostFails) {
    constexpr int D = TypeParam::value;
    auto all = this->with_ids(this->uniform(500));
    for (int i = 0; i < 30; ++i) all.push_back(all[i]), all.back().id += 5000;
    const auto leave = this->some(all, 0.6);
    for (std::uint64_t n = 1, ended = 0; !ended; n += 1 + n / 6) {
        MeshOf<D> mesh(1, little);
        this->fill(mesh, all);
        mesh.host.set_threads(3, true);
        const abacus_header before = mesh.header;
        mesh.host.fail_at(n);
        std::uint64_t deleted = 0;
        const abacus_status status = mesh.remove(leave, deleted);
        ASSERT_TRUE(all_threads_ended());
        ASSERT_EQ(mesh.host.bytes, 0u);
        ASSERT_EQ(mesh.host.violations, std::vector<std::string>{});
        if (status == ABACUS_OK) {
            ended = 1;
            ASSERT_EQ(deleted, leave.size());
        } else {
            ASSERT_EQ(status, ABACUS_HOST_ERROR) << n;
            ASSERT_EQ(mesh.header.facts.census.vertices, before.facts.census.vertices);
        }
    }
}

TYPED_TEST(ThreadsRemoval, EndsCleanlyWhenItIsCancelled) {
    constexpr int D = TypeParam::value;
    const auto all = this->with_ids(this->uniform(3000));
    MeshOf<D> mesh(1, little);
    this->fill(mesh, all);
    mesh.host.set_threads(3, true);
    bool were_at_work = false;
    mesh.host.on_progress = [&](const abacus_progress &) {
        if (threads_now() == threads_at_first) return;
        were_at_work = true;
        mesh.host.cancel();
    };
    std::uint64_t deleted = 0;
    EXPECT_EQ(mesh.remove(this->some(all, 0.7), deleted), ABACUS_HOST_ERROR);
    EXPECT_TRUE(were_at_work);
    EXPECT_TRUE(all_threads_ended());
    EXPECT_EQ(mesh.host.bytes, 0u);
}

TYPED_TEST(ThreadsRemoval, FindsDamagedPages) {
    constexpr int D = TypeParam::value;
    const auto all = this->with_ids(this->uniform(4000));
    MeshOf<D> mesh(1, little);
    this->fill(mesh, all);
    mesh.host.set_threads(3, true);
    auto page =
        std::next(mesh.host.pages.begin(), static_cast<std::ptrdiff_t>(mesh.host.pages.size() / 2));
    page->second.bytes()[page->second.size / 2] ^= 1;
    std::uint64_t deleted = 0;
    EXPECT_EQ(mesh.remove(this->some(all, 0.7), deleted), ABACUS_ERROR);
    EXPECT_EQ(mesh.error.kind, ABACUS_ERROR_CORRUPTED);
    EXPECT_TRUE(all_threads_ended());
    EXPECT_EQ(mesh.host.bytes, 0u);
}

} // namespace
} // namespace abacus::test
