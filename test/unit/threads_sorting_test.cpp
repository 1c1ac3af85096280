// Any number of threads sort records and points into the same order, and end cleanly whatever
// fails.
#include "sort/record_sort.hpp"
#include "support/running_threads.hpp"
#include "support/staged_points.hpp"

#include <atomic>
#include <numeric>

namespace abacus::test {
namespace {

using Words = std::vector<std::uint64_t>;
constexpr std::size_t stride = 4, key = 3; // words of a record

/// Sorts records with a host; checks that nothing is left in it.
Words sorted_by(MemoryHost &store, const Words &records, std::size_t memory) {
    Words result;
    {
        const Host host = store.host();
        RecordSort sort(host, stride, key, memory);
        for (std::size_t i = 0; i < records.size(); i += stride)
            std::copy_n(records.data() + i, stride, sort.add());
        sort.finish();
        while (const std::uint64_t *record = sort.next())
            result.insert(result.end(), record, record + stride);
        sort.close();
    }
    EXPECT_EQ(store.violations, std::vector<std::string>{});
    EXPECT_EQ(store.bytes, 0u);
    EXPECT_TRUE(store.spools.empty());
    EXPECT_TRUE(all_threads_ended());
    return result;
}

/// Records with the keys word(i, k); their last words number them.
template <class WordOf> Words make(std::size_t n, WordOf word) {
    Words records;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < key; ++k) records.push_back(word(i, k));
        records.push_back(i);
    }
    return records;
}

/// By their keys; equal ones in their original order.
Words in_order(const Words &records) {
    std::vector<std::size_t> order(records.size() / stride);
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const auto begin = records.begin();
        return std::lexicographical_compare(begin + a * stride, begin + (a + 1) * stride,
                                            begin + b * stride, begin + (b + 1) * stride);
    });
    Words result;
    for (const std::size_t i : order)
        result.insert(result.end(), records.begin() + i * stride,
                      records.begin() + (i + 1) * stride);
    return result;
}

std::vector<Words> inputs(std::size_t n) {
    std::mt19937_64 random(3);
    const auto any = [&](std::size_t, std::size_t) { return random(); };
    return {
        make(n, any),
        make(n, [](std::size_t, std::size_t) { return 7; }),
        // Few different words, so that the later ones decide.
        make(n, [&](std::size_t, std::size_t) { return random() % 3; }),
        // All but one of the first words differ in their last bits.
        make(n, [&](std::size_t i,
                    std::size_t k) { return k == 0 && i == 9 ? ~0ull : random() % 1000; }),
        make(n, [&](std::size_t i, std::size_t k) { return k < 2 ? 5 : i; }),
        make(n, [&](std::size_t i, std::size_t k) { return k == 2 ? random() : n - i; }),
    };
}

TEST(ThreadsSorting, BringsRecordsIntoTheSameOrder) {
    for (const std::size_t n : {1, 2, 30, 5000})
        for (const Words &records : inputs(n)) {
            const Words expected = in_order(records);
            for (const unsigned threads : {1, 2, 3, 7}) {
                MemoryHost store;
                store.set_threads(threads, true);
                ASSERT_TRUE(sorted_by(store, records, 64 << 20) == expected) << n << ' ' << threads;
            }
        }
}

// Records that do not fit are merged from runs; among equal keys any may then come first.
TEST(ThreadsSorting, BringsManyRecordsIntoTheSameOrder) {
    for (const Words &records : inputs(200000))
        for (const std::size_t memory : {64 << 20, 8 << 20}) {
            MemoryHost alone;
            const Words expected = sorted_by(alone, records, memory);
            if (memory > 8 << 20) {
                ASSERT_TRUE(expected == in_order(records));
            }
            for (const unsigned threads : {2, 5}) {
                MemoryHost store;
                store.set_threads(threads, false);
                ASSERT_TRUE(sorted_by(store, records, memory) == expected) << threads;
                EXPECT_LE(store.peak_bytes, alone.peak_bytes + (64 << 10));
            }
        }
}

