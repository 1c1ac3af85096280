// Several threads check meshes and answer many places as one thread does; and their work ends
// cleanly, whatever fails.
#include "mesh/page_writer.hpp"
#include "support/checked_by_threads.hpp"
#include "support/large_mesh.hpp"
#include "support/located_places.hpp"
#include "support/running_threads.hpp"
#include "support/triangulations.hpp"

#include <abacus/values.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace abacus::test {
namespace {

constexpr std::size_t little = 300 << 10;

template <class Dimension> class ThreadsReading : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(ThreadsReading, Dimensions);

/// All reported answers, as words.
struct Told {
    std::vector<std::uint64_t> words;

    void put(std::int64_t n) { words.push_back(std::bit_cast<std::uint64_t>(n)); }
    void put(double x) { words.push_back(std::bit_cast<std::uint64_t>(x)); }
    bool operator==(const Told &) const = default;
};
template <int D>
abacus_host_status keep_simplex(void *to, std::int64_t id, const abacus_simplex *s,
                                const double *) {
    auto &told = *static_cast<Told *>(to);
    told.put(id);
    told.put(std::int64_t{s != nullptr});
    for (int i = 0; s != nullptr && i <= D; ++i) {
        told.put(s->id[i]);
        for (int axis = 0; axis < D; ++axis) told.put(s->corner[i][axis]);
    }
    return ABACUS_HOST_OK;
}
abacus_host_status keep_value(void *to, std::int64_t id, const double *values) {
    auto &told = *static_cast<Told *>(to);
    told.put(id);
    if (values != nullptr) told.put(values[0]);
    return ABACUS_HOST_OK;
}
abacus_host_status keep_weights(void *to, std::int64_t id, const abacus_weight *weights,
                                std::size_t n) {
    auto &told = *static_cast<Told *>(to);
    told.put(id);
    for (std::size_t i = 0; i < n; ++i) {
        told.put(weights[i].vertex);
        told.put(weights[i].weight);
    }
    return ABACUS_HOST_OK;
}
abacus_host_status keep_vertex(void *to, std::int64_t id, std::uint64_t rank,
                               const abacus_vertex *vertex, double distance) {
    auto &told = *static_cast<Told *>(to);
    told.put(id);
    told.put(static_cast<std::int64_t>(rank));
    told.put(vertex->id);
    told.put(vertex->attributes[0]);
    told.put(distance);
    return ABACUS_HOST_OK;
}

enum class Asked { simplex, linear, natural, value_of_nearest, weights, nearest };
constexpr std::array all_questions{Asked::simplex,          Asked::linear,  Asked::natural,
                                   Asked::value_of_nearest, Asked::weights, Asked::nearest};

template <int D>
abacus_status ask(MeshOf<D> &mesh, Asked asked, const std::vector<InputOf<D>> &places, Told &told,
                  std::uint64_t k = 3) {
    abacus_interpolation how{};
    how.attributes = 1;
    how.extent = {};
    std::vector<std::uint64_t> records;
    for (const InputOf<D> &place : places) {
        records.push_back(std::bit_cast<std::uint64_t>(place.id));
        for (const double x : place.point) records.push_back(std::bit_cast<std::uint64_t>(x));
    }
    abacus_places *handle = nullptr;
    abacus_status status = abacus_places_open(mesh.host.table(), &mesh.header.facts, 1 << 20,
                                              mesh.cache_bytes, &handle, &mesh.error);
    if (status == ABACUS_OK)
        status = abacus_places_add(handle, records.data(), places.size(), &mesh.error);
    if (status != ABACUS_OK) {
        abacus_places_close(handle);
        return status;
    }
    switch (asked) {
    case Asked::simplex:
        status = abacus_places_locate(handle, keep_simplex<D>, &told, &mesh.error);
        break;
    case Asked::linear:
    case Asked::natural:
    case Asked::value_of_nearest:
        how.method = asked == Asked::linear    ? ABACUS_LINEAR
                     : asked == Asked::natural ? ABACUS_NATURAL
                                               : ABACUS_NEAREST;
        status = abacus_places_interpolate(handle, &how, keep_value, &told, &mesh.error);
        break;
    case Asked::weights:
        how.method = ABACUS_NATURAL;
        status = abacus_places_weigh(handle, &how, keep_weights, &told, &mesh.error);
        break;
    case Asked::nearest:
        status = abacus_places_nearest(handle, k, keep_vertex, &told, &mesh.error);
        break;
    }
    abacus_places_close(handle);
    return status;
}

template <int D> std::vector<InputOf<D>> places_in(Large<D> &mesh, int n) {
    std::vector<InputOf<D>> places;
    for (int i = 0; i < n; ++i) places.push_back({i / 2, mesh.place(i)});
    Point<D> far;
    far.fill(-1e300);
    places.push_back({7, far});
    return places;
}

/// How many threads besides the first were seen at work, and reported.
template <int D> struct Watched {
    explicit Watched(MeshOf<D> &mesh) : mesh_(mesh) {
        mesh.host.on_progress = [this](const abacus_progress &progress) {
            seen = std::max(seen, threads_now() - threads_at_first);
            told = std::max(told, static_cast<int>(progress.threads));
        };
    }
    ~Watched() { mesh_.host.on_progress = nullptr; }

    int seen = 0, told = 0;

private:
    MeshOf<D> &mesh_;
};

// ---- The same answers --------------------------------------------------------------------

TYPED_TEST(ThreadsReading, AnswerAsOneDoes) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 6000 : 1500, 1);
    const auto places = places_in(mesh, 700);
    const std::size_t bytes = mesh.host.bytes;
    for (const std::size_t cache : {little, ample})
        for (const Asked asked : all_questions) {
            mesh.cache_bytes = cache;
            mesh.host.set_threads(1, false);
            Told alone;
            ASSERT_EQ(ask<D>(mesh, asked, places, alone), ABACUS_OK) << mesh.error.message;
            for (const unsigned threads : {2, 3, 4, 7}) {
                mesh.host.set_threads(threads, true);
                Told together;
                ASSERT_EQ(ask<D>(mesh, asked, places, together), ABACUS_OK) << mesh.error.message;
                EXPECT_TRUE(together == alone) << threads << " threads, " << int(asked);
                EXPECT_TRUE(all_threads_ended());
                EXPECT_EQ(mesh.host.bytes, bytes);
            }
        }
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
}

