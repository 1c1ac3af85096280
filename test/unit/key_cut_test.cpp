// The place where a block is cut: near the wanted number, and never between equal keys.
#include "blocks/key_cut.hpp"

#include "support/memory_host.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

namespace abacus::test {
namespace {

using Words = std::pair<std::uint64_t, std::uint64_t>; // of a key

TEST(KeyCut, PartsKeysNearTheNumberWanted) {
    std::mt19937_64 random(1);
    MemoryHost memory;
    const Host host = memory.host();
    KeyCut cut(host);
    for (int round = 0; round < 20000; ++round) {
        // Codes spread evenly, over many orders of magnitude, or only a few codes; with parts or
        // without.
        const std::size_t n = 2 + random() % 300;
        const int kind = static_cast<int>(random() % 4);
        cut.clear();
        std::vector<Words> keys;
        for (std::uint32_t h = 0; h < n; ++h) {
            const std::uint64_t bits = random() >> 2;
            const std::uint64_t code = kind == 0   ? bits
                                       : kind == 1 ? bits >> random() % 60
                                                   : bits % (kind == 2 ? n : 3);
            cut.add(code, Handle{h});
            keys.push_back({code, 0});
        }
        ASSERT_EQ(cut.least_code(), std::min_element(keys.begin(), keys.end())->first);
        ASSERT_EQ(cut.greatest_code(), std::max_element(keys.begin(), keys.end())->first);
        if (kind == 3)
            for (KeyCut::Place &place : cut)
                keys[to_number(place.handle)].second = place.key.part = random() % 4;
        std::sort(keys.begin(), keys.end());

        const std::size_t wanted = random() % (n + 1);
        const std::size_t at = cut.cut_near(wanted);
        ASSERT_GT(at, 0u);
        ASSERT_LE(at, n);
        // The keys are still the same.
        std::vector<Words> parted;
        std::vector<bool> seen(n);
        for (const KeyCut::Place &place : cut) {
            ASSERT_FALSE(seen[to_number(place.handle)]);
            seen[to_number(place.handle)] = true;
            parted.push_back({place.key.code, place.key.part});
        }
        if (at < n) {
            for (std::size_t i = 0; i < at; ++i) ASSERT_LT(parted[i], parted[at]);
            for (std::size_t i = at; i < n; ++i) ASSERT_LE(parted[at], parted[i]);
        }
        std::sort(parted.begin(), parted.end());
        ASSERT_EQ(parted, keys);
        // Not much farther away than equal keys require.
        const std::size_t goal = std::clamp<std::size_t>(wanted, 1, n - 1);
        const auto [first, last] = std::equal_range(keys.begin(), keys.end(), keys[goal]);
        const auto below = static_cast<std::size_t>(first - keys.begin());
        const auto above = static_cast<std::size_t>(last - keys.begin());
        ASSERT_TRUE(at == below || (below == 0 && at == above) ||
                    (at < goal && goal - at <= n / 64))
            << at << " for " << goal << " of " << n;
    }
}

} // namespace
} // namespace abacus::test
