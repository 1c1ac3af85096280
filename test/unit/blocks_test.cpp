// The block cache alone, with a small type of data (support/ledger.hpp): placement, eviction,
// splits and merges, compared with a model in memory, with the invariants after each step; wrong
// stored bytes; and failures at any moment.
#include "blocks/block_cache_code.hpp"
#include "support/ledger.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

namespace abacus {
template class BlockCache<test::Ledger, test::EntryBlocks>;
}

namespace abacus::test {
namespace {

using Random = std::mt19937_64;
using Model = std::map<std::pair<std::uint64_t, std::uint64_t>, std::uint32_t>;

constexpr std::size_t block_bytes = EntryBlocks::slots * sizeof(Entry);
constexpr std::size_t little = 6 * block_bytes, ample = 4096 * block_bytes;

/// The distribution of keys: over the curve, a few codes with many parts, ascending.
enum class Spread { even, parts, ascending };

Key random_key(Random &random, Spread spread, std::uint64_t serial) {
    switch (spread) {
    case Spread::even:
        return {random() >> 2, 0};
    case Spread::parts:
        return {random() % 3 * 1000, random() >> 2};
    case Spread::ascending:
        return {serial << 20, 0};
    }
    return {};
}

std::uint32_t random_weight(Random &random) {
    return static_cast<std::uint32_t>(random() % (random() % 50 == 0 ? Entry::most_weight : 60));
}

/// A ledger, with the entries that it should have.
class LedgerInChange {
public:
    explicit LedgerInChange(std::size_t budget) : budget_(budget) {
        ledger.emplace(host_, budget);
        ledger->create_first_block();
    }

    void add(const Key &key) {
        if (!model.emplace(std::pair(key.code, key.part), serial).second) return;
        ledger->add(key, serial++, random_weight(random));
    }
    void add_some(int n, Spread spread) {
        for (int i = 0; i < n; ++i) {
            add(random_key(random, spread, serial));
            ASSERT_EQ(ledger->check(), nullptr) << "entry " << i;
        }
    }
    /// Removes every second one of the first n along the curve, or n anywhere.
    void remove_some(int n, bool along_the_curve) {
        for (int i = 0; i < n && !model.empty(); ++i) {
            auto it = model.begin();
            std::advance(it, (along_the_curve ? std::size_t(i) : random()) % model.size());
            ASSERT_TRUE(ledger->remove({it->first.first, it->first.second}));
            model.erase(it);
            ASSERT_EQ(ledger->check(), nullptr) << "entry " << i;
        }
    }
    /// Reads the stored pages with another cache.
    void verify() {
        ledger->flush();
        ASSERT_EQ(ledger->check(), nullptr);
        ASSERT_EQ(ledger->all(), model);
        Ledger reader(host_, budget_);
        ASSERT_EQ(reader.all(), model);
        ASSERT_EQ(reader.check(), nullptr);
        ASSERT_EQ(reader.counters.stores, 0u);
        ASSERT_EQ(memory.violations, std::vector<std::string>{});
    }