TYPED_TEST(ThreadsReading, ShareManyPlaces) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 40000 : 8000, 1);
    const auto places = places_in(mesh, 40000); // several times as many as are gathered at once
    mesh.cache_bytes = 8 << 20;
    for (const Asked asked : {Asked::simplex, Asked::nearest}) {
        mesh.host.set_threads(1, false);
        Told alone, together;
        ASSERT_EQ(ask<D>(mesh, asked, places, alone), ABACUS_OK);
        mesh.host.set_threads(2, false);
        const Watched<D> watched(mesh);
        ASSERT_EQ(ask<D>(mesh, asked, places, together), ABACUS_OK);
        EXPECT_TRUE(together == alone);
        EXPECT_EQ(watched.seen, 2);
        EXPECT_EQ(watched.told, 2);
        EXPECT_EQ(mesh.host.last_progress.done, places.size());
        EXPECT_EQ(mesh.host.last_progress.total, places.size());
    }
    // Few places, or long answers, are left to one thread.
    const Watched<D> watched(mesh);
    Told few;
    ASSERT_EQ(ask<D>(mesh, Asked::simplex, places_in(mesh, 3000), few), ABACUS_OK);
    mesh.cache_bytes = little;
    ASSERT_EQ(ask<D>(mesh, Asked::nearest, places_in(mesh, 3000), few, 50), ABACUS_OK);
    EXPECT_EQ(watched.seen, 0);
}

