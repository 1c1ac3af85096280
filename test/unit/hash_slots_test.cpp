// The table of hashes, compared with a map: with hashes that meet in one run, across the end of the
// table, and while it grows.
#include "host/hash_slots.hpp"
#include "support/memory_host.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <vector>

namespace abacus {
namespace {

constexpr std::uint32_t none = 0;
using Slots = HashSlots<none>;
using Model = std::map<std::uint32_t, std::uint32_t>; // hash of each number

/// The numbers with this hash, in order.
std::vector<std::uint32_t> numbers(const Slots &slots, std::uint32_t hash) {
    std::vector<std::uint32_t> result;
    const auto keep = [&](std::uint32_t number) {
        result.push_back(number);
        return false;
    };
    EXPECT_EQ(slots.find(hash, keep), none);
    EXPECT_EQ(slots.first(hash), result.empty() ? none : result.front());
    std::sort(result.begin(), result.end());
    return result;
}

void expect_same(const Slots &slots, const Model &model) {
    std::map<std::uint32_t, std::vector<std::uint32_t>> expected;
    for (const auto &[number, hash] : model) expected[hash].push_back(number);
    for (const auto &[hash, of_hash] : expected) EXPECT_EQ(numbers(slots, hash), of_hash);
}

class HashSlotsOf : public testing::TestWithParam<std::uint32_t> {};

TEST_P(HashSlotsOf, NumbersThatComeAndGoAreAsInAMap) {
    MemoryHost host;
    const Host memory = host.host();
    Slots slots(memory);
    Model model;
    std::mt19937 random(1);
    // A few hashes, or many; the last slots get as many as all others.
    const auto draw = [&] {
        const std::uint32_t hash = random() % GetParam();
        return random() % 2 ? hash : ~hash;
    };
    std::uint32_t next = 1;
    for (int round = 0; round < 8; ++round) {
        for (int i = 0; i < 500; ++i, ++next) {
            const auto [added, _] = model.emplace(next, draw());
            slots.add(added->second, next);
        }
        expect_same(slots, model);
        for (int i = 0; i < 300; ++i) {
            auto gone = model.lower_bound(1 + random() % next);
            if (gone == model.end()) gone = model.begin();
            const std::uint32_t hash = gone->second;
            slots.remove(hash, gone->first);
            model.erase(gone);
            if (i % 30 == 0) expect_same(slots, model);
        }
    }
    for (const auto &[number, hash] : model) slots.remove(hash, number);
    for (const auto &[number, hash] : model) EXPECT_EQ(slots.first(hash), none);
}

INSTANTIATE_TEST_SUITE_P(Hashes, HashSlotsOf, testing::Values(1, 20, 1000, 1000000));

} // namespace
} // namespace abacus