    MemoryHost memory;
    Model model;
    Random random{1};
    std::uint32_t serial = 0;

private:
    const Host host_ = memory.host();
    std::size_t budget_;

public:
    std::optional<Ledger> ledger;
};

TEST(BlockCache, KeepsWhatIsAddedAnywhereOnTheCurve) {
    LedgerInChange change(little);
    ASSERT_NO_FATAL_FAILURE(change.add_some(4000, Spread::even));
    const BlockCounters &counters = change.ledger->counters;
    EXPECT_GT(counters.splits, 0u);
    EXPECT_GT(counters.evictions, 0u);
    EXPECT_GT(counters.loads, 0u);
    EXPECT_GT(counters.rewrites, 0u);
    ASSERT_NO_FATAL_FAILURE(change.verify());
}

TEST(BlockCache, FillsPagesOfWhatIsAddedInOrder) {
    LedgerInChange change(little);
    ASSERT_NO_FATAL_FAILURE(change.add_some(6000, Spread::ascending));
    ASSERT_NO_FATAL_FAILURE(change.verify());
    std::size_t bytes = 0;
    for (const auto &[key, page] : change.memory.pages) bytes += page.size;
    EXPECT_GT(double(bytes) / double(change.memory.pages.size()), 0.8 * ABACUS_PAGE_BYTES);
    EXPECT_EQ(change.ledger->counters.loads - change.ledger->counters.stores, 0u)
        << "only verify() loads, each page once";
}

TEST(BlockCache, TellsEntriesOfOneCodeApartByTheirParts) {
    LedgerInChange change(little);
    ASSERT_NO_FATAL_FAILURE(change.add_some(2000, Spread::parts));
    EXPECT_GT(change.memory.pages.size() + change.ledger->cached_blocks(), 6u);
    ASSERT_NO_FATAL_FAILURE(change.remove_some(500, false));
    ASSERT_NO_FATAL_FAILURE(change.verify());
}

TEST(BlockCache, MergesWhatIsLeftOfManyBlocks) {
    LedgerInChange change(little);
    ASSERT_NO_FATAL_FAILURE(change.add_some(4000, Spread::even));
    change.ledger->flush();
    const std::size_t before = change.memory.pages.size();
    ASSERT_NO_FATAL_FAILURE(change.remove_some(2000, true));
    ASSERT_NO_FATAL_FAILURE(change.verify());
    EXPECT_LT(change.memory.pages.size(), before * 3 / 4);
    EXPECT_GT(change.ledger->counters.merges, 0u);
    ASSERT_NO_FATAL_FAILURE(change.remove_some(4000, false));
    ASSERT_NO_FATAL_FAILURE(change.verify());
    EXPECT_TRUE(change.model.empty());
}

TEST(BlockCache, IsTheSameWhateverTheBudget) {
    LedgerInChange small(little), large(ample);
    for (LedgerInChange *change : {&small, &large})
        for (int round = 0; round < 8; ++round) {
            ASSERT_NO_FATAL_FAILURE(change->add_some(500, Spread::even));
            ASSERT_NO_FATAL_FAILURE(change->remove_some(300, round % 2 == 0));
        }
    EXPECT_EQ(small.model, large.model);
    ASSERT_NO_FATAL_FAILURE(small.verify());
    ASSERT_NO_FATAL_FAILURE(large.verify());
    EXPECT_LE(small.ledger->bytes(), little);
}

TEST(BlockCache, SaysThatTooManyEntriesHaveOneKey) {
    MemoryHost memory;
    const Host host = memory.host();
    Ledger ledger(host, ample);
    ledger.create_first_block();
    try {
        for (std::uint32_t i = 0; i < EntryBlocks::slots; ++i) ledger.add({7, 7}, i, 50);
        FAIL() << "they fit";
    } catch (const Error &error) {
        EXPECT_EQ(error.kind, ABACUS_ERROR_LIMIT);
        EXPECT_STREQ(error.what(), "too many entries share one key");
    }
}

// ---- Stored bytes that are wrong --------------------------------------------------------

class Damaged : public testing::Test {
protected:
    Damaged() {
        LedgerInChange change(ample);
        change.add_some(1000, Spread::even);
        change.ledger->flush();
        memory.restore(change.memory);
    }
    /// The second page, which begins where the first one ends.
    MemoryHost::Page &second() { return std::next(memory.pages.begin())->second; }
    Key *interval(MemoryHost::Page &page) { return reinterpret_cast<Key *>(page.bytes()); }
    std::string fault_of_reading() {
        try {
            const Host host = memory.host();
            Ledger(host, ample).all();
        } catch (const Error &error) {
            EXPECT_EQ(error.kind, ABACUS_ERROR_CORRUPTED);
            return error.detail;
        }
        return "none";
    }