/// A hub among many vertices on a circle: a place near it has all of them as natural neighbours.
TEST(ThreadsReading, TellAnswersThatAreLongerThanExpected) {
    std::vector<Input> input{{-1, {0, 0}, {0}}};
    for (int i = 0; i < 600; ++i)
        input.push_back({i, {std::cos(i * 0.0104719), std::sin(i * 0.0104719)}, {1}});
    Mesh mesh(1);
    ASSERT_EQ(mesh.insert(input), ABACUS_OK);
    std::vector<Input> places;
    for (int i = 0; i < 300; ++i) places.push_back({i, {1e-3 * (i % 17), 1e-3 * (i % 13)}});
    Told alone;
    ASSERT_EQ(ask<2>(mesh, Asked::weights, places, alone), ABACUS_OK);
    ASSERT_GT(alone.words.size(), 100 * places.size());
    for (const unsigned threads : {2, 7}) {
        mesh.host.set_threads(threads, true);
        Told together;
        ASSERT_EQ(ask<2>(mesh, Asked::weights, places, together), ABACUS_OK) << mesh.error.message;
        EXPECT_TRUE(together == alone);
    }
    EXPECT_TRUE(all_threads_ended());
}

TYPED_TEST(ThreadsReading, ReadMeshesThatAreNotDelaunay) {
    constexpr int D = TypeParam::value;
    Random random(3);
    std::vector<Point<D>> points;
    for (int i = 0; i < (D == 2 ? 800 : 300); ++i) points.push_back(unit_point<D>(random));
    const auto t = keeping<D>(delaunay<D>(points), [](const auto &c) {
        return std::abs(c[0] - 0.5) + std::abs(c[1] - 0.5) > 0.2; // a hole
    });
    MeshOf<D> mesh(0, std::size_t{60} << 10);
    ASSERT_EQ(mesh.load(t.vertices, t.simplices), ABACUS_OK) << mesh.error.detail;
    std::vector<InputOf<D>> places;
    for (int i = 0; i < 1000; ++i) places.push_back({i, unit_point<D>(random)});
    Told alone, together, natural;
    ASSERT_EQ(ask<D>(mesh, Asked::simplex, places, alone), ABACUS_OK);
    EXPECT_TRUE(faults_of(mesh).empty());
    expect_same_faults_by_threads(mesh);
    mesh.host.set_threads(3, true);
    ASSERT_EQ(ask<D>(mesh, Asked::simplex, places, together), ABACUS_OK);
    EXPECT_TRUE(together == alone);
    EXPECT_EQ(ask<D>(mesh, Asked::natural, places, natural), ABACUS_ERROR);
    EXPECT_EQ(mesh.error.kind, ABACUS_ERROR_STATE);
    EXPECT_TRUE(natural.words.empty());

    // A vertex with two ids, in pages that perhaps share no facet.
    auto *page =
        &std::next(mesh.host.pages.begin(), static_cast<std::ptrdiff_t>(mesh.host.pages.size() / 2))
             ->second;
    page->bytes()[page->size / 2] ^= 4;
    expect_same_faults_by_threads(mesh);
    EXPECT_TRUE(all_threads_ended());
}

TYPED_TEST(ThreadsReading, CheckLargeMeshes) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 60000 : 20000, 1);
    mesh.host.set_threads(3, false);
    {
        const Watched<D> watched(mesh);
        EXPECT_TRUE(mesh.check().empty());
        EXPECT_EQ(watched.seen, 3);
        EXPECT_EQ(watched.told, 3);
    }
    mesh.header.facts.census.vertices += 1; // found from the sum over all threads
    const auto together = faults_of(mesh);
    EXPECT_FALSE(together.empty());
    mesh.host.set_threads(1, false);
    EXPECT_EQ(faults_of(mesh), together);
    EXPECT_TRUE(all_threads_ended());
}

