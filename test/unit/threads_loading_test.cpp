// Loading with any number of threads gives the same meshes and the same faults; also with
// boundaries that are held in parts.
#include "support/running_threads.hpp"
#include "support/triangulations.hpp"

#include <gtest/gtest.h>

namespace abacus::test {
namespace {

constexpr std::size_t tiny = 1, ample = 64 << 20;

template <class Dimension> class ThreadsLoading : public testing::Test {
protected:
    static constexpr int D = Dimension::value;

    /// Simplices that have nothing in common, each in a cell of its own: everything is boundary.
    Triangulation<D> scattered(int cells) {
        std::uniform_real_distribution<double> unit(0, 0.2);
        Triangulation<D> t;
        for (int cell = 0; cell < (D == 2 ? cells * cells : cells * cells * cells); ++cell) {
            Ids<D> simplex;
            for (int v = 0; v <= D; ++v) {
                simplex[v] = static_cast<std::int64_t>(t.vertices.size());
                Point<D> p;
                for (int k = 0, rest = cell; k < D; ++k, rest /= cells)
                    p[k] = rest % cells + unit(random) + (v == k + 1 ? 0.7 : 0);
                t.vertices.push_back({simplex[v], p});
            }
            t.simplices.push_back(simplex);
        }
        t.shuffle(5);
        return t;
    }
    /// Adds a simplex from the vertices around a place to a distant point.
    void add_long_one(Triangulation<D> &t, double at) {
        Ids<D> simplex;
        for (int v = 0; v <= D; ++v) {
            simplex[v] = static_cast<std::int64_t>(t.vertices.size());
            Point<D> p;
            for (int k = 0; k < D; ++k) p[k] = at + (v == k + 1 ? 0.05 : 0) + (v == D ? 9 : 0);
            t.vertices.push_back({simplex[v], p});
        }
        t.simplices.push_back(simplex);
    }
    /// The error of a load with this many threads; whatever happens, nothing is left behind.
    std::string said(const Triangulation<D> &t, unsigned threads, std::size_t memory) {
        MeshOf<D> mesh(0);
        mesh.host.set_threads(threads, true);
        const abacus_status status = mesh.load(t.vertices, t.simplices, memory);
        EXPECT_TRUE(all_threads_ended());
        EXPECT_EQ(mesh.host.bytes, 0u);
        EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
        if (status != ABACUS_OK) return std::string(mesh.error.message) + mesh.error.detail;
        EXPECT_TRUE(mesh.host.spools.empty());
        EXPECT_EQ(mesh.header.facts.census.simplices, t.simplices.size());
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        return "";
    }

    std::mt19937_64 random{9};
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(ThreadsLoading, Dimensions);

TYPED_TEST(ThreadsLoading, TakesWhatIsSound) {
    constexpr int D = TypeParam::value;
    auto t = this->scattered(D == 2 ? 40 : 10);
    for (const std::size_t memory : {tiny, ample})
        for (const unsigned threads : {1, 2, 3}) EXPECT_EQ(this->said(t, threads, memory), "");
}

TYPED_TEST(ThreadsLoading, FindsTheSameFaults) {
    constexpr int D = TypeParam::value;
    const auto sound = this->scattered(D == 2 ? 30 : 8);
    for (int round = 0; round < 6; ++round) {
        auto t = sound;
        for (int i = 0; i <= round / 2; ++i)
            this->add_long_one(t, static_cast<double>(this->random() % 700) / 100 - 2);
        t.shuffle(static_cast<unsigned>(round));
        for (const std::size_t memory : {tiny, ample}) {
            const std::string alone = this->said(t, 1, memory);
            EXPECT_EQ(alone.substr(0, 9), "simplices");
            for (const unsigned threads : {2, 7}) EXPECT_EQ(this->said(t, threads, memory), alone);
        }
    }
}

TYPED_TEST(ThreadsLoading, CutsABoundaryAlike) {
    // With some of these memory sizes the boundary only just fits.
    constexpr int D = TypeParam::value;
    auto t = this->scattered(D == 2 ? 20 : 6);
    for (int i = 0; i < 4; ++i) this->add_long_one(t, i);
    t.shuffle(3);
    for (std::size_t memory = 64 << 10; memory < 1 << 20; memory += memory / 10) {
        const std::string alone = this->said(t, 1, memory);
        EXPECT_EQ(alone.substr(0, 9), "simplices");
        EXPECT_EQ(this->said(t, 2, memory), alone) << memory;
    }
}

TYPED_TEST(ThreadsLoading, FindsAFaultWhereverItIs) {
    // A long simplex crosses many others, and an ever smaller one finally none: the parts miss none
    // of them.
    constexpr int D = TypeParam::value;
    const auto sound = this->scattered(D == 2 ? 30 : 8);
    int refused = 0;
    for (int round = 0; round < 40; ++round) {
        auto t = sound;
        auto &moved = t.vertices[this->random() % t.vertices.size()].point;
        for (double &x : moved) x += static_cast<double>(this->random() % 160) / 100 - 0.8;
        const std::string alone = this->said(t, 1, ample);
        refused += !alone.empty();
        EXPECT_EQ(this->said(t, 1, tiny).empty(), alone.empty());
        EXPECT_EQ(this->said(t, 3, tiny).empty(), alone.empty());
    }
    EXPECT_GT(refused, 3);
    EXPECT_LT(refused, 37);
}

TYPED_TEST(ThreadsLoading, EndsCleanlyWhateverFails) {
    constexpr int D = TypeParam::value;
    const auto t = this->scattered(D == 2 ? 20 : 6);
    const auto fails = [&](auto let_fail) {
        MeshOf<D> mesh(0);
        mesh.host.set_threads(3, true);
        let_fail(mesh.host);
        const abacus_status status = mesh.load(t.vertices, t.simplices, tiny);
        EXPECT_TRUE(all_threads_ended());
        EXPECT_EQ(mesh.host.bytes, 0u);
        EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
        return status != ABACUS_OK;
    };
    std::uint64_t n = 1;
    while (fails([&](MemoryHost &host) { host.fail_at(n); })) n += 1 + n / 4;
    EXPECT_GT(n, 20u);
    n = 1;
    while (fails([&](MemoryHost &host) { host.fail_resize_at(n); })) n += 1 + n / 4;
    EXPECT_GT(n, 20u);
    n = 4;
    while (fails([&](MemoryHost &host) { host.limit_threads(n << 10); })) n += 1 + n / 4;
    EXPECT_GT(n, 20u);
    EXPECT_TRUE(fails([](MemoryHost &host) {
        host.on_progress = [&](const abacus_progress &p) {
            if (p.phase == ABACUS_PHASE_CHECKING) host.cancel();
        };
    }));
}

} // namespace
} // namespace abacus::test
