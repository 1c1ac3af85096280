// Changes report the same with any number of threads.
#include "support/returned.hpp"
#include "support/threads.hpp"

namespace abacus::test {
namespace {

template <class Dimension> class ThreadsReturning : public ThreadsTest<Dimension> {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(ThreadsReturning, Dimensions);

TYPED_TEST(ThreadsReturning, IsTheDifferenceOfBeforeAndAfter) {
    constexpr int D = TypeParam::value;
    const auto points = this->with_ids(this->uniform(1000)),
               more = this->with_ids(this->uniform(300));
    auto others = points; // at the same places
    others.resize(50);
    for (auto &p : others) p.id = this->next_id++;
    for (const unsigned threads : {2, 3, 7}) {
        MeshOf<D> mesh(1, little);
        mesh.host.set_threads(threads, true);
        Returned<D> returned(mesh, 1 << 20);
        returned.insert(points);
        returned.insert(more);
        returned.insert(others, ABACUS_REPLACE);
        returned.remove(points);
        EXPECT_TRUE(all_threads_ended());
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
    }
}

TYPED_TEST(ThreadsReturning, OfMuchWorkSharedEvenly) {
    // Logs of normal size, in which most changes cancel out.
    constexpr int D = TypeParam::value;
    const auto points = this->with_ids(this->uniform(D == 2 ? 150000 : 60000));
    MeshOf<D> mesh(1);
    mesh.host.set_threads(2, false);
    Returned<D> returned(mesh, 2 << 20);
    returned.insert(points);
    EXPECT_EQ(returned.rows.size(), mesh.header.facts.census.simplices);
    EXPECT_GT(mesh.header.counters.passes, 0u);
}

TYPED_TEST(ThreadsReturning, EndsWellWhateverFails) {
    constexpr int D = TypeParam::value;
    const auto points = this->with_ids(this->uniform(500));
    std::size_t failures = 0;
    for (std::uint64_t n = 1; n < 4000; n += 1 + n / 3) {
        MeshOf<D> mesh(1, little);
        mesh.host.set_threads(3, true);
        mesh.host.fail_at(n);
        const abacus_status status = mesh.with_stage(points, 1 << 20, [&](abacus_stage *stage) {
            const abacus_status ended = abacus_stage_end(stage, &mesh.header.facts, &mesh.error);
            if (ended != ABACUS_OK) return ended;
            return mesh.with_build([&](abacus_build *build) {
                const abacus_status logs = abacus_build_log(build, 1, &mesh.error);
                return logs != ABACUS_OK ? logs
                                         : abacus_build_insert(build, stage, ABACUS_KEEP,
                                                               &mesh.header, &mesh.error);
            });
        });
        failures += status != ABACUS_OK;
        EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
        EXPECT_EQ(mesh.host.bytes, 0u);
        EXPECT_TRUE(all_threads_ended());
    }
    EXPECT_GT(failures, 10u);
}

} // namespace
} // namespace abacus::test
