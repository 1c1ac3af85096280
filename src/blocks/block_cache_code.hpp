// The member functions of the block cache that are compiled once for each type of data: the
// source file that instantiates a cache includes this one.
#pragma once

#include "blocks/block_cache_evict.hpp"
#include "blocks/block_cache_place.hpp"
#include "host/stopwatch.hpp"

namespace abacus {

template <class Owner, BlockDescription Type>
BlockCache<Owner, Type>::BlockCache(const Host &host, std::size_t budget,
                                    const Replacement::LastPassRoom &last_pass,
                                    const PageCapacity &capacity)
    : capacity_(capacity), directory_(host), unused_blocks_(host), overfull_(host), limbo_(host),
      places_(host), replacement_(host, budget, last_pass), host_(host), blocks_(host),
      slots_(host), notes_(host) {
    static_assert(BlockOwner<Owner, Type>);
}

template <class Owner, BlockDescription Type>
Handle BlockCache<Owner, Type>::follow(Handle h) const {
    // A record moves from limbo, or with a part of its block, once or twice.
    for (int i = 0; i < 4 && to_number(h) < slots_.size(); ++i) {
        if (is_live(h)) return h;
        if (!slots_[h].is_free()) break;
        h = slots_[h].moved_to();
    }
    return no_handle;
}

template <class Owner, BlockDescription Type>
BlockIndex BlockCache<Owner, Type>::new_block(Block::State state) {
    BlockIndex b;
    if (!unused_blocks_.empty()) {
        b = unused_blocks_.back();
        unused_blocks_.pop_back();
    } else {
        const std::size_t known = blocks_.size();
        b = static_cast<BlockIndex>(known);
        if ((known + 1) * slots >= Type::handles_end)
            throw Error(ABACUS_ERROR_LIMIT, "the computational cache has too many blocks", {},
                        "Lower abacus.cache_size.");
        blocks_.resize(known + 1);
        notes_.resize(known + 1);
        slots_.resize((known + 1) * slots);
    }
    Block &block = blocks_[b];
    block = Block{};
    block.capacity = capacity_.usual();
    block.free = no_slot;
    block.state = state;
    block.used_at = clock_;
    notes_[b] = {};
    ++cached_blocks_;
    return b;
}

template <class Owner, BlockDescription Type>
void BlockCache<Owner, Type>::free_block(BlockIndex b) {
    blocks_[b].state = Block::unused;
    unused_blocks_.push_back(b);
    --cached_blocks_;
    for (BlockIndex &near : at_hand_)
        if (near == b) near = no_block;
}

template <class Owner, BlockDescription Type> void BlockCache<Owner, Type>::create_first_block() {
    const BlockIndex b = new_block(Block::cached);
    blocks_[b].own(first_key, end_key);
    blocks_[b].dirty = true;
    directory_.insert(first_key, b);
}

template <class Owner, BlockDescription Type>
BlockIndex BlockCache<Owner, Type>::cached_owner(const Key &key) const {
    const BlockIndex b = directory_.floor(key);
    return b != no_block && blocks_[b].owns(key) ? b : no_block;
}

template <class Owner, BlockDescription Type>
BlockIndex BlockCache<Owner, Type>::owner(const Key &key) {
    const BlockIndex cached = cached_owner(key);
    if (cached != no_block) return cached;
    if (!keeps(key.code)) throw Foreign{};
    const Stopwatch stopwatch(counters.translation_ns);
    abacus_page page{};
    if (!host_.find(Type::page_kind, key, page)) return no_block;
    const BlockIndex b = load(page);
    if (!blocks_[b].owns(key)) throw_corrupted("No page owns a part of the curve.", Type::whole);
    return b;
}

template <class Owner, BlockDescription Type>
BlockIndex BlockCache<Owner, Type>::load(const abacus_page &page) {
    ++counters.loads;
    counters.bytes_read += page.size;
    const PageContents contents = self().open_page(page);
    ABACUS_ASSERT(contents.records <= slots);
    if (!(contents.lower == page.key))
        throw_corrupted("A page is stored under another page's key.", Type::whole);
    const BlockIndex before = directory_.floor(contents.lower);
    const BlockIndex after = directory_.after(contents.lower);
    if ((before != no_block && contents.lower < blocks_[before].upper) ||
        (after != no_block && blocks_[after].lower < contents.upper))
        throw_corrupted("Two pages own the same part of the curve.", Type::whole);

    const BlockIndex b = new_block(Block::cached);
    Block &block = blocks_[b];
    block.own(contents.lower, contents.upper);
    block.location = page.location;
    block.count = block.high_water = static_cast<std::uint16_t>(contents.records);
    if (contents.is_outdated) {
        block.dirty = true; // and as if it were new: it may be packed
    } else {
        block.settled = block.count;
        block.capacity = capacity_.learn(block.count, page.size);
    }
    directory_.insert(block.lower, b);
    self().tie(b);
    return b;
}

template <class Owner, BlockDescription Type>
BlockIndex BlockCache<Owner, Type>::nearest_with_records(std::uint64_t code) {
    // A page can be empty, the first one above all, when the domain reaches beyond the data.
    const auto place = [&](Key key) -> Block & { // a copy: it may be in a block
        const BlockIndex b = owner(key);
        if (b == no_block) throw_corrupted("No page owns a part of the curve.", Type::whole);
        return blocks_[b];
    };
    const Key key{code, 0};
    const Block *block = &place(key);
    const Key upper = block->upper;
    while (block->count == 0 && !(block->lower == first_key))
        block = &place(predecessor(block->lower));
    if (block->count == 0) block = &place(upper == end_key ? key : upper);
    while (block->count == 0 && !(block->upper == end_key)) block = &place(block->upper);
    return block->count == 0 ? no_block : static_cast<BlockIndex>(block - blocks_.data());
}

template <class Owner, BlockDescription Type>
BlockIndex BlockCache<Owner, Type>::begin_appended(const Key &lower, const Key &upper,
                                                   std::size_t records) {
    const BlockIndex b = new_block(Block::cached);
    blocks_[b].own(lower, upper);
    blocks_[b].count = blocks_[b].high_water = static_cast<std::uint16_t>(records);
    directory_.insert(lower, b);
    return b;
}

template <class Owner, BlockDescription Type>
bool BlockCache<Owner, Type>::end_appended(BlockIndex b) {
    const EncodedPage encoded = encode(b);
    if (encoded.fits) store(b, encoded);
    blocks_[b].dirty = false;
    Arena<BlockIndex> victims(host_);
    victims.push_back(b);
    evict(victims);
    return encoded.fits;
}

// ---- Invariants: see block_cache.hpp ------------------------------------------------

template <class Owner, BlockDescription Type>
const char *BlockCache<Owner, Type>::check_block(BlockIndex b, bool forged) const {
    const Block &block = blocks_[b];
    if (!(block.lower < block.upper)) return "an interval is empty";
    if (block.sure_lower != block.lower.code + (block.lower.part != 0) ||
        block.sure_upper != block.upper.code)
        return "a block is not sure of what it owns";
    if (!directory_.contains(block.lower) || directory_.floor(block.lower) != b)
        return "a cached block is not in the directory";
    const BlockIndex next = directory_.after(block.lower);
    if (next != no_block && blocks_[next].lower < block.upper) return "two intervals overlap";
    if (block.location == 0 && !block.dirty) return "a block without a page is not changed";
    if (block.leaving) return "a block has not left";
    std::uint32_t used = 0, free = 0;
    for_each_record(b, [&](Handle) { ++used; });
    for (std::uint32_t slot = block.free; slot != no_slot && free <= block.high_water; ++free) {
        if (slot >= block.high_water || !slots_[first_of(b) + slot].is_free())
            return "a chain of free slots leads astray";
        slot = slots_[first_of(b) + slot].next_free();
    }
    if (used != block.count || used + free != block.high_water) return "slots are counted wrong";
    bool at_home = true;
    // What came with a forged page may lie anywhere.
    if (!forged || block.settled == 0)
        for_each_record(b, [&](Handle h) { at_home = at_home && is_home(h); });
    return at_home ? nullptr : "a record lies in a block that does not own its key";
}

template <class Owner, BlockDescription Type>
const char *BlockCache<Owner, Type>::check_invariants(bool forged) const {
    if (!limbo_.empty()) return "limbo is not empty";
    std::size_t cached = 0, unused = 0, listed = 0;
    const char *fault = nullptr;
    for (const Block &block : blocks_) {
        if (block.state == Block::limbo) return "a block is in limbo";
        unused += block.state == Block::unused;
    }
    for_each_cached([&](BlockIndex b) {
        ++cached;
        if (fault == nullptr) fault = check_block(b, forged);
    });
    if (fault != nullptr) return fault;
    for (Key key = first_key;; ++listed) {
        const BlockIndex b =
            directory_.contains(key) ? directory_.floor(key) : directory_.after(key);
        if (b == no_block) break;
        key = blocks_[b].upper;
    }
    if (listed != cached || cached_blocks_ != cached) return "cached blocks are counted wrong";
    if (unused_blocks_.size() != unused) return "unused blocks are counted wrong";
    for (const BlockIndex b : at_hand_)
        if (b != no_block && blocks_[b].state != Block::cached) return "a block at hand is gone";
    return nullptr;
}

} // namespace abacus
