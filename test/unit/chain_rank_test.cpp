// Positions in chains: compared with walking, in memory and far beyond it.
#include "sort/chain_rank.hpp"
#include "support/memory_host.hpp"
#include "support/point_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace abacus::test {
namespace {

constexpr std::uint64_t none = ChainRank::none;

struct Chains {
    std::vector<std::uint64_t> successor, weight, position;
    std::vector<std::size_t> chain;
    std::vector<bool> is_closed; // by chain
};

/// Chains of all lengths up to `longest`, their elements shuffled; every third is closed.
Chains make(std::size_t n, std::size_t longest, Random &random) {
    Chains made{std::vector(n, none), std::vector<std::uint64_t>(n), {}, {}, {}};
    made.position.resize(n);
    made.chain.resize(n);
    std::vector<std::uint64_t> order(n);
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), random);
    for (std::size_t at = 0; at < n;) {
        const std::size_t length = std::min<std::size_t>(n - at, 1 + random() % longest);
        std::uint64_t position = 0;
        for (std::size_t i = at; i < at + length; ++i) {
            made.weight[order[i]] = random() % 5;
            made.position[order[i]] = position;
            made.chain[order[i]] = made.is_closed.size();
            position += made.weight[order[i]];
            if (i > at) made.successor[order[i - 1]] = order[i];
        }
        made.is_closed.push_back(random() % 3 == 0);
        if (made.is_closed.back()) made.successor[order[at + length - 1]] = order[at];
        at += length;
    }
    return made;
}

/// A closed chain begins anywhere, so positions there are compared from element to element.
void expect_ranked(const Chains &chains, std::size_t memory) {
    MemoryHost store;
    {
        const Host host = store.host();
        ChainRank ranks(host, memory);
        const std::size_t n = chains.successor.size();
        for (std::size_t i = 0; i < n; ++i) ranks.add(chains.weight[i], chains.successor[i]);
        ranks.finish();
        std::vector<ChainRank::Rank> found(n);
        for (ChainRank::Rank &rank : found) rank = ranks.next();
        for (std::size_t i = 0; i < n; ++i) {
            const bool is_closed = chains.is_closed[chains.chain[i]];
            ASSERT_EQ(found[i].is_closed, is_closed) << i;
            ASSERT_LT(found[i].chain, n);
            ASSERT_EQ(chains.chain[found[i].chain], chains.chain[i]) << i;
            const std::uint64_t next = chains.successor[i];
            if (!is_closed) {
                ASSERT_EQ(found[i].position, chains.position[i]) << i;
            } else if (found[next].position != 0) {
                ASSERT_EQ(found[next].position, found[i].position + chains.weight[i]) << i;
            }
            if (next != none) {
                ASSERT_EQ(found[next].chain, found[i].chain) << i;
            }
        }
    }
    EXPECT_EQ(store.violations, std::vector<std::string>{});
    EXPECT_EQ(store.bytes, 0u);
}

TEST(ChainRank, RanksInMemory) {
    Random random(1);
    for (const std::size_t n : {0, 1, 2, 17, 1000}) expect_ranked(make(n, 20, random), 1 << 20);
}

TEST(ChainRank, RanksWhatDoesNotFit) {
    Random random(2);
    for (const std::size_t longest : {1, 2, 5, 1000, 30000})
        expect_ranked(make(30000, longest, random), 16384);
}

TEST(ChainRank, RanksOneLongChain) {
    Chains one{std::vector(20000, none), std::vector<std::uint64_t>(20000, 1), {}, {}, {true}};
    one.position.resize(20000);
    one.chain.resize(20000);
    for (std::size_t i = 0; i < 20000; ++i) one.successor[i] = (i + 1) % 20000;
    expect_ranked(one, 0);
    one.is_closed[0] = false;
    one.successor[19999] = none;
    std::iota(one.position.begin(), one.position.end(), 0);
    expect_ranked(one, 0);
}

} // namespace
} // namespace abacus::test