TYPED_TEST(ThreadsReading, FindTheSameFaultsInDamagedMeshes) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 12000 : 3000, 1);
    const auto sound = mesh.host.pages;
    ASSERT_GT(sound.size(), 20u);
    const auto header = mesh.header;
    for (const std::size_t cache : {little, ample})
        for (int trial = 0; trial < 15; ++trial) {
            mesh.cache_bytes = cache;
            mesh.host.pages = sound;
            mesh.header = header;
            auto page = std::next(mesh.host.pages.begin(),
                                  static_cast<std::ptrdiff_t>(mesh.random() % sound.size()));
            switch (trial % 5) {
            case 0:
                mesh.host.pages.erase(page);
                break;
            case 1:
                ++mesh.header.facts.census.simplices;
                break;
            default: // a bit; the checksum is right except in the last kind
                page->second.bytes()[mesh.random() % page->second.size] ^= 1 << mesh.random() % 8;
                if (trial % 5 != 4) seal_page(page->second.bytes(), page->second.size);
            }
            expect_same_faults_by_threads<D>(mesh);
        }
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
    EXPECT_TRUE(all_threads_ended());
}

// ---- A clean end -------------------------------------------------------------------------

/// Calls end(n) for increasing n, until work() is done.
template <class End, class Work> int until_done(int first, int grows_by, End end, Work work) {
    int failures = 0;
    for (int n = first;; n += 1 + n / grows_by, ++failures) {
        end(n);
        if (work() == ABACUS_OK) return failures;
    }
}

TYPED_TEST(ThreadsReading, EndCleanlyWhereverTheHostFails) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 1500 : 400, 1);
    const auto places = places_in(mesh, 200);
    mesh.cache_bytes = little;
    mesh.host.set_threads(3, true);
    const std::size_t bytes = mesh.host.bytes;
    const auto expect_clean = [&](abacus_status status) {
        EXPECT_TRUE(status == ABACUS_OK || status == ABACUS_HOST_ERROR) << mesh.error.message;
        EXPECT_TRUE(all_threads_ended());
        EXPECT_EQ(mesh.host.bytes, bytes);
        return status;
    };
    const auto fail = [&](int n) {
        mesh.host.recover();
        mesh.host.fail_at(static_cast<std::uint64_t>(n));
    };
    EXPECT_GT(until_done(1, 8, fail,
                         [&] {
                             Told told;
                             return expect_clean(ask<D>(mesh, Asked::nearest, places, told));
                         }),
              8);
    EXPECT_GT(until_done(1, 8, fail,
                         [&] {
                             abacus_check *check = nullptr;
                             const auto status =
                                 abacus_check_open(mesh.host.table(), &mesh.header.facts,
                                                   mesh.cache_bytes, 10, &check, &mesh.error);
                             abacus_check_close(check);
                             return expect_clean(status);
                         }),
              8);
    mesh.host.recover();
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
}

/// Memory of threads, and of the session.
TYPED_TEST(ThreadsReading, EndCleanlyWhenMemoryRunsOut) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 1500 : 400, 1);
    const auto places = places_in(mesh, 200);
    mesh.cache_bytes = little;
    mesh.host.set_threads(3, true);
    const std::size_t bytes = mesh.host.bytes;
    const auto expect_clean = [&](abacus_status status) {
        if (status != ABACUS_OK) {
            EXPECT_EQ(status, ABACUS_ERROR);
            EXPECT_EQ(mesh.error.kind, ABACUS_ERROR_MEMORY) << mesh.error.message;
        }
        EXPECT_TRUE(all_threads_ended());
        EXPECT_EQ(mesh.host.bytes, bytes);
        return status;
    };
    const auto threads_have = [&](int n) { mesh.host.limit_threads(std::size_t(n) << 10); };
    const auto session_has = [&](int n) {
        mesh.host.limit_threads(0);
        mesh.host.fail_resize_at(static_cast<std::uint64_t>(n));
    };
    const auto locate = [&] {
        Told told;
        return expect_clean(ask<D>(mesh, Asked::natural, places, told));
    };
    const auto check = [&] {
        abacus_check *check = nullptr;
        const auto status = abacus_check_open(mesh.host.table(), &mesh.header.facts,
                                              mesh.cache_bytes, 10, &check, &mesh.error);
        abacus_check_close(check);
        return expect_clean(status);
    };
    EXPECT_GT(until_done(4, 4, threads_have, check), 5);
    EXPECT_GT(until_done(1, 8, session_has, check), 3);
    EXPECT_GT(until_done(4, 4, threads_have, locate), 5);
    EXPECT_GT(until_done(1, 8, session_has, locate), 3);
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
}