    MemoryHost memory;
};

TEST_F(Damaged, PagesThatOverlapAreFound) {
    interval(memory.pages.begin()->second)[1].code += 1; // the first page's upper key
    EXPECT_EQ(fault_of_reading(), "Two pages own the same part of the curve.");
}

TEST_F(Damaged, AGapBetweenPagesIsFound) {
    Key &upper = interval(memory.pages.begin()->second)[1];
    upper.code -= 1;
    const Host host = memory.host();
    Ledger ledger(host, ample);
    try {
        ledger.payload(upper);
        FAIL() << "nothing is said";
    } catch (const Error &error) {
        EXPECT_EQ(error.detail, "No page owns a part of the curve.");
    }
}

TEST_F(Damaged, APageUnderAnothersKeyIsFound) {
    interval(second())[0].code += 1;
    EXPECT_EQ(fault_of_reading(), "A page is stored under another page's key.");
}

TEST_F(Damaged, AnEntryInAnotherPageIsFoundBeforeABorderIsDrawn) {
    auto *const first = reinterpret_cast<Entry *>(second().bytes() + 40);
    const Key lower = interval(second())[0], upper = interval(second())[1];
    first->key.code = upper.code + 5;
    const Host host = memory.host();
    Ledger ledger(host, ample);
    try {
        for (std::uint32_t i = 0; i < EntryBlocks::slots; ++i)
            ledger.add({lower.code + 1 + i, 0}, i, 0);
        FAIL() << "nothing is said";
    } catch (const Error &error) {
        EXPECT_EQ(error.kind, ABACUS_ERROR_CORRUPTED);
        EXPECT_EQ(error.detail, "An entry lies in a page that does not own its key.");
    }
}

// ---- Whatever fails ---------------------------------------------------------------------

/// Work that splits, evicts, loads and merges, and how it ended.
enum class End { done, host_failed, no_memory };
End work(MemoryHost &memory) {
    const Host host = memory.host();
    try {
        Ledger ledger(host, little / 2);
        Random random(3);
        std::vector<Key> keys;
        const auto add_some = [&](int n, Spread spread) {
            for (int i = 0; i < n; ++i) {
                keys.push_back(random_key(random, spread, keys.size()));
                ledger.add(keys.back(), 0, random_weight(random));
            }
        };
        ledger.create_first_block();
        add_some(600, Spread::even);
        add_some(200, Spread::parts);
        ledger.flush();
        for (std::size_t i = 0; i < keys.size(); i += 2) EXPECT_TRUE(ledger.remove(keys[i]));
        ledger.flush();
        EXPECT_EQ(ledger.all().size(), keys.size() / 2);
        EXPECT_EQ(ledger.check(), nullptr);
    } catch (const HostFailure &) {
        return End::host_failed;
    } catch (const std::bad_alloc &) {
        return End::no_memory;
    }
    return End::done;
}

/// Every n up to 60, then fewer and fewer: most of the calls are alike.
std::uint64_t after(std::uint64_t n) { return n < 60 ? n + 1 : n + n / 8; }

TEST(BlockCacheFailure, OfAnyHostFunctionGivesEverythingBack) {
    std::uint64_t n = 1;
    for (;; n = after(n)) {
        MemoryHost memory;
        memory.fail_at(n);
        const End end = work(memory);
        EXPECT_EQ(memory.bytes, 0u);
        EXPECT_EQ(memory.violations, std::vector<std::string>{});
        if (end == End::done) break;
        ASSERT_EQ(end, End::host_failed) << "call " << n;
    }
    EXPECT_GT(n, 60u);
}

TEST(BlockCacheFailure, OfAnyAllocationGivesEverythingBack) {
    std::uint64_t n = 1;
    for (;; n = after(n)) {
        MemoryHost memory;
        memory.fail_resize_at(n);
        const End end = work(memory);
        EXPECT_EQ(memory.bytes, 0u);
        EXPECT_EQ(memory.violations, std::vector<std::string>{});
        if (end == End::done) break;
        ASSERT_EQ(end, End::no_memory) << "allocation " << n;
    }
    EXPECT_GT(n, 10u);
}

} // namespace
} // namespace abacus::test
