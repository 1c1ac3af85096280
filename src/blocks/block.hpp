// A page in the cache: the interval of keys that it owns, and the slots for its records.
//
// Slots are taken from a chain of those given back, or else from behind all that were ever used.
#pragma once

#include "keys/key.hpp"

namespace abacus {

/// Numbers a block; a type of its own, so that none is taken for a handle.
enum class BlockIndex : std::uint32_t {};
inline constexpr BlockIndex no_block{0xffffffffu};
constexpr std::uint32_t to_number(BlockIndex b) { return static_cast<std::uint32_t>(b); }
/// Numbers a record: block * slots of a block + slot.
enum class Handle : std::uint32_t {};
inline constexpr Handle no_handle{0xffffffffu};
constexpr std::uint32_t to_number(Handle h) { return static_cast<std::uint32_t>(h); }
/// The one that comes so many slots behind another, in its block.
constexpr Handle operator+(Handle h, std::uint32_t slots) { return Handle{to_number(h) + slots}; }
/// Slots from the second to the first: huge if it comes before.
constexpr std::uint32_t operator-(Handle a, Handle b) { return to_number(a) - to_number(b); }
/// Ends the chain of free slots.
inline constexpr std::uint32_t no_slot = 0xffffffffu;

struct Block {
    enum State : std::uint8_t { unused, cached, limbo };
    Key lower, upper;
    std::uint64_t sure_lower, sure_upper; // codes that it owns whatever their part
    std::uint64_t location;               // of the stored page; 0 = none
    std::uint64_t used_at;
    std::uint16_t count;      // records
    std::uint16_t capacity;   // records that it takes before it is split
    std::uint16_t high_water; // slots ever used
    std::uint16_t settled;    // as many of them as were loaded, wherever they lie now
    std::uint32_t free;       // chain of slots given back
    State state;
    bool dirty;
    bool leaving; // being evicted

    void own(const Key &from, const Key &to) {
        lower = from;
        upper = to;
        sure_lower = from.code + (from.part != 0);
        sure_upper = to.code;
    }
    bool surely_owns(std::uint64_t code) const { return sure_lower <= code && code < sure_upper; }
    bool is_full() const { return count >= capacity; }
    bool is_overfull() const { return count > capacity; }
    bool owns(const Key &key) const { return lower <= key && key < upper; }
    bool has_parts() const { return lower.part != 0 || upper.part != 0; }
};

} // namespace abacus
