// Which blocks leave: those behind the front, then the farthest ahead, never blocks in use.
#include "blocks/replacement.hpp"

#include "support/memory_host.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace abacus::test {
namespace {

class Blocks {
public:
    explicit Blocks(std::size_t n) : list(host_), count(n) {
        list.resize(n);
        for (std::uint32_t b = 0; b < n; ++b) {
            Block &block = list[BlockIndex{b}];
            block = Block{};
            block.state = Block::cached;
            block.own({b * 10, 0}, {b * 10 + 10, 0});
            block.used_at = b < n / 2 ? 5000 + b : b; // blocks behind were used last
        }
    }
    /// The next to leave, with the front at the middle.
    std::vector<BlockIndex> next(Replacement &replacement) {
        Arena<BlockIndex> victims(host_);
        replacement.choose(list, count, 10000, victims);
        std::vector<BlockIndex> sorted(victims.begin(), victims.end());
        std::sort(sorted.begin(), sorted.end());
        return sorted;
    }
    const Host &host() const { return host_; }

private:
    MemoryHost memory_;
    const Host host_ = memory_.host();

public:
    Arena<Block, BlockIndex> list;
    const std::size_t count;
};

std::vector<BlockIndex> range(std::uint32_t from, std::uint32_t to) {
    std::vector<BlockIndex> blocks;
    for (std::uint32_t b = from; b < to; ++b) blocks.push_back(BlockIndex{b});
    return blocks;
}

TEST(Replacement, TakesThoseBehindByTheirLastUse) {
    Blocks blocks(2000);
    Replacement replacement(blocks.host(), 0, {});
    replacement.reached(1000 * 10);
    EXPECT_EQ(blocks.next(replacement), range(0, 64));
}

TEST(Replacement, TakesTheFarthestAheadWhileTheWindowIsNotFull) {
    Blocks blocks(2000);
    Replacement replacement(blocks.host(), 0, {});
    replacement.reached(250 * 10);
    EXPECT_EQ(blocks.next(replacement), range(2000 - 64, 2000));
    // ... but none in use
    for (std::uint32_t b = 1900; b < 2000; ++b) blocks.list[BlockIndex{b}].used_at = 9999;
    EXPECT_EQ(blocks.next(replacement), range(1900 - 64, 1900));
}

TEST(Replacement, IsByLastUseInASmallCacheOrWithoutAFront) {
    Blocks blocks(100);
    Replacement replacement(blocks.host(), 0, {});
    replacement.reached(50 * 10);
    EXPECT_EQ(blocks.next(replacement), range(50, 60));
    Blocks many(2000);
    Replacement nowhere(many.host(), 0, {});
    EXPECT_EQ(many.next(nowhere), range(1000, 1064));
}

TEST(Replacement, TakesATenthOfFewBlocksAndLeavesTwo) {
    Blocks few(40), three(3);
    Replacement replacement(few.host(), 0, {});
    EXPECT_EQ(few.next(replacement).size(), 4u);
    EXPECT_EQ(three.next(replacement).size(), 1u);
}

TEST(Replacement, GivesTheLastPassALittleRoomOfItsOwn) {
    MemoryHost memory;
    const Host host = memory.host();
    Replacement replacement(host, 1000, {.after_others = 100, .alone = 150});
    EXPECT_EQ(replacement.limit(), 1000u);
    EXPECT_FALSE(replacement.reached(7));
    EXPECT_FALSE(replacement.reached(7));
    replacement.expect_last_pass(true);
    EXPECT_EQ(replacement.limit(), 150u);
    replacement.expect_last_pass(false);
    EXPECT_TRUE(replacement.reached(3));
    replacement.begin_pass(300);
    EXPECT_EQ(replacement.limit(), 1000u);
    replacement.expect_last_pass(true);
    EXPECT_EQ(replacement.limit(), 400u);
    replacement.set_budget(350);
    EXPECT_EQ(replacement.limit(), 350u);
    replacement.begin_pass(100);
    EXPECT_EQ(replacement.limit(), 200u);
    replacement.expect_last_pass(false);
    EXPECT_EQ(replacement.limit(), 350u);
}

} // namespace
} // namespace abacus::test