TEST(ThreadsSorting, UsesThreads) {
    std::atomic<int> most = 0;
    MemoryHost store;
    store.set_threads(3, false);
    const Words records = inputs(100000)[0];
    const std::jthread watch([&](const std::stop_token &stop) {
        while (!stop.stop_requested()) most = std::max(most.load(), threads_now());
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const int before = threads_now();
    {
        const Host host = store.host();
        for (int times = 0; times < 20; ++times) {
            RecordSort sort(host, stride, key, 64 << 20);
            for (std::size_t i = 0; i < records.size(); i += stride)
                std::copy_n(records.data() + i, stride, sort.add());
            sort.finish();
        }
    }
    EXPECT_GT(most, before);
    EXPECT_LE(most, before + 3);
}

template <class Dimension> class ThreadsStaging : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(ThreadsStaging, Dimensions);

TYPED_TEST(ThreadsStaging, TheOrderIsTheSame) {
    constexpr int D = TypeParam::value;
    for (const Kind kind : all_kinds) {
        SCOPED_TRACE(static_cast<int>(kind));
        const Input<D> input = with_ids<D>(points<D>(kind, 20000));
        const Input<D> order = order_of<D>(input);
        for (const unsigned threads : {2, 3, 7})
            for (const std::size_t memory : {tiny, std::size_t{1} << 20, ample}) {
                MemoryHost host;
                host.set_threads(threads, true);
                ASSERT_TRUE(order_by<D>(host, input, memory) == order) << threads;
                ASSERT_TRUE(all_threads_ended());
            }
    }
}

TYPED_TEST(ThreadsStaging, TheOrderOfManyIsTheSame) {
    constexpr int D = TypeParam::value;
    for (const Kind kind : {Kind::uniform, Kind::clusters, Kind::heavy}) {
        const Input<D> input = with_ids<D>(points<D>(kind, 300000));
        const Input<D> order = order_of<D>(input);
        for (const std::size_t memory : {std::size_t{6} << 20, std::size_t{12} << 20, ample}) {
            std::size_t alone = 0;
            for (const unsigned threads : {1, 2, 4}) {
                MemoryHost host;
                host.set_threads(threads, false);
                ASSERT_TRUE(order_by<D>(host, input, memory) == order) << threads;
                if (threads == 1) alone = host.peak_bytes;
                EXPECT_LE(host.peak_bytes, std::max(alone, memory) + (64 << 10)) << memory;
            }
        }
    }
}

TYPED_TEST(ThreadsStaging, EndCleanlyWhateverFails) {
    constexpr int D = TypeParam::value;
    const Input<D> input = with_ids<D>(points<D>(Kind::uniform, 20000));
    const auto fails = [&](auto let_fail) {
        MemoryHost host;
        host.set_threads(3, true);
        let_fail(host);
        abacus_header header = empty_header<D>();
        abacus_error error{};
        const abacus_status status = stage<D>(host, header, input, 1 << 20, error);
        EXPECT_TRUE(all_threads_ended());
        EXPECT_EQ(host.bytes, 0u);
        EXPECT_EQ(host.violations, std::vector<std::string>{});
        return status != ABACUS_OK;
    };
    std::uint64_t n = 1;
    while (fails([&](MemoryHost &host) { host.fail_at(n); })) n += 1 + n / 3;
    EXPECT_GT(n, 20u);
    n = 1;
    while (fails([&](MemoryHost &host) { host.fail_resize_at(n); })) n += 1 + n / 3;
    EXPECT_GT(n, 20u);
    n = 4;
    while (fails([&](MemoryHost &host) { host.limit_threads(n << 10); })) n += 1 + n / 3;
    EXPECT_GT(n, 20u);
    EXPECT_TRUE(fails([](MemoryHost &host) {
        host.on_progress = [&](const abacus_progress &p) {
            if (p.phase == ABACUS_PHASE_SORTING) host.cancel();
        };
    }));
}

} // namespace
} // namespace abacus::test
