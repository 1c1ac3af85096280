// Placement: records move to the blocks that own their keys, and overfull blocks make room.
//
// A block has slots for more than a page takes, so what an operation makes finds room there.
// When the operation is over, a block that is overfull makes room in one of three ways, by
// where the code of the operation lies among its records, in curve order. Operations come in
// the same order.
//
//   Somewhere in the upper half: what lies behind the code is finished, since an operation
//   makes no record with a smaller code than its own. The block before, finished too,
//   takes as much of it as it has room for. If it has none, a cut at the code leaves a
//   well-filled page that will hardly be touched again (the sequential split); if more
//   lies behind than a page takes, the cut is where one is well filled.
//
//   Otherwise the block is cut at the median key.
//
// That is for operations that come close together. Where few of them meet a block that was
// stored, others will come another time, anywhere in it: it is cut at the median, and its
// halves are left as they are, room for more (block_cache_pack.hpp).
#pragma once

#include "blocks/block_cache.hpp"
#include "blocks/block_cache_pack.hpp"

#include <bit>
#include <string>

namespace abacus {

namespace placing {
inline constexpr double sequential_from = 0.5;
inline constexpr unsigned measured_each = 32; // full blocks
} // namespace placing

template <class Owner, BlockDescription Type>
BlockIndex BlockCache<Owner, Type>::place_elsewhere(std::uint64_t code) {
    // What is at the border of two blocks has records now in one, now in the other.
    std::swap(at_hand_[0], at_hand_[1]);
    if (at_hand_[0] == no_block || !blocks_[at_hand_[0]].surely_owns(code)) {
        const BlockIndex b = cached_owner({code, 0});
        at_hand_[0] = b != no_block && blocks_[b].surely_owns(code) ? b : no_block;
    }
    if (at_hand_[0] != no_block && has_slot(at_hand_[0])) return at_hand_[0];
    if (limbo_.empty() || !has_slot(limbo_.back())) limbo_.push_back(new_block(Block::limbo));
    return limbo_.back();
}

template <class Owner, BlockDescription Type>
BlockIndex BlockCache<Owner, Type>::home(const Record &record) {
    // Parts are expensive to compute, and nearly always the code alone tells the block.
    const std::uint64_t code = self().code(record);
    const BlockIndex b = cached_owner({code, 0});
    return b != no_block && blocks_[b].surely_owns(code) ? b : owner({code, self().part(record)});
}

template <class Owner, BlockDescription Type>
void BlockCache<Owner, Type>::bring_home(std::uint64_t code) {
    for (std::size_t i = 0; i < limbo_.size(); ++i) {
        const BlockIndex b = limbo_[i];
        for (std::uint32_t slot = 0; slot < blocks_[b].high_water; ++slot) {
            const Handle h = first_of(b) + slot;
            if (slots_[h].is_free()) continue;
            BlockIndex to = home(slots_[h]);
            while (to != no_block && blocks_[to].is_full()) {
                make_room(to, code);
                to = home(slots_[h]);
            }
            if (to == no_block) throw_corrupted("No page owns a part of the curve.", Type::whole);
            move(h, to);
        }
    }
    // The slots forward to where the records went until the block is used again.
    while (!limbo_.empty()) {
        free_block(limbo_.back());
        limbo_.pop_back();
    }
}

template <class Owner, BlockDescription Type>
void BlockCache<Owner, Type>::relieve(std::uint64_t code) {
    for (std::size_t i = 0; i < overfull_.size(); ++i) { // it may grow
        const BlockIndex b = overfull_[i];
        while (blocks_[b].state == Block::cached && blocks_[b].is_overfull()) make_room(b, code);
    }
    overfull_.clear();
}

template <class Owner, BlockDescription Type>
Handle BlockCache<Owner, Type>::move(Handle h, BlockIndex to) {
    const Handle moved = take_slot(to);
    slots_[moved] = slots_[h];
    self().moved(h, moved);
    give_back(h, moved);
    return moved;
}

template <class Owner, BlockDescription Type>
KeyCut &BlockCache<Owner, Type>::collect_places(BlockIndex b) {
    places_.clear();
    // Half of the block is ahead, and has not been used for long.
    for_each_record(b, [&](Handle h) { self().ask_for_code(slots_[h]); });
    for_each_record(b, [&](Handle h) { places_.add(self().code(slots_[h]), h); });
    // Parts are expensive to compute and rarely matter: only inside one code.
    const std::uint64_t least = places_.least_code(), greatest = places_.greatest_code();
    if (least == greatest || blocks_[b].has_parts())
        for (KeyCut::Place &place : places_) place.key.part = self().part(slots_[place.handle]);
    // A page may have been forged, and it is borders between these keys that blocks are cut at.
    if (blocks_[b].surely_owns(least) && blocks_[b].surely_owns(greatest)) return places_;
    for (const KeyCut::Place &place : places_)
        if (!blocks_[b].owns(place.key))
            throw_corrupted(std::string(Type::a_record) +
                                " lies in a page that does not own its key.",
                            Type::whole);
    return places_;
}

template <class Owner, BlockDescription Type>
void BlockCache<Owner, Type>::make_room(BlockIndex b, std::uint64_t code) {
    // A page is made now and then only to see how large it is, so that much is known before
    // the first is written; more often while little is known.
    if (std::has_single_bit(++full_blocks_) || full_blocks_ % placing::measured_each == 0) {
        encode(b);
        if (!blocks_[b].is_full()) return;
    }
    KeyCut &places = collect_places(b);
    const auto is_behind = [&](const KeyCut::Place &p) { return p.key.code < code; };
    const auto behind =
        static_cast<std::size_t>(std::count_if(places.begin(), places.end(), is_behind));
    BlockIndex upper;
    if (!has_changed_much(b) || behind < placing::sequential_from * places.size()) {
        upper = split_near(b, places, places.size() / 2);
    } else if (lend(b, places, behind)) {
        return;
    } else if (behind <= blocks_[b].capacity) {
        std::partition(places.begin(), places.end(), is_behind);
        upper = split_at(b, places, behind, {code, 0});
    } else {
        upper =
            split_near(b, places, static_cast<std::size_t>(packing::full * blocks_[b].capacity));
    }
    if (blocks_[upper].is_overfull()) note_overfull(upper);
}

template <class Owner, BlockDescription Type>
BlockIndex BlockCache<Owner, Type>::split_at(BlockIndex b, const KeyCut &places, std::size_t cut,
                                             const Key &border) {
    ABACUS_ASSERT(blocks_[b].lower < border && border < blocks_[b].upper);
    ++counters.splits;
    const BlockIndex right = new_block(Block::cached);
    Block &left = blocks_[b];
    blocks_[right].own(border, left.upper);
    blocks_[right].dirty = true;
    blocks_[right].leaving = left.leaving;
    if (left.settled != 0) blocks_[right].capacity = left.capacity;
    blocks_[right].used_at = left.used_at;
    left.own(left.lower, border);
    left.dirty = true;
    directory_.insert(border, right);
    share_settled(b, right, places.size() - cut, places.size());
    for (std::size_t i = cut; i < places.size(); ++i) move(places[i].handle, right);
    return right;
}

template <class Owner, BlockDescription Type>
BlockIndex BlockCache<Owner, Type>::split_near(BlockIndex b, KeyCut &places, std::size_t wanted) {
    const std::size_t cut = places.cut_near(wanted);
    if (cut == 0 || cut >= places.size())
        throw Error(ABACUS_ERROR_LIMIT, std::string("too many ") + Type::records + " share one key",
                    std::string("More ") + Type::records +
                        " than fit on a page have the same place on the curve.");
    return split_at(b, places, cut, places[cut].key);
}

template <class Owner, BlockDescription Type>
void BlockCache<Owner, Type>::cut(std::uint64_t code) {
    const Key border{code, 0};
    const BlockIndex b = owner(border);
    if (b == no_block) throw_corrupted("No page owns a part of the curve.", Type::whole);
    if (blocks_[b].lower == border) return;
    KeyCut &places = collect_places(b);
    const auto is_below = [&](const KeyCut::Place &p) { return p.key.code < code; };
    const auto upper = std::partition(places.begin(), places.end(), is_below);
    split_at(b, places, static_cast<std::size_t>(upper - places.begin()), border);
}

template <class Owner, BlockDescription Type>
BlockIndex BlockCache<Owner, Type>::halve(BlockIndex b) {
    KeyCut &places = collect_places(b);
    return split_near(b, places, places.size() / 2);
}

} // namespace abacus
