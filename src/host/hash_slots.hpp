// A hash table of numbers. The things that have these numbers, and are looked for by
// something else, lie in an array of the owner.
//
// A slot holds the number and its hash, 8 bytes. Nearly always the hash tells apart what the
// owner would otherwise have to look up in cold memory. Linear probing puts numbers of one hash
// into one run of slots. So a number is where its hash says, or right behind, and one prefetch
// gets it in advance. At most half of the slots are taken, so runs stay short. When a slot is
// emptied, the later ones of its run move up, since tombstones would make runs long.
//
// The table grows in place. An entry whose home was slot i of n then has the home i or i + n.
// Entries move in the order of their run. None comes farther than where it was, or n behind
// that, so it meets no entry that is still to be moved.
#pragma once

#include "host/arena.hpp"

#include <cstdint>

namespace abacus {

/// `no_number`: one that is never added.
template <std::uint32_t no_number> class HashSlots {
public:
    static constexpr std::size_t slot_bytes = 2 * sizeof(std::uint32_t);

    static constexpr std::size_t few = 1024;

    /// `slots`: a power of two. A table that is never used may have none.
    explicit HashSlots(const Memory &memory, std::size_t slots = few) : slots_(memory) {
        if (slots > 0) add_slots(slots);
    }

    void add(std::uint32_t hash, std::uint32_t number) {
        if (2 * (count_ + 1) > slots_.size()) grow();
        put({hash, number});
        ++count_;
    }

    /// Takes out a number that is there, with this hash.
    void remove(std::uint32_t hash, std::uint32_t number) {
        std::size_t i = hash & mask_;
        while (slots_[i].number != number) i = next(i);
        for (std::size_t j = next(i); slots_[j].number != no_number; j = next(j)) {
            if (((j - slots_[j].hash) & mask_) < ((j - i) & mask_)) continue; // at home behind i
            slots_[i] = slots_[j];
            i = j;
        }
        slots_[i].number = no_number;
        --count_;
    }

    /// The number with this hash for which match(number) holds, or no_number.
    template <class Match> std::uint32_t find(std::uint32_t hash, Match match) const {
        for (std::size_t i = hash & mask_;; i = next(i)) {
            const Slot &slot = slots_[i];
            if (slot.number == no_number || (slot.hash == hash && match(slot.number)))
                return slot.number;
        }
    }
    /// The first number with this hash, which is nearly always the one that find() finds.
    std::uint32_t first(std::uint32_t hash) const {
        return find(hash, [](std::uint32_t) { return true; });
    }

    /// The slots that the other functions will read.
    void prefetch(std::uint32_t hash) const { __builtin_prefetch(&slots_[hash & mask_]); }

private:
    struct Slot {
        std::uint32_t hash;
        std::uint32_t number; // no_number of an empty one
    };
    static_assert(sizeof(Slot) == slot_bytes);

    std::size_t next(std::size_t i) const { return (i + 1) & mask_; }

    void put(const Slot &slot) {
        std::size_t i = slot.hash & mask_;
        while (slots_[i].number != no_number) i = next(i);
        slots_[i] = slot;
    }

    void grow() {
        const std::size_t n = slots_.size();
        std::size_t end = 0; // of a run
        while (slots_[end].number != no_number) ++end;
        add_slots(n);
        for (std::size_t i = end + 1; i < end + n; ++i) {
            Slot &slot = slots_[i & (n - 1)];
            if (slot.number == no_number) continue;
            const Slot moved = slot;
            slot.number = no_number;
            put(moved);
        }
    }

    /// So many more, empty; a power of two in all.
    void add_slots(std::size_t n) {
        slots_.resize(slots_.size() + n);
        std::fill(slots_.end() - n, slots_.end(), Slot{0, no_number});
        mask_ = slots_.size() - 1;
    }

    Arena<Slot> slots_;
    std::size_t mask_ = 0;
    std::size_t count_ = 0;
};

} // namespace abacus
