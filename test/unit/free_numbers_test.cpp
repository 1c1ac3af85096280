// Returned numbers, compared with a set: many and few, near and far; and their order.
#include "host/free_numbers.hpp"
#include "support/memory_host.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>
#include <vector>

namespace abacus {
namespace {

class FreeNumbersUpTo : public testing::TestWithParam<std::uint32_t> {};

TEST_P(FreeNumbersUpTo, ComeBackOnceEach) {
    MemoryHost host;
    const Host memory = host.host();
    FreeNumbers free(memory);
    std::set<std::uint32_t> model;
    std::mt19937 random(1);
    for (int round = 0; round < 50; ++round) {
        for (int i = 0; i < 40; ++i) {
            const std::uint32_t number = random() % GetParam();
            if (model.insert(number).second) free.add(number);
        }
        EXPECT_EQ(free.size(), model.size());
        // all of them in every second round, otherwise about half
        for (std::size_t left = round % 2 == 0 ? 0 : model.size() / 2; model.size() > left;) {
            ASSERT_FALSE(free.empty());
            ASSERT_EQ(model.erase(free.take()), 1u);
        }
        EXPECT_EQ(free.empty(), model.empty());
    }
}

// One word, one word of the summary and a little more, and so many that most of both are empty.
INSTANTIATE_TEST_SUITE_P(Numbers, FreeNumbersUpTo, testing::Values(60u, 4200u, 100'000'000u));

TEST(FreeNumbers, ComeInARowWhateverTheOrderTheyWent) {
    MemoryHost host;
    const Host memory = host.host();
    FreeNumbers free(memory);
    std::vector<std::uint32_t> numbers(20000);
    std::iota(numbers.begin(), numbers.end(), 7u);
    std::vector<std::uint32_t> shuffled = numbers;
    std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(1));
    for (const std::uint32_t number : shuffled) free.add(number);
    for (const std::uint32_t number : numbers) ASSERT_EQ(free.take(), number);
    EXPECT_TRUE(free.empty());
}

TEST(FreeNumbers, GoOnBehindTheLastAndAround) {
    MemoryHost host;
    const Host memory = host.host();
    FreeNumbers free(memory);
    for (const std::uint32_t number : {100u, 5000u, 300'000u}) free.add(number);
    EXPECT_EQ(free.take(), 100u);
    EXPECT_EQ(free.take(), 5000u);
    free.add(10); // after the last one: beyond all numbers before it
    EXPECT_EQ(free.take(), 300'000u);
    EXPECT_EQ(free.take(), 10u);
    EXPECT_TRUE(free.empty());
}

} // namespace
} // namespace abacus
