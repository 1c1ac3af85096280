// Packing: how blocks come to fill their pages. A block lends to the one before it, dissolves
// among its neighbours, or fills up from the next one; but only with what is to be written anyway.
//
// Neighbours take no more from one another than leaves a little room: else the first change of a
// page would always cut it. And where few operations have met a block that was stored, it is
// left as it is, room for more. What such changes leave hardly filled is merged when it is sparse.
#pragma once

#include "blocks/block_cache.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace abacus {

/// Shares of a full block.
namespace packing {
inline constexpr double full = 0.95; // as neighbours fill it
inline constexpr double sparse = 0.6;
inline constexpr double much = 1.0 / 12;
inline constexpr double least_move = 1.0 / 16;
} // namespace packing

template <class Owner, BlockDescription Type>
bool BlockCache<Owner, Type>::lend(BlockIndex b, KeyCut &places, std::size_t most) {
    const BlockIndex before = directory_.before(blocks_[b].lower);
    if (before == no_block || !blocks_[before].dirty || !is_followed_by(before, b)) return false;
    const std::size_t room = room_to_pack(before);
    return room >= packing::least_move * blocks_[b].capacity &&
           draw(before, b, places, std::min(room, most));
}

/// The neighbours of a block on the curve that may take its records, and for how many they have
/// room; no_block where there is none.
template <class Owner, BlockDescription Type> struct BlockCache<Owner, Type>::Heirs {
    BlockIndex left, right;
    std::size_t room_left, room_right;
};

template <class Owner, BlockDescription Type>
typename BlockCache<Owner, Type>::Heirs BlockCache<Owner, Type>::heirs(BlockIndex b,
                                                                       bool is_sparse) const {
    const Key lower = blocks_[b].lower, upper = blocks_[b].upper;
    const BlockIndex left = directory_.before(lower), right = directory_.after(lower);
    const auto suits = [&](BlockIndex n) { return blocks_[n].dirty && !blocks_[n].has_parts(); };
    const bool suits_left = left != no_block && blocks_[left].upper == lower && suits(left);
    // The left neighbour keeps its key; the right one's key changes.
    const bool suits_right = right != no_block && blocks_[right].lower == upper && suits(right) &&
                             (blocks_[right].location == 0 || is_sparse);
    return {suits_left ? left : no_block, suits_right ? right : no_block,
            suits_left ? room_to_pack(left) : 0, suits_right ? room_to_pack(right) : 0};
}

template <class Owner, BlockDescription Type> bool BlockCache<Owner, Type>::dissolve(BlockIndex b) {
    // What is stored is only touched where it is written anyway and has lost much.
    const bool is_sparse = blocks_[b].count < packing::sparse * blocks_[b].capacity;
    if (blocks_[b].has_parts() || !blocks_[b].dirty || (blocks_[b].location != 0 && !is_sparse))
        return false;
    const auto [left, right, room_left, room_right] = heirs(b, is_sparse);
    const std::size_t n = blocks_[b].count;
    if ((left == no_block && right == no_block) || room_left + room_right < n) return false;

    KeyCut &places = collect_places(b);
    std::size_t cut =
        room_left >= n ? n : std::min(room_left, (room_left + n - room_right + 1) / 2);
    if (room_right >= n) cut = 0;
    if (cut > 0 && cut < n) {
        cut = places.cut_near(cut);
        if (cut > room_left || n - cut > room_right) return false;
    }
    // An empty block's interval goes to either.
    const bool to_right = n == 0 ? right != no_block : cut < n,
               to_left = n == 0 ? !to_right : cut > 0;
    share_out(b, places, cut, to_left ? left : no_block, to_right ? right : no_block);
    ++counters.merges;
    return true;
}