TYPED_TEST(ThreadsReading, EndCleanlyWhenTheyAreCancelled) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 60000 : 20000, 1);
    const auto places = places_in(mesh, 40000);
    const std::size_t bytes = mesh.host.bytes;
    mesh.cache_bytes = 8 << 20;
    mesh.host.set_threads(3, false);
    bool were_at_work = false;
    const auto cancel_once_at_work = [&] {
        mesh.host.recover();
        were_at_work = false;
        mesh.host.on_progress = [&](const abacus_progress &) {
            if (threads_now() == threads_at_first) return;
            were_at_work = true;
            mesh.host.cancel();
        };
    };
    cancel_once_at_work();
    Told told;
    EXPECT_EQ(ask<D>(mesh, Asked::simplex, places, told), ABACUS_HOST_ERROR);
    EXPECT_TRUE(were_at_work);
    EXPECT_TRUE(all_threads_ended());
    EXPECT_EQ(mesh.host.bytes, bytes);
    cancel_once_at_work();
    abacus_check *check = nullptr;
    EXPECT_EQ(abacus_check_open(mesh.host.table(), &mesh.header.facts, mesh.cache_bytes, 10, &check,
                                &mesh.error),
              ABACUS_HOST_ERROR);
    EXPECT_TRUE(were_at_work);
    EXPECT_TRUE(all_threads_ended());
    EXPECT_EQ(mesh.host.bytes, bytes);
}

TYPED_TEST(ThreadsReading, RaiseTheFirstErrorAlongTheCurve) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 20000 : 4000, 1);
    const auto places = places_in(mesh, 2000);
    Told sound;
    ASSERT_EQ(ask<D>(mesh, Asked::simplex, places, sound), ABACUS_OK);
    int n = 0;
    for (auto &[key, page] : mesh.host.pages)
        if (++n % 7 == 5) page.bytes()[page.size / 2] ^= 1;
    for (const unsigned threads : {2, 7}) {
        mesh.host.set_threads(threads, true);
        Told told;
        EXPECT_EQ(ask<D>(mesh, Asked::simplex, places, told), ABACUS_ERROR);
        EXPECT_EQ(mesh.error.kind, ABACUS_ERROR_CORRUPTED);
        EXPECT_LT(told.words.size(), sound.words.size());
        EXPECT_TRUE(std::equal(told.words.begin(), told.words.end(), sound.words.begin()));
        EXPECT_TRUE(all_threads_ended());
    }
}

/// A sanitizer would see leaks.
TEST(ThreadsReading, ManyAbortedBuildsLeaveNothing) {
    constexpr int builds = 300;
    Random random(5);
    std::vector<Input> input;
    for (int i = 0; i < 150; ++i) input.push_back({i, unit_point<2>(random)});
    int failed = 0;
    for (int n = 0; n < builds; ++n) {
        Mesh mesh(0, little);
        mesh.host.set_threads(2 + n % 3, true);
        if (n % 2 == 0)
            mesh.host.fail_at(1 + random() % 60);
        else
            mesh.host.limit_threads(1 + random() % (1 << 20));
        failed += mesh.insert(input) != ABACUS_OK;
        ASSERT_EQ(mesh.host.bytes, 0u);
    }
    EXPECT_GT(failed, builds / 3);
    EXPECT_TRUE(all_threads_ended());
}

} // namespace
} // namespace abacus::test
