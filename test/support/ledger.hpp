// A small type of data in the block cache: entries with a key and a payload, as small as possible
// while using all features of the cache. Entries have different weights, so pages have too many
// bytes now and then. An index names the cached entries by their handles, like the links of a mesh.
// So the test notices an entry that moves unannounced.
#pragma once

#include "blocks/block_cache.hpp"
#include "support/memory_host.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <map>
#include <optional>

namespace abacus::test {

struct Entry {
    Key key;
    std::uint32_t payload, weight; // the weight is its number of bytes in a page

    static constexpr std::uint32_t free_mark = 0xffffffffu, most_weight = 400;

    bool is_free() const { return weight == free_mark; }
    std::uint32_t next_free() const { return payload; }
    Handle moved_to() const { return static_cast<Handle>(key.part); }
    void set_free(std::uint32_t next, Handle moved) {
        weight = free_mark;
        payload = next;
        key.part = std::uint64_t(moved);
    }
};

struct EntryBlocks {
    using Record = Entry;
    struct Note {
        std::uint32_t pages; // from which the block was made
    };
    using Counters = BlockCounters;
    static constexpr std::uint32_t slots = 512;
    static constexpr std::uint64_t handles_end = 1u << 30;
    static constexpr abacus_page_kind page_kind = ABACUS_SIMPLEX_PAGES;
    static constexpr const char *a_record = "An entry", *records = "entries", *whole = "ledger";
};

class Ledger : public BlockCache<Ledger, EntryBlocks> {
public:
    Ledger(const Host &host, std::size_t budget)
        : BlockCache(host, budget, {.after_others = budget, .alone = budget},
                     PageCapacity({.overhead = sizeof(Head),
                                   .room = ABACUS_PAGE_BYTES - sizeof(Head),
                                   .record_bytes = 100,
                                   .inverse_growth = -1,
                                   .slots = slots})) {}

    // ---- What a user of the ledger calls ------------------------------------------------

    void add(const Key &key, std::uint32_t payload, std::uint32_t weight) {
        const Handle h = allot(key.code);
        set(h, {key, payload, weight});
        index_[h] = key;
        settle(key.code);
        trim();
    }
    /// Returns whether there was one.
    bool remove(const Key &key) {
        const Handle h = find(key);
        if (h == no_handle) return false;
        give_back(h, no_handle);
        ++counters.deleted;
        index_.erase(h);
        settle(key.code);
        trim();
        return true;
    }
    std::optional<std::uint32_t> payload(const Key &key) {
        const Handle h = find(key);
        if (h == no_handle) return std::nullopt;
        return record(h).payload;
    }
    /// All entries, page by page.
    std::map<std::pair<std::uint64_t, std::uint64_t>, std::uint32_t> all() {
        std::map<std::pair<std::uint64_t, std::uint64_t>, std::uint32_t> entries;
        for (Key key = first_key; !(key == end_key); trim())
            key = visit(key, [&](Handle h) {
                const Entry &e = record(h);
                entries[{e.key.code, e.key.part}] = e.payload;
            });
        return entries;
    }
    const char *check() const {
        if (const char *fault = check_invariants()) return fault;
        std::size_t cached = 0;
        for_each_cached([&](BlockIndex b) { cached += blocks_[b].count; });
        if (cached != index_.size()) return "the index has other entries than the blocks";
        for (const auto &[h, key] : index_)
            if (!is_live(h) || !(record(h).key == key)) return "the index leads astray";
        return nullptr;
    }

    // ---- What the block cache calls -----------------------------------------------------

    std::uint64_t code(const Entry &e) const { return e.key.code; }
    std::uint64_t part(const Entry &e) const { return e.key.part; }
    void ask_for_code(const Entry &) const {}
    void ask_for_contents(BlockIndex) const {}
    std::size_t bytes_beside_blocks() const { return 0; }
    void moved(Handle from, Handle to) {
        const auto it = index_.find(from);
        ASSERT_NE(it, index_.end());
        index_[to] = it->second;
        index_.erase(from);
    }
    PageContents open_page(const abacus_page &page) {
        if (page.size < sizeof(Head)) throw_corrupted("A page of entries has no head.");
        std::memcpy(&head_, page.bytes, sizeof head_);
        if (!(head_.lower < head_.upper) || head_.entries > slots ||
            page.size < sizeof(Head) + head_.entries * sizeof(Entry))
            throw_corrupted("A page of entries has an impossible head.");
        std::memcpy(read_.data(), page.bytes + sizeof head_, head_.entries * sizeof(Entry));
        return {head_.lower, head_.upper, static_cast<std::uint32_t>(head_.entries)};
    }
    void tie(BlockIndex b) {
        EXPECT_EQ(notes_[b].pages, 0u);
        notes_[b].pages = 1;
        for (std::uint32_t i = 0; i < head_.entries; ++i) {
            slots_[first_of(b) + i] = read_[i];
            index_[first_of(b) + i] = read_[i].key;
        }
    }
    EncodedPage encode_page(BlockIndex b) {
        surveyed_ = b;
        std::size_t size = sizeof(Head);
        Head head{blocks_[b].lower, blocks_[b].upper, 0};
        for_each_record(b, [&](Handle h) {
            const std::size_t bytes = sizeof(Entry) + record(h).weight;
            if (size + bytes <= sizeof page_)
                std::memcpy(page_ + sizeof head + head.entries * sizeof(Entry), &record(h),
                            sizeof(Entry));
            size += bytes;
            ++head.entries;
        });
        std::memcpy(page_, &head, sizeof head);
        return {page_, size, size <= ABACUS_PAGE_BYTES};
    }
    void survey(BlockIndex b) { surveyed_ = b; }
    void untie(BlockIndex b) {
        EXPECT_TRUE(in_batch_);
        EXPECT_EQ(surveyed_, b);
        surveyed_ = no_block;
        for_each_record(b, [&](Handle h) { index_.erase(h); });
    }
    void begin_eviction() {
        EXPECT_FALSE(in_batch_);
        in_batch_ = true;
    }
    void end_eviction() {
        EXPECT_TRUE(in_batch_);
        in_batch_ = false;
    }

private:
    struct Head {
        Key lower, upper;
        std::uint64_t entries;
    };

    Handle find(const Key &key) {
        const BlockIndex b = owner(key);
        if (b == no_block) throw_corrupted("No page owns a part of the curve.");
        Handle found = no_handle;
        for_each_record(b, [&](Handle h) {
            if (record(h).key == key) found = h;
        });
        return found;
    }

    std::map<Handle, Key> index_; // of the cached entries
    BlockIndex surveyed_ = no_block;
    bool in_batch_ = false;
    Head head_{}; // of the last page opened
    std::array<Entry, slots> read_{};
    alignas(8) unsigned char page_[ABACUS_PAGE_BYTES]{};
};

} // namespace abacus::test
