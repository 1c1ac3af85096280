// Points come and go, in any number at a time: the mesh is always that of the present points.
#include "support/point_model.hpp"
#include "support/sanitized.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

namespace abacus::test {
namespace {

using Random = std::mt19937_64;

template <class Dimension> class Edit : public testing::Test {
protected:
    static constexpr int D = Dimension::value;

    /// A point of a kind: 0 uniform, 1 a coarse grid, 2 few places, 3 on a line or plane.
    Point<D> point(int kind) {
        Point<D> p;
        for (double &x : p) {
            switch (kind) {
            case 0:
                x = std::uniform_real_distribution<double>(0, 1)(random);
                break;
            case 1:
                x = double(random() % 12);
                break;
            default:
                x = double(random() % 3);
            }
        }
        if (kind == 3) p[D - 1] = 2 * p[0] + 1;
        return p;
    }
    std::vector<InputOf<D>> fresh(std::size_t n, int kind) {
        std::vector<InputOf<D>> points;
        for (std::size_t i = 0; i < n; ++i, ++next_id)
            points.push_back({next_id, point(kind), {double(next_id) / 4}});
        return points;
    }
    /// Some of the present points, a few of them under another id or twice.
    std::vector<InputOf<D>> some(const PointModel<D> &model, std::size_t n) {
        std::vector<InputOf<D>> all = model.points();
        std::shuffle(all.begin(), all.end(), random);
        all.resize(std::min(n, all.size()));
        for (InputOf<D> &p : all)
            if (random() % 16 == 0) p.id = -1;
        return all;
    }

    Random random{11};
    std::int64_t next_id = 0;
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Edit, Dimensions);

TYPED_TEST(Edit, KeepsTheMeshOfThePointsThereAre) {
    constexpr int D = TypeParam::value;
    const std::size_t sizes[] = {1, 1, 2, 10, 100, 400};
    for (const int kind : {0, 1, 2, 3})
        for (const std::size_t cache_bytes : {std::size_t(40) << 10, std::size_t(1) << 20}) {
            SCOPED_TRACE(kind);
            MeshOf<D> mesh(1, cache_bytes);
            PointModel<D> model;
            for (int step = 0; step < (sanitized ? 20 : 60); ++step) {
                const std::size_t n = sizes[this->random() % std::size(sizes)];
                const int now = this->random() % 8 == 0 ? 0 : kind;
                switch (this->random() % 5) {
                case 0:
                case 1: {
                    const auto points = this->fresh(n, now);
                    model.insert(points);
                    ASSERT_EQ(mesh.insert(points), ABACUS_OK) << mesh.error.detail;
                    break;
                }
                case 2: { // waits until the next change
                    const auto points = this->fresh(n, now);
                    model.stage(points);
                    ASSERT_EQ(mesh.stage(points), ABACUS_OK) << mesh.error.detail;
                    break;
                }
                default: {
                    auto points = this->some(model, step % 20 == 19 ? ~std::size_t(0) : n);
                    points.push_back({0, this->point(0), {0.}}); // nearly always not there
                    // With the same id and place only one order is defined: that of the rows.
                    std::uint64_t deleted = 0;
                    const std::uint64_t expected = model.remove(points);
                    ASSERT_EQ(mesh.remove(points, deleted), ABACUS_OK) << mesh.error.detail;
                    ASSERT_EQ(deleted, expected);
                }
                }
                model.expect(mesh);
                if (this->HasFatalFailure()) return;
            }
        }
}

TYPED_TEST(Edit, PutsPointsInThePlaceOfOthers) {
    // Beside points that stay, that wait, and that go; also when all are on a line or plane.
    constexpr int D = TypeParam::value;
    const std::size_t sizes[] = {1, 2, 10, 100, D == 2 ? 3000 : 1000};
    int refused = 0, taken = 0;
    for (const int kind : {0, 1, 2, 3, 4})
        for (const std::size_t cache_bytes : {std::size_t(40) << 10, std::size_t(1) << 20}) {
            SCOPED_TRACE(kind);
            MeshOf<D> mesh(1, cache_bytes);
            PointModel<D> model;
            const std::size_t memory = cache_bytes == 1 << 20 ? 16 << 20 : 64 << 10;
            for (int step = 0; step < (sanitized ? 15 : 40); ++step) {
                const std::size_t n = sizes[this->random() % (step % 10 == 0 ? 5 : 4)];
                auto points = this->fresh(n, kind == 4 ? 1 : kind);
                if (kind == 4) // many on a line or plane
                    for (auto &p : points) p.point[D - 1] = 2 * (p.point[0] += double(p.id % 600));
                switch (this->random() % 6) {
                case 0:
                    model.insert(points);
                    ASSERT_EQ(mesh.insert(points, memory), ABACUS_OK) << mesh.error.detail;
                    break;
                case 1:
                    model.stage(points);
                    ASSERT_EQ(mesh.stage(points), ABACUS_OK) << mesh.error.detail;
                    break;
                case 2: {
                    auto gone = this->some(model, n);
                    std::uint64_t deleted = 0;
                    const std::uint64_t expected = model.remove(gone);
                    ASSERT_EQ(mesh.remove(gone, deleted), ABACUS_OK) << mesh.error.detail;
                    ASSERT_EQ(deleted, expected);
                    break;
                }
                case 3: {
                    if (this->random() % 2 == 0) points = this->fresh(2, 0);
                    MeshOf<D> tried(1, cache_bytes);
                    tried.host.restore(mesh.host);
                    tried.header = mesh.header;
                    if (model.are_apart(points)) {
                        ++taken;
                        model.insert(points);
                        ASSERT_EQ(mesh.insert(points, memory, ABACUS_REFUSE), ABACUS_OK)
                            << mesh.error.message;
                    } else {
                        ++refused;
                        ASSERT_EQ(tried.insert(points, memory, ABACUS_REFUSE), ABACUS_ERROR);
                        ASSERT_EQ(tried.error.kind, ABACUS_ERROR_DUPLICATE);
                        ASSERT_EQ(tried.host.bytes, 0u);
                    }
                    break;
                }
                default:
                    model.replace(points);
                    ASSERT_EQ(mesh.insert(points, memory, ABACUS_REPLACE), ABACUS_OK)
                        << mesh.error.detail;
                }
                model.expect(mesh);
                if (this->HasFatalFailure()) return;
            }
        }
    EXPECT_GT(refused, 0);
    EXPECT_GT(taken, 0);
}

TYPED_TEST(Edit, CollapsesAndGrowsAgain) {
    // Many points in a plane or on a line, and one beside it that comes and goes.
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(1, 40 << 10);
    PointModel<D> model;
    std::vector<InputOf<D>> flat;
    for (int i = 0; i < 900; ++i) {
        Point<D> p{};
        p[0] = i % 30;
        p[1] = D == 3 ? i / 30 : 2 * p[0];
        flat.push_back({this->next_id++, p, {0.5 * i}});
    }
    model.insert(flat);
    ASSERT_EQ(mesh.insert(flat), ABACUS_OK);
    EXPECT_EQ(mesh.header.facts.census.vertices, 0u);
    Point<D> apex{};
    apex[D - 1] = 77;
    for (int round = 0; round < 3; ++round) {
        const std::vector<InputOf<D>> beside = {{this->next_id++, apex, {1.}}};
        model.insert(beside);
        ASSERT_EQ(mesh.insert(beside), ABACUS_OK);
        EXPECT_GT(mesh.header.facts.census.vertices, 0u);
        model.expect(mesh);
        // Alone, then with some of the others before and after it.
        auto gone = beside;
        if (round > 0) {
            const auto more = this->some(model, 100);
            gone.insert(gone.end(), more.begin(), more.end());
        }
        std::uint64_t deleted = 0;
        const std::uint64_t expected = model.remove(gone);
        ASSERT_EQ(mesh.remove(gone, deleted), ABACUS_OK) << mesh.error.detail;
        EXPECT_EQ(deleted, expected);
        EXPECT_EQ(mesh.header.facts.census.vertices, 0u);
        EXPECT_TRUE(mesh.host.pages.empty());
        model.expect(mesh);
    }
}

TYPED_TEST(Edit, ExactlyTakesNoOtherPointOfThePlace) {
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh(1);
    std::uint64_t deleted;
    const auto taken = [&](const InputOf<D> &point) {
        EXPECT_EQ(mesh.remove({point}, deleted, 16 << 20, true), ABACUS_OK);
        return deleted;
    };
    const auto like = [](const InputOf<D> &point, std::int64_t id, double attribute) {
        return InputOf<D>{id, point.point, {attribute}};
    };
    // while it waits
    auto points = this->fresh(1, 0);
    ASSERT_EQ(mesh.insert(points), ABACUS_OK);
    EXPECT_EQ(taken(like(points[0], -1, points[0].attributes[0])), 0u);
    EXPECT_EQ(taken(like(points[0], points[0].id, -7)), 0u);
    EXPECT_EQ(taken(points[0]), 1u);
    // as a vertex, alone or with others at its place
    points = this->fresh(50, 0);
    const InputOf<D> first = points[0], alone = points[1], zero = like(first, 1000, -0.0),
                     none = like(first, 1001, NAN), twin = like(first, 1001, 5);
    points.insert(points.end(), {zero, none, twin});
    ASSERT_EQ(mesh.insert(points), ABACUS_OK);
    EXPECT_EQ(taken(like(alone, -1, alone.attributes[0])), 0u);
    EXPECT_EQ(taken(like(alone, alone.id, 0)), 0u);
    EXPECT_EQ(taken(like(first, -1, first.attributes[0])), 0u);
    EXPECT_EQ(taken(like(first, 1001, 0)), 0u);
    EXPECT_EQ(mesh.header.facts.census.vertices, 50u);
    EXPECT_EQ(mesh.header.facts.census.duplicates, 3u);
    EXPECT_EQ(taken(alone), 1u);
    EXPECT_EQ(taken(twin), 1u);
    EXPECT_EQ(taken(twin), 0u);
    EXPECT_EQ(taken(first), 1u);
    EXPECT_EQ(taken(first), 0u);
    EXPECT_EQ(taken(like(none, 1001, -NAN)), 1u);
    EXPECT_EQ(taken(like(zero, 1000, 0.0)), 1u);
    EXPECT_EQ(mesh.header.facts.census.vertices, 48u);
    EXPECT_EQ(mesh.check(), std::vector<std::string>{});
}

TYPED_TEST(Edit, TakesWaitingPointsOfOnePlaceInLinearTime) {
    // Quadratic time would take a minute.
    constexpr int D = TypeParam::value;
    constexpr int n = 200000;
    MeshOf<D> mesh;
    std::vector<InputOf<D>> points(n), others;
    for (int i = 0; i < n; ++i) points[i].id = i;
    ASSERT_EQ(mesh.insert(points), ABACUS_OK);
    ASSERT_EQ(mesh.header.facts.census.staged - mesh.header.facts.census.inserted,
              std::uint64_t(n));
    for (int i = 0; i < n / 2; ++i) others.push_back({i % 2 ? i : -i, {}});
    std::uint64_t deleted;
    ASSERT_EQ(mesh.remove(others, deleted, 16 << 20, true), ABACUS_OK);
    EXPECT_EQ(deleted, n / 4 + 1); // 0 as well
    ASSERT_EQ(mesh.remove(others, deleted), ABACUS_OK);
    EXPECT_EQ(deleted, n / 2);
    EXPECT_EQ(mesh.header.facts.census.staged - mesh.header.facts.census.inserted,
              n - deleted - n / 4 - 1);
    EXPECT_EQ(mesh.check(), std::vector<std::string>{});
}

TYPED_TEST(Edit, RefusesDamagedRepeatedPoints) {
    constexpr int D = TypeParam::value;
    MeshOf<D> sound(1);
    const auto points = this->fresh(20, 0);
    ASSERT_EQ(sound.insert(points), ABACUS_OK);
    std::vector<InputOf<D>> repeated;
    for (int i = 0; i < 1000; ++i) repeated.push_back({1000 + i, points[0].point, {0.5}});
    ASSERT_EQ(sound.insert(repeated), ABACUS_OK);
    ASSERT_GT(sound.host.repeated_pages.size(), 2u);
    const auto expect_refused = [&](const auto &damage) {
        MeshOf<D> mesh(1);
        mesh.host.restore(sound.host);
        mesh.header = sound.header;
        damage(mesh);
        std::uint64_t deleted;
        EXPECT_EQ(mesh.remove(repeated, deleted), ABACUS_ERROR);
        EXPECT_EQ(mesh.error.kind, ABACUS_ERROR_CORRUPTED);
        EXPECT_EQ(mesh.host.bytes, 0u);
    };
    // A page begins before the last points of the previous one.
    expect_refused([](MeshOf<D> &mesh) {
        auto second = mesh.host.repeated_pages.extract(std::next(mesh.host.repeated_pages.begin()));
        second.key().part -= 5;
        mesh.host.repeated_pages.insert(std::move(second));
    });
    // There are more than counted.
    expect_refused([](MeshOf<D> &mesh) { mesh.header.facts.census.duplicates = 7; });
}

TYPED_TEST(Edit, ClearsAllPages) {
    // Vertices, repeated points and points that wait; then only the last.
    constexpr int D = TypeParam::value;
    for (const int kind : {0, 1, 2, 3}) {
        MeshOf<D> mesh(1, 40 << 10);
        PointModel<D> model;
        for (int round = 0; round < 2; ++round) {
            const auto points = this->fresh(3000, kind);
            ASSERT_EQ(mesh.insert(points), ABACUS_OK);
            const auto waiting = this->fresh(700, kind);
            ASSERT_EQ(mesh.stage(waiting), ABACUS_OK);
            std::uint64_t deleted = 0;
            const auto clear = [&](abacus_build *build) {
                return abacus_build_clear(build, &mesh.header, &deleted, &mesh.error);
            };
            ASSERT_EQ(mesh.with_build(clear), ABACUS_OK) << mesh.error.detail;
            EXPECT_EQ(deleted, 3700u);
            EXPECT_TRUE(mesh.host.pages.empty() && mesh.host.staged_pages.empty() &&
                        mesh.host.repeated_pages.empty());
            ASSERT_EQ(mesh.with_build(clear), ABACUS_OK); // nothing is left to clear
            EXPECT_EQ(deleted, 0u);
            model.expect(mesh);
        }
        const auto points = this->fresh(100, 0);
        model.insert(points);
        ASSERT_EQ(mesh.insert(points), ABACUS_OK);
        model.expect(mesh);
    }
}

TYPED_TEST(Edit, FewPointsAtATimeLeavePagesFilled) {
    // A tenth of the points goes, and as many others come, some at a time.
    constexpr int D = TypeParam::value;
    for (const int some : {1, 40}) {
        MeshOf<D> mesh(1, 1 << 20);
        PointModel<D> model;
        auto points = this->fresh(D == 2 ? 12000 : 3000, 0);
        model.insert(points);
        ASSERT_EQ(mesh.insert(points), ABACUS_OK);
        const std::size_t pages = mesh.host.pages.size();
        for (int changed = 0; changed < int(points.size()) / 10; changed += some) {
            for (int i = 0; i < some; ++i)
                std::swap(points[i], points[this->random() % points.size()]);
            const std::vector<InputOf<D>> gone(points.begin(), points.begin() + some);
            const auto come = this->fresh(some, 0);
            std::copy(come.begin(), come.end(), points.begin());
            model.remove(gone);
            model.insert(come);
            std::uint64_t deleted = 0;
            ASSERT_EQ(mesh.remove(gone, deleted), ABACUS_OK) << mesh.error.detail;
            ASSERT_EQ(mesh.insert(come), ABACUS_OK) << mesh.error.detail;
        }
        model.expect(mesh);
        EXPECT_LE(mesh.host.pages.size(), pages * 1.4) << pages;
    }
}

TYPED_TEST(Edit, EveryHostCallMayFail) {
    constexpr int D = TypeParam::value;
    MeshOf<D> sound(1, 40 << 10);
    PointModel<D> model;
    for (const int kind : {0, 1}) {
        const auto points = this->fresh(300, kind);
        model.insert(points);
        ASSERT_EQ(sound.insert(points), ABACUS_OK);
    }
    const auto all = model.points();
    std::vector<InputOf<D>> flat = all; // and the same number of points that span nothing
    for (auto &p : flat) p.point[D - 1] = p.point[0];
    MeshOf<D> waiting(1, 40 << 10);
    ASSERT_EQ(waiting.insert(flat), ABACUS_OK);
    const auto replace = [](MeshOf<D> &mesh, const std::vector<InputOf<D>> &points) {
        return mesh.insert(points, 16 << 10, ABACUS_REPLACE);
    };
    const auto remove = [](MeshOf<D> &mesh, const std::vector<InputOf<D>> &points) {
        std::uint64_t deleted = 0;
        return mesh.remove(points, deleted);
    };
    const auto expect_undone = [](MeshOf<D> &before, auto change,
                                  const std::vector<InputOf<D>> &points) {
        bool done = false;
        for (std::uint64_t n = 1; !done; n += 1 + n / 8) {
            MeshOf<D> mesh(1, 40 << 10);
            mesh.host.restore(before.host);
            mesh.header = before.header;
            mesh.host.on_progress = [&](const abacus_progress &) { mesh.host.interrupted = 1; };
            mesh.host.fail_at(n);
            const abacus_status status = change(mesh, points);
            done = !mesh.host.failed;
            ASSERT_EQ(status, done ? ABACUS_OK : ABACUS_HOST_ERROR);
            ASSERT_EQ(mesh.host.bytes, 0u);
            ASSERT_EQ(mesh.host.violations, std::vector<std::string>{});
            ASSERT_EQ(std::memcmp(&mesh.header, &before.header, sizeof before.header) == 0, !done);
        }
    };
    expect_undone(sound, remove, all); // it collapses on the way
    expect_undone(sound, replace, all);
    expect_undone(waiting, replace, flat);
}

} // namespace
} // namespace abacus::test
