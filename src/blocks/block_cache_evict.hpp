// Eviction and storing: from records in slots to pages (dissertation §4.5.2, §4.9).
//
// Blocks leave in batches, one after the other: each is surveyed, written if it has changed, and
// untied by its owner. What has left stays readable, for the pages of its neighbours, until the
// whole batch has left.
//
// What leaves has not been used for long, so it is in no processor cache, and a page is made from
// some hundred places in memory. All of them are asked for before the first is read: what
// a block's records name while the block before is made a page, and its slots, which tell that,
// while the one before that is.
#pragma once

#include "blocks/block_cache.hpp"
#include "host/stopwatch.hpp"

#include <algorithm>
#include <bit>

namespace abacus {

template <class Owner, BlockDescription Type> void BlockCache<Owner, Type>::shrink() {
    counters.peak_bytes = std::max<std::uint64_t>(counters.peak_bytes, bytes());
    Arena<BlockIndex> victims(host_);
    // The last two stay: the next operation starts in one of them.
    while (bytes() > replacement_.limit() && cached_blocks_ > 2) {
        replacement_.choose(blocks_, cached_blocks_, clock_, victims);
        evict(victims);
        // All may have gone up in their neighbours.
        counters.eviction_batches += !victims.empty();
    }
    // Less and less often: it takes longer than to evict some blocks.
    ABACUS_ASSERT(!std::has_single_bit(counters.eviction_batches) ||
                  self().check_invariants(true) == nullptr);
}

template <class Owner, BlockDescription Type>
void BlockCache<Owner, Type>::evict(Arena<BlockIndex> &victims) {
    // In the order of the curve: each fills up from the next one.
    std::sort(victims.begin(), victims.end(),
              [&](BlockIndex a, BlockIndex b) { return blocks_[a].lower < blocks_[b].lower; });
    for (const BlockIndex b : victims) blocks_[b].leaving = true;
    for (std::size_t i = 0; i < victims.size(); ++i) {
        ask_ahead(victims, i + 1); // it fills up from the next one
        if (blocks_[victims[i]].state == Block::cached && !dissolve(victims[i]))
            fill_up(victims[i], true);
    }
    const auto is_gone = [&](BlockIndex b) { return blocks_[b].state != Block::cached; };
    victims.resize(static_cast<std::size_t>(
        std::remove_if(victims.begin(), victims.end(), is_gone) - victims.begin()));
    self().begin_eviction();
    for (std::size_t i = 0; i < victims.size(); ++i) {
        const BlockIndex b = victims[i];
        ask_ahead(victims, i);
        if (blocks_[b].dirty)
            write(b, victims);
        else
            self().survey(b);
        self().untie(b);
    }
    self().end_eviction();
    for (const BlockIndex b : victims) {
        directory_.erase(blocks_[b].lower);
        free_block(b);
        ++counters.evictions;
    }
}

template <class Owner, BlockDescription Type> void BlockCache<Owner, Type>::flush(bool packs) {
    counters.peak_bytes = std::max<std::uint64_t>(counters.peak_bytes, bytes());
    for (Key key = first_key; packs;) {
        const BlockIndex b =
            directory_.contains(key) ? directory_.floor(key) : directory_.after(key);
        if (b == no_block) break;
        key = blocks_[b].lower;
        host_.poll();
        if (dissolve(b)) continue; // perhaps into the next one, under the same key
        fill_up(b, false);
        key = blocks_[b].upper;
    }
    Arena<BlockIndex> changed(host_);
    for_each_cached([&](BlockIndex b) {
        if (blocks_[b].dirty) changed.push_back(b);
    });
    for (std::size_t i = 0; i < changed.size(); ++i) {
        ask_ahead(changed, i);
        write(changed[i], changed);
        host_.poll();
    }
    ABACUS_ASSERT(self().check_invariants(true) == nullptr);
}

template <class Owner, BlockDescription Type>
void BlockCache<Owner, Type>::ask_ahead(const Arena<BlockIndex> &blocks, std::size_t at) const {
    if (at + 1 < blocks.size() && blocks_[blocks[at + 1]].state == Block::cached)
        self().ask_for_contents(blocks[at + 1]);
    if (at + 2 < blocks.size()) ask_for_slots(blocks[at + 2]);
}

template <class Owner, BlockDescription Type>
EncodedPage BlockCache<Owner, Type>::encode(BlockIndex b) {
    const Stopwatch stopwatch(counters.translation_ns);
    const EncodedPage encoded = self().encode_page(b);
    if (encoded.size != 0) blocks_[b].capacity = capacity_.learn(blocks_[b].count, encoded.size);
    return encoded;
}

template <class Owner, BlockDescription Type>
void BlockCache<Owner, Type>::write(BlockIndex b, Arena<BlockIndex> &list) {
    EncodedPage encoded = encode(b);
    while (!encoded.fits) { // too many bytes, not too many slots
        list.push_back(halve(b));
        encoded = encode(b);
    }
    store(b, encoded);
}

template <class Owner, BlockDescription Type>
void BlockCache<Owner, Type>::store(BlockIndex b, const EncodedPage &encoded) {
    ABACUS_ASSERT(encoded.fits);
    const Stopwatch stopwatch(counters.translation_ns);
    Block &block = blocks_[b];
    abacus_page page{block.lower, encoded.bytes, encoded.size, block.location};
    ++counters.stores;
    if (block.location != 0) ++counters.rewrites;
    counters.bytes_written += encoded.size;
    host_.put(Type::page_kind, page);
    block.location = page.location;
    block.dirty = false;
}

} // namespace abacus
