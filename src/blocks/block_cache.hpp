// The computational cache (dissertation §3.1.2, §4.4 to 4.10), for any type of data: records
// by direct handles, as in a program that has all of them in memory, over pages that hold them
// really. What a record is, and how it is tied to others, the type says (blocks/data_type.hpp).
//
// A block owns an interval of keys and holds the records whose keys fall into it; it maps to one
// stored page. The directory orders the cached intervals.
//
//   find     The page that owns a key has the greatest lower key that is not above it: one floor
//            search, first in the directory, then by the host (owner()).
//   place    A new record goes to the block that owns its key. When that block has no slot or is
//            not cached, the record goes to a limbo block for now: nothing is split or
//            loaded in the middle of an operation, and handles stay valid. settle() brings limbo
//            home and makes room in overfull blocks afterwards (block_cache_place.hpp).
//   evict    When the cache has outgrown its budget, trim() drops a tenth of the blocks,
//            those that will not be missed soon (block_cache_evict.hpp); changed ones are written
//            first. Nothing is evicted during an operation.
//
// An operation is what lies between two calls of settle(). Everything that loads may move the
// arrays: a reference to a record does not survive it, a handle does. settle() changes handles;
// a slot that a record left forwards to its new place until it is used again.
//
// The states of a block, and what leads from one to another:
//
//              place_elsewhere()              bring_home()
//   unused ────────────────────────► limbo ────────────────► unused
//
//   unused ──┬─ load() ────────────► cached, as its page ───────────── evict() ──► unused
//            │                        │              ▲
//            │    take_slot(), give_back(),          │ write()
//            │    mark_dirty()        ▼              │
//            └─ create_first_block(), ► cached, changed ── dissolve(), draw() ───► unused
//               split_at()                      its records are in other blocks now
//
// Invariants, when no operation is under way (check_invariants()):
//
//   1. The intervals of cached blocks are not empty, and no two have a key in common; with the
//      pages that are not cached they cover the curve.
//   2. The directory has the cached blocks, and no others, by their lower keys.
//   3. A record lies in the block that owns its key. (Of the records of a page that somebody has
//      forged this holds once a border is to be drawn between them: collect_places().)
//   4. Of the slots of a block that were ever used, the free ones are those of its chain, and the
//      others are as many as it counts.
//   5. A block without a page is marked as changed; so is each that differs from its page.
//   6. There is no limbo block, and no block is marked as leaving.
//   7. Each block is cached or unused; the latter are listed. A block at hand is cached.
#pragma once

#include "blocks/data_type.hpp"
#include "blocks/directory.hpp"
#include "blocks/key_cut.hpp"
#include "blocks/page_capacity.hpp"
#include "blocks/replacement.hpp"
#include "host/arena.hpp"
#include "host/assert.hpp"
#include "host/host.hpp"
#include "host/processor_cache.hpp"

#include <array>

