// Memory for any thread: counted, refused beyond its limit, and freed at the end.
#include "host/arena.hpp"
#include "host/thread_memory.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <thread>
#include <vector>

namespace abacus {
namespace {

TEST(ThreadMemory, CountsWhatIsUsed) {
    ThreadMemory memory;
    memory.reserve(1 << 20);
    const Memory any = memory.memory();
    void *block = any.resize(nullptr, 1000);
    EXPECT_GE(memory.used(), 1000u);
    std::memset(block, 7, 1000);
    block = any.resize(block, 100000);
    EXPECT_EQ(static_cast<char *>(block)[999], 7);
    EXPECT_GE(memory.used(), 100000u);
    block = any.resize(block, 10);
    EXPECT_LT(memory.used(), 1000u);
    any.release(block);
    EXPECT_EQ(memory.used(), 0u);
}

TEST(ThreadMemory, RefusesWhatIsNotReserved) {
    ThreadMemory memory;
    const Memory any = memory.memory();
    EXPECT_THROW(any.resize(nullptr, 1), std::bad_alloc);
    memory.reserve(5000);
    void *block = any.resize(nullptr, 4000);
    EXPECT_THROW(any.resize(block, 6000), std::bad_alloc);
    EXPECT_THROW(any.resize(nullptr, SIZE_MAX), std::bad_alloc);
    memory.reserve(10000); // the session's thread may raise the limit; the block is unchanged
    block = any.resize(block, 6000);
    any.release(block);
    memory.reserve(0); // ... or lower it below the used memory, which then only shrinks
    EXPECT_THROW(any.resize(nullptr, 1), std::bad_alloc);
}

TEST(ThreadMemory, FreesWhatThreadsLeft) {
    ThreadMemory memory; // the sanitizer reports anything left
    memory.reserve(1 << 20);
    for (int i = 0; i < 10; ++i) memory.memory().resize(nullptr, 1000 * (i + 1));
}

TEST(ThreadMemory, ServesArraysOfManyThreads) {
    ThreadMemory memory;
    memory.reserve(std::size_t{1} << 30);
    std::vector<std::thread> threads;
    std::atomic<int> wrong = 0;
    for (unsigned t = 0; t < 4; ++t)
        threads.emplace_back([&, t] {
            const Memory any = memory.memory();
            for (int round = 0; round < 20; ++round) {
                Arena<std::uint64_t> array(any);
                for (std::uint64_t i = 0; i < 20000; ++i) array.push_back(i * 4 + t);
                for (std::uint64_t i = 0; i < array.size(); ++i) wrong += array[i] != i * 4 + t;
            }
        });
    for (std::thread &thread : threads) thread.join();
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(memory.used(), 0u);
}

} // namespace
} // namespace abacus