template <class Owner, BlockDescription Type>
void BlockCache<Owner, Type>::share_out(BlockIndex b, const KeyCut &places, std::size_t cut,
                                        BlockIndex left, BlockIndex right) {
    const Key lower = blocks_[b].lower, upper = blocks_[b].upper;
    const bool to_left = left != no_block, to_right = right != no_block;
    const std::size_t n = places.size();
    const Key border = !to_left ? lower : !to_right ? upper : places[cut].key;
    // Their age stays: they are no more in use than before.
    const std::uint64_t left_used = to_left ? blocks_[left].used_at : 0;
    const std::uint64_t right_used = to_right ? blocks_[right].used_at : 0;
    if (to_left) share_settled(b, left, cut, n);
    if (to_right) share_settled(b, right, n - cut, n - cut);
    for (std::size_t i = 0; i < n; ++i) move(places[i].handle, i < cut ? left : right);
    directory_.erase(lower);
    if (to_left) {
        blocks_[left].own(blocks_[left].lower, border);
        blocks_[left].used_at = left_used;
    }
    if (to_right) {
        directory_.erase(upper);
        erase_page(right);
        // The page under the same key is its own now.
        if (border == lower) std::swap(blocks_[right].location, blocks_[b].location);
        blocks_[right].own(border, blocks_[right].upper);
        blocks_[right].used_at = right_used;
        directory_.insert(border, right);
    }
    erase_page(b);
    free_block(b);
}

template <class Owner, BlockDescription Type>
void BlockCache<Owner, Type>::fill_up(BlockIndex b, bool only_leaving) {
    const BlockIndex next = directory_.after(blocks_[b].lower);
    if (next == no_block || !blocks_[b].dirty || !has_changed_much(b) || !is_followed_by(b, next) ||
        (only_leaving && !blocks_[next].leaving))
        return;
    const std::size_t room = room_to_pack(b);
    if (room < packing::least_move * blocks_[b].capacity && room < blocks_[next].count)
        return; // not worth it
    draw(b, next, collect_places(next), room);
}

template <class Owner, BlockDescription Type>
std::size_t BlockCache<Owner, Type>::room_to_pack(BlockIndex b) const {
    const auto full = static_cast<std::uint32_t>(packing::full * blocks_[b].capacity);
    return full - std::min<std::uint32_t>(full, blocks_[b].count);
}

template <class Owner, BlockDescription Type>
bool BlockCache<Owner, Type>::has_changed_much(BlockIndex b) const {
    const int settled = blocks_[b].settled, change = static_cast<int>(blocks_[b].count) - settled;
    return settled == 0 || std::abs(change) >= packing::much * blocks_[b].capacity;
}

template <class Owner, BlockDescription Type>
void BlockCache<Owner, Type>::share_settled(BlockIndex from, BlockIndex to, std::size_t moving,
                                            std::size_t all) {
    if (moving == 0) return;
    const std::size_t share = blocks_[from].settled * moving / all;
    blocks_[from].settled = static_cast<std::uint16_t>(blocks_[from].settled - share);
    // Of many blocks that became one there may be more than it has room to tell.
    blocks_[to].settled =
        static_cast<std::uint16_t>(std::min<std::size_t>(blocks_[to].settled + share, 0xffff));
}

template <class Owner, BlockDescription Type>
bool BlockCache<Owner, Type>::is_followed_by(BlockIndex b, BlockIndex next) const {
    return blocks_[next].lower == blocks_[b].upper && blocks_[next].dirty &&
           !blocks_[b].has_parts() && !blocks_[next].has_parts();
}

template <class Owner, BlockDescription Type>
bool BlockCache<Owner, Type>::draw(BlockIndex b, BlockIndex next, KeyCut &places,
                                   std::size_t most) {
    ABACUS_ASSERT(places.size() == blocks_[next].count);
    const Key border = blocks_[next].lower, upper = blocks_[next].upper;
    std::size_t cut = places.size();
    if (cut > most) cut = places.cut_near(most);
    if (cut > most) return false;
    const std::uint64_t used = blocks_[b].used_at, next_used = blocks_[next].used_at;
    const bool is_whole = cut == places.size();
    const Key moved = is_whole ? upper : places[cut].key;
    share_settled(next, b, cut, places.size());
    for (std::size_t i = 0; i < cut; ++i) move(places[i].handle, b);
    directory_.erase(border);
    erase_page(next); // it has another key now
    blocks_[b].own(blocks_[b].lower, moved);
    blocks_[b].used_at = used; // no more in use than before
    if (is_whole) {
        free_block(next);
        ++counters.merges;
    } else {
        blocks_[next].own(moved, upper);
        blocks_[next].used_at = next_used;
        directory_.insert(moved, next);
    }
    return true;
}

template <class Owner, BlockDescription Type>
void BlockCache<Owner, Type>::erase_page(BlockIndex b) {
    Block &block = blocks_[b];
    if (block.location == 0) return;
    host_.erase(Type::page_kind, {block.lower, nullptr, 0, block.location});
    block.location = 0;
}

} // namespace abacus