namespace abacus {

/// Thrown where a cache that keeps within an interval would have to load a page of another one.
struct Foreign {};

/// `Owner` derives from this. The member functions that are not defined here are compiled where
/// the owner instantiates them: see block_cache_code.hpp.
template <class Owner, BlockDescription Type> class BlockCache {
public:
    using Record = typename Type::Record;
    using Counters = typename Type::Counters;

    BlockCache(const BlockCache &) = delete;
    BlockCache &operator=(const BlockCache &) = delete;

    static constexpr std::uint32_t slots = Type::slots;
    static constexpr BlockIndex block_of(Handle h) { return BlockIndex{to_number(h) / slots}; }
    /// Of a block's first slot.
    static constexpr Handle first_of(BlockIndex b) { return Handle{to_number(b) * slots}; }

    // ---- Records -------------------------------------------------------------

    const Record &record(Handle h) const { return slots_[h]; }
    /// Whether a handle kept from earlier is a record still (perhaps another one).
    bool is_live(Handle h) const {
        if (to_number(h) >= slots_.size()) return false;
        const BlockIndex b = block_of(h);
        return blocks_[b].state == Block::cached && h - first_of(b) < blocks_[b].high_water &&
               !slots_[h].is_free();
    }
    /// Where settle() took the record, or no_handle; another record, if its slot has been
    /// taken meanwhile, so no more than a hint.
    Handle follow(Handle h) const;
    /// Whether the record is in the block that owns its key.
    bool is_home(Handle h) const {
        const Record &record = slots_[h];
        const Block &block = blocks_[block_of(h)];
        const std::uint64_t code = self().code(record);
        return block.surely_owns(code) || block.owns({code, self().part(record)});
    }
    /// Whether the cached block around h owns the code.
    bool near(Handle h, std::uint64_t code) const { return blocks_[block_of(h)].surely_owns(code); }
    /// Lower key of the block, and of its page, that h is in.
    const Key &lower(Handle h) const { return blocks_[block_of(h)].lower; }
    /// The block that owns what comes on the curve behind a block; no_block if it is not cached.
    BlockIndex next_on_curve(BlockIndex b) const {
        return blocks_[b].upper == end_key ? no_block : cached_owner(blocks_[b].upper);
    }
    /// Whether the block that owns the key is in memory.
    bool is_cached(const Key &key) const { return cached_owner(key) != no_block; }
    /// Asks for the slots of a block: a stretch of memory, where prefetch instructions do.
    void ask_for_slots(BlockIndex b) const {
        prefetch(&slots_[first_of(b)], blocks_[b].high_water);
    }
    /// The block around h is in use, as those are that change: for callers that only read.
    void use(Handle h) { blocks_[block_of(h)].used_at = ++clock_; }
    /// Calls visit(handle) for the records of the block that owns the key, loaded if
    /// need be; returns the lower key of the next block, end_key after the last.
    template <class Visit> Key visit(const Key &key, Visit visit);

    // ---- Change ----------------------------------------------------------------

    /// Gives an empty set of pages its first block.
    void create_first_block();
    /// A slot for a record with this code, whose content is then to be set.
    Handle allot(std::uint64_t code) {
        BlockIndex b = at_hand_[0];
        if (b == no_block || !has_slot(b) || !blocks_[b].surely_owns(code)) [[unlikely]]
            b = place_elsewhere(code);
        ++counters.created;
        const Handle h = take_slot(b);
        if (blocks_[b].is_overfull()) [[unlikely]]
            note_overfull(b);
        return h;
    }
    void set(Handle h, const Record &record) { slots_[h] = record; }
    /// The block's page has to be written.
    void mark_dirty(Handle h) {
        Block &block = blocks_[block_of(h)];
        block.dirty = true;
        block.used_at = clock_;
    }
    /// Ends an operation: limbo comes home, overfull blocks make room. Sequential splits cut at
    /// `code`, which is 0 if the operations do not come along the curve. Returns whether
    /// records moved: see follow().
    bool settle(std::uint64_t code) {
        ++clock_;
        if (replacement_.reached(code)) [[unlikely]]
            replacement_.begin_pass(bytes());
        if (overfull_.empty() && limbo_.empty()) [[likely]]
            return false;
        bring_home(code);
        relieve(code);
        return true;
    }
    /// Others need some of the memory.
    void set_budget(std::size_t bytes) { replacement_.set_budget(bytes); }
    /// Whether this pass along the curve is the last: what it leaves behind is finished.
    void expect_last_pass(bool last) { replacement_.expect_last_pass(last); }
    /// Evicts what is beyond the budget, or in the last pass beyond what that needs. Handles may
    /// die: see is_live().
    void trim() {
        if (bytes() > replacement_.limit()) [[unlikely]]
            shrink();
    }
    /// Writes every changed block; they stay cached. `packs`: they fill up from one another first,
    /// so that some are saved.
    void flush(bool packs = true);
    /// Lets a block, and so a page, begin with this code.
    void cut(std::uint64_t code);
    /// From now on pages are loaded only from an interval that they are cut at, its ends included;
    /// Foreign is thrown where another one would be.
    void keep_within(std::uint64_t first, std::uint64_t last) {
        first_code_ = first;
        codes_beyond_first_ = last - first;
    }
    /// Whether a code is in that interval.
    bool keeps(std::uint64_t code) const { return code - first_code_ <= codes_beyond_first_; }
    /// Records that a block takes, if nothing else is known of it.
    std::uint32_t capacity() const { return capacity_.usual(); }

    // ---- The cache as a whole --------------------------------------------------

    const Host &host() const { return host_; }
    void poll() const { host_.poll(); }
    std::size_t bytes() const {
        return cached_blocks_ * block_bytes + self().bytes_beside_blocks();
    }
    std::size_t cached_blocks() const { return cached_blocks_; }
    /// What is wrong with the cache, between two operations; null if nothing is. `forged`: pages
    /// may have been, and what only a sound page has is not asked for.
    const char *check_invariants(bool forged = false) const;

    Counters counters{};

protected:
    /// `budget`: bytes that the cache may take.
    BlockCache(const Host &host, std::size_t budget, const Replacement::LastPassRoom &last_pass,
               const PageCapacity &capacity);
    ~BlockCache() = default;

    bool has_slot(BlockIndex b) const { return blocks_[b].count < slots; }
    /// Frees a slot; `moved` is where its record went.
    void give_back(Handle h, Handle moved) {
        const BlockIndex b = block_of(h);
        Block &block = blocks_[b];
        ABACUS_ASSERT(!slots_[h].is_free());
        slots_[h].set_free(block.free, moved);
        block.free = h - first_of(b);
        --block.count;
        block.dirty = true;
        block.used_at = clock_;
    }
    template <class Visit> void for_each_cached(Visit visit) const {
        for (std::uint32_t n = 0; n < blocks_.size(); ++n)
            if (blocks_[BlockIndex{n}].state == Block::cached) visit(BlockIndex{n});
    }
    template <class Visit> void for_each_record(BlockIndex b, Visit visit) const {
        for (std::uint32_t slot = 0; slot < blocks_[b].high_water; ++slot) {
            const Handle h = first_of(b) + slot;
            if (!slots_[h].is_free()) visit(h);
        }
    }

    BlockIndex cached_owner(const Key &key) const;
    /// Whether a cached block begins there, and so its page is cached.
    bool has_block_at(const Key &lower) const { return directory_.contains(lower); }
    /// The block that owns the key, loaded if need be; no_block if no page does.
    BlockIndex owner(const Key &key);
    BlockIndex load(const abacus_page &page);
    /// The block that owns the code, if it has a record; else the nearest one before it on the
    /// curve, or else after it, that has one. All are loaded if need be. no_block: there is none.
    BlockIndex nearest_with_records(std::uint64_t code);

    /// Begins a page that comes in the order of keys: a block with so many records, for the owner
    /// to fill and to tie.
    BlockIndex begin_appended(const Key &lower, const Key &upper, std::size_t records);
    /// Writes it, and keeps nothing of it; false, and nothing is written, if it has too many bytes.
    bool end_appended(BlockIndex b);

private:
    static constexpr std::size_t block_bytes =
        sizeof(Block) + sizeof(typename Type::Note) + slots * sizeof(Record);

    Owner &self() { return static_cast<Owner &>(*this); }
    const Owner &self() const { return static_cast<const Owner &>(*this); }

    // block_cache_code.hpp
    BlockIndex new_block(Block::State state);
    void free_block(BlockIndex b);
    const char *check_block(BlockIndex b, bool forged) const;

    // block_cache_place.hpp
    BlockIndex place_elsewhere(std::uint64_t code);
    void note_overfull(BlockIndex b) {
        if (overfull_.empty() || overfull_.back() != b) overfull_.push_back(b);
    }
    Handle take_slot(BlockIndex b) {
        ABACUS_ASSERT(has_slot(b));
        Block &block = blocks_[b];
        std::uint32_t slot = block.free;
        if (slot != no_slot)
            block.free = slots_[first_of(b) + slot].next_free();
        else
            slot = block.high_water++;
        ++block.count;
        block.dirty = true;
        block.used_at = clock_;
        return first_of(b) + slot;
    }
    void bring_home(std::uint64_t code);
    void relieve(std::uint64_t code);
    /// The block that owns the record's key, loaded if need be.
    BlockIndex home(const Record &record);
    Handle move(Handle h, BlockIndex to);
    /// The block's records and their keys, until those of another block are collected.
    KeyCut &collect_places(BlockIndex b);
    void make_room(BlockIndex b, std::uint64_t code);
    /// Cuts the block, whose records from places[cut] on, and no others, have keys from
    /// `border` on; returns the new block, the upper part.
    BlockIndex split_at(BlockIndex b, const KeyCut &places, std::size_t cut, const Key &border);
    /// Cuts it where so many, or nearly, are below.
    BlockIndex split_near(BlockIndex b, KeyCut &places, std::size_t wanted);
    BlockIndex halve(BlockIndex b);

    // block_cache_pack.hpp
    /// Moves at most so many records, those with the least keys, to the block before, if that
    /// has room for them; so that a block that has nearly all its records is not cut.
    bool lend(BlockIndex b, KeyCut &places, std::size_t most);
    /// Gives all records of a block that was never stored, or has lost many, to its
    /// neighbours on the curve, if they take them; so that no page is written half empty.
    bool dissolve(BlockIndex b);
    struct Heirs;
    Heirs heirs(BlockIndex b, bool is_sparse) const;
    /// The records below the cut to the left one, the others to the right one; either may be
    /// no_block if it gets none.
    void share_out(BlockIndex b, const KeyCut &places, std::size_t cut, BlockIndex left,
                   BlockIndex right);
    /// Removes the block's page, if it is stored.
    void erase_page(BlockIndex b);
    /// Fills a block that is to be written from the next one on the curve, if that is to be
    /// written too, with `only_leaving` now: so that pages are full from the beginning of the
    /// curve on.
    void fill_up(BlockIndex b, bool only_leaving);
    /// How many records the block may take from its neighbours.
    std::size_t room_to_pack(BlockIndex b) const;
    /// Whether the block is new, or has won or lost more records since it was loaded than a
    /// few operations bring with them.
    bool has_changed_much(BlockIndex b) const;
    /// Before so many records, of all that are left there, move from one block to another.
    void share_settled(BlockIndex from, BlockIndex to, std::size_t moving, std::size_t all);
    /// Whether the second block continues the first one, and is to be written as well.
    bool is_followed_by(BlockIndex b, BlockIndex next) const;
    /// Moves at most so many records, those with the least keys, from the next block, whose
    /// places these are. False if there is no border for it.
    bool draw(BlockIndex b, BlockIndex next, KeyCut &places, std::size_t most);

    // block_cache_evict.hpp
    void shrink();
    void evict(Arena<BlockIndex> &victims);
    /// Asks for what the blocks after this one of a list need to be made pages: the contents of
    /// the next, and the slots of the one after it, which tell its contents.
    void ask_ahead(const Arena<BlockIndex> &blocks, std::size_t at) const;
    EncodedPage encode(BlockIndex b);
    /// Makes the block's page and stores it. A block that has too many bytes is halved first, and
    /// what is cut off is added to the list.
    void write(BlockIndex b, Arena<BlockIndex> &list);
    void store(BlockIndex b, const EncodedPage &encoded);

    PageCapacity capacity_;
    unsigned full_blocks_ = 0; // so far
    DirectoryOf<BlockIndex> directory_;
    Arena<BlockIndex> unused_blocks_;
    Arena<BlockIndex> overfull_; // to make room when the operation ends, some more than once
    Arena<BlockIndex> limbo_;
    KeyCut places_;
    Replacement replacement_;
    std::size_t cached_blocks_ = 0;
    std::array<BlockIndex, 2> at_hand_{no_block, no_block}; // took the last records
    std::uint64_t clock_ = 0; // operations so far, for the replacement
    std::uint64_t first_code_ = 0, codes_beyond_first_ = ~std::uint64_t{0}; // of what is loaded

protected:
    const Host &host_;
    Arena<Block, BlockIndex> blocks_;
    Arena<Record, Handle> slots_;                  // so many of each block
    Arena<typename Type::Note, BlockIndex> notes_; // the owner's, of each block; zero at first
};

template <class Owner, BlockDescription Type>
template <class Visit>
Key BlockCache<Owner, Type>::visit(const Key &key, Visit visit) {
    const BlockIndex b = owner(key);
    if (b == no_block) throw_corrupted("No page owns a part of the curve.", Type::whole);
    blocks_[b].used_at = ++clock_; // page by page is an order of use, too
    // What visit() loads goes to other blocks: this one keeps its records.
    for_each_record(b, visit);
    return blocks_[b].upper;
}

} // namespace abacus
