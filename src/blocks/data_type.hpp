// What a type of data brings along to live in the block cache (blocks/block_cache.hpp).
//
// A data type is two things. A *description*, all of it known at compile time: what a record is,
// how many of them a block has room for, under which kind its pages are stored. And an *owner*,
// the class that derives from BlockCache<Owner, Description>: it knows the key of a record, makes
// pages of blocks and blocks of pages, and ties what is in the cache together. The cache calls
// the owner directly, so what is short is compiled in line.
//
//   a page comes in     open_page() checks it and tells its interval; the cache finds a block
//                       for it; tie() fills the slots, and ties the records to those cached
//   a record moves      the cache copies it to another slot; moved() tells all that name it
//   blocks leave        begin_eviction(), then for each block encode_page() if it has changed or
//                       survey() if it has not, and untie() for the same block right after;
//                       end_eviction() when the last one is untied: until then what has left
//                       stays readable for the others that leave
//
// Keys are never stored with a record. A key is a function of the record that stays the same
// as long as the record lives.
#pragma once

#include "blocks/block.hpp"

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace abacus {

/// What an opened page says of itself.
struct PageContents {
    Key lower, upper;         ///< the interval that it owns
    std::uint32_t records;    ///< at most as many as a block has slots
    bool is_outdated = false; ///< to be written anew, with other bytes for each record
};

/// A page made of a block; its bytes are valid until the next one is made.
struct EncodedPage {
    const unsigned char *bytes;
    std::size_t size; ///< also of a page that has too many bytes; 0 if that is not known
    bool fits;
};

/// Counts that the cache keeps; a data type may count more in a type of its own.
struct BlockCounters {
    std::uint64_t created = 0, deleted = 0; // records
    std::uint64_t loads = 0, stores = 0, rewrites = 0;
    std::uint64_t splits = 0, merges = 0;
    std::uint64_t evictions = 0, eviction_batches = 0;
    std::uint64_t bytes_read = 0, bytes_written = 0;
    std::uint64_t translation_ns = 0;
    std::uint64_t peak_bytes = 0;
};

template <class C>
concept CountsBlocks = requires(C &c) {
    c.created, c.deleted, c.loads, c.stores, c.rewrites, c.splits, c.merges, c.evictions;
    c.eviction_batches, c.bytes_read, c.bytes_written, c.translation_ns, c.peak_bytes;
};

/// Of fixed size. A free slot holds the next one of the chain and where its record moved.
template <class R>
concept BlockRecord = std::is_trivially_copyable_v<R> &&
    requires(R &slot, const R &record, std::uint32_t next, Handle moved) {
    { record.is_free() } -> std::same_as<bool>;
    { record.next_free() } -> std::convertible_to<std::uint32_t>;
    { record.moved_to() } -> std::same_as<Handle>;
    slot.set_free(next, moved);
};

template <class T>
concept BlockDescription = BlockRecord<typename T::Record> && CountsBlocks<typename T::Counters> &&
    std::is_trivially_copyable_v<typename T::Note> && requires {
    /// Slots of a block: more than a page of records can fill.
    { T::slots } -> std::convertible_to<std::uint32_t>;
    /// Above all handles.
    { T::handles_end } -> std::convertible_to<std::uint64_t>;
    /// Under which the host stores its pages.
    { T::page_kind } -> std::convertible_to<abacus_page_kind>;
    /// For messages: "A leaf", "leaves", "octree".
    { T::a_record } -> std::convertible_to<const char *>;
    { T::records } -> std::convertible_to<const char *>;
    { T::whole } -> std::convertible_to<const char *>;
};

template <class O, class T>
concept BlockOwner = requires(O &owner, const O &constant, const typename T::Record &record,
                              Handle h, BlockIndex b, const abacus_page &page) {
    /// The two words of a record's key; the second one may take long.
    { constant.code(record) } -> std::same_as<std::uint64_t>;
    { constant.part(record) } -> std::same_as<std::uint64_t>;
    /// Asks for what code() will read of a record, encode_page() of a block: hints, both.
    constant.ask_for_code(record);
    constant.ask_for_contents(b);
    /// Bytes that are in use beside the blocks.
    { constant.bytes_beside_blocks() } -> std::same_as<std::size_t>;
    owner.moved(h, h);
    /// Throws Error (corrupted) unless the page is sound.
    { owner.open_page(page) } -> std::same_as<PageContents>;
    owner.tie(b);
    { owner.encode_page(b) } -> std::same_as<EncodedPage>;
    owner.survey(b);
    owner.untie(b);
    owner.begin_eviction();
    owner.end_eviction();
};

} // namespace abacus
