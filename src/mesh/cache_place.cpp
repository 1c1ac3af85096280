// Placement: simplices move to the blocks that own their keys, and full blocks lend to
// the one before them or split in two along the curve.
#include "mesh/cache.hpp"

#include "host/processor_cache.hpp"

#include <bit>
#include <utility>

namespace abacus {

// A block has slots for more than a page takes, so what an operation makes finds room there.
// When the operation is over, a block that is overfull makes room in one of three ways, by
// where the point being inserted lies among its simplices, in curve order. Points come in
// the same order.
//
//   Somewhere in the upper half: what lies behind the point is finished, since a
//   simplex of the point has no smaller code than it. The block before, finished too,
//   takes as much of it as it has room for. If it has none, a cut at the point's code
//   leaves a well-filled page that will hardly be touched again (the sequential split);
//   if more lies behind than a page takes, the cut is where one is well filled.
//
//   Otherwise the block is cut at the median key.
//
// That is for points that come close together. Where few of them meet a block that was
// stored, others will come another time, anywhere in it: it is cut at the median, and its
// halves are left as they are, room for more. For the same reason neighbours take no more
// from one another than leaves a little room: else the first change of a page would always
// cut it. What such changes leave hardly filled is merged when it is sparse.
namespace {
constexpr double sequential_from = 0.5;
constexpr unsigned measured_each = 32; // full blocks
// Of a full block:
constexpr double packed = 0.95;
constexpr double sparse = 0.6;
constexpr double much = 1.0 / 12;
constexpr double least_move = 1.0 / 16;
} // namespace

template <int D> BlockIndex Cache<D>::home(const Simplex<D> &s) {
    // Parts are dear to compute, and nearly always the code alone tells the block.
    const std::uint64_t code = this->code(s);
    const BlockIndex b = cached_owner({code, 0});
    return b != no_block && blocks_[b].surely_owns(code) ? b : owner({code, part(s)});
}

template <int D> void Cache<D>::bring_home(std::uint64_t code) {
    for (std::size_t i = 0; i < limbo_.size(); ++i) {
        const BlockIndex b = limbo_[i];
        for (std::uint32_t slot = 0; slot < blocks_[b].high_water; ++slot) {
            const Handle h = b * block_slots<D> + slot;
            if (slots_[h].is_free()) continue;
            BlockIndex to = home(slots_[h]);
            while (to != no_block && blocks_[to].is_full()) {
                make_room(to, code);
                to = home(slots_[h]);
            }
            if (to == no_block) throw_corrupted("No page owns a part of the curve.");
            move(h, to);
        }
    }
    // The slots forward to where the simplices went until the block is used again.
    while (!limbo_.empty()) {
        free_block(limbo_.back());
        limbo_.pop_back();
    }
}

template <int D> void Cache<D>::relieve(std::uint64_t code) {
    for (std::size_t i = 0; i < overfull_.size(); ++i) { // it may grow
        const BlockIndex b = overfull_[i];
        while (blocks_[b].state == Block::cached && blocks_[b].is_overfull()) make_room(b, code);
    }
    overfull_.clear();
}

template <int D> Handle Cache<D>::move(Handle h, BlockIndex to) {
    const Handle moved = take_slot(to);
    slots_[moved] = slots_[h];
    for (int i = 0; i <= D; ++i) {
        const Link link = slots_[h].link[i];
        if (is_absent(link))
            visible_[link & ~absent].owner = make_link(moved, i);
        else
            slots_[link_simplex(link)].link[link_facet(link)] = make_link(moved, i);
    }
    give_back(h, moved);
    return moved;
}

template <int D> void Cache<D>::collect_places(BlockIndex b) {
    places_.clear();
    // Half of the block is ahead, and has not been used for long.
    for_each_simplex(b, [&](Handle h) { touch(&vertices_[slots_[h].vertex[0]].code); });
    for_each_simplex(b, [&](Handle h) { places_.add(code(slots_[h]), h); });
    // Parts are dear to compute and rarely matter: only inside one code.
    const std::uint64_t least = places_.least_code(), greatest = places_.greatest_code();
    if (least == greatest || blocks_[b].has_parts())
        for (KeyCut::Place &place : places_) place.key.part = part(slots_[place.handle]);
    // A page may have been forged, and it is borders between these keys that blocks are cut at.
    if (blocks_[b].surely_owns(least) && blocks_[b].surely_owns(greatest)) return;
    for (const KeyCut::Place &place : places_)
        if (!blocks_[b].owns(place.key))
            throw_corrupted("A simplex lies in a page that does not own its key.");
}

template <int D> void Cache<D>::make_room(BlockIndex b, std::uint64_t code) {
    // A page is made now and then only to see how large it is, so that much is known before
    // the first is written; more often while little is known.
    if (std::has_single_bit(++full_blocks_) || full_blocks_ % measured_each == 0) {
        encode(b);
        if (!blocks_[b].is_full()) return;
    }
    collect_places(b);
    const auto is_behind = [&](const KeyCut::Place &p) { return p.key.code < code; };
    const auto behind =
        static_cast<std::size_t>(std::count_if(places_.begin(), places_.end(), is_behind));
    BlockIndex upper;
    if (!has_changed_much(b) || behind < sequential_from * places_.size()) {
        upper = split_near(b, places_.size() / 2);
    } else if (lend(b, behind)) {
        return;
    } else if (behind <= blocks_[b].capacity) {
        std::partition(places_.begin(), places_.end(), is_behind);
        upper = split_at(b, behind, {code, 0});
    } else {
        upper = split_near(b, static_cast<std::size_t>(packed * blocks_[b].capacity));
    }
    if (blocks_[upper].is_overfull()) note_overfull(upper);
}

template <int D> bool Cache<D>::lend(BlockIndex b, std::size_t most) {
    const BlockIndex before = directory_.before(blocks_[b].lower);
    if (before == no_block || !blocks_[before].dirty || !is_followed_by(before, b)) return false;
    const std::size_t room = room_to_pack(before);
    return room >= least_move * blocks_[b].capacity && draw(before, b, std::min(room, most));
}

template <int D> bool Cache<D>::dissolve(BlockIndex b) {
    // What is stored is only touched where it is written anyway and has lost much.
    const bool is_sparse = blocks_[b].count < sparse * blocks_[b].capacity;
    if (blocks_[b].has_parts() || !blocks_[b].dirty || (blocks_[b].location != 0 && !is_sparse))
        return false;
    const Key lower = blocks_[b].lower, upper = blocks_[b].upper;
    const BlockIndex left = directory_.before(lower), right = directory_.after(lower);
    const auto suits = [&](BlockIndex n) { return blocks_[n].dirty && !blocks_[n].has_parts(); };
    const bool suits_left = left != no_block && blocks_[left].upper == lower && suits(left);
    // The left neighbour keeps its key; the right one's key changes.
    const bool suits_right = right != no_block && blocks_[right].lower == upper && suits(right) &&
                             (blocks_[right].location == 0 || is_sparse);
    const std::size_t n = blocks_[b].count;
    const std::size_t room_left = suits_left ? room_to_pack(left) : 0;
    const std::size_t room_right = suits_right ? room_to_pack(right) : 0;
    if (!(suits_left || suits_right) || room_left + room_right < n) return false;

    collect_places(b);
    std::size_t cut =
        room_left >= n ? n : std::min(room_left, (room_left + n - room_right + 1) / 2);
    if (room_right >= n) cut = 0;
    if (cut > 0 && cut < n) {
        cut = places_.cut_near(cut);
        if (cut > room_left || n - cut > room_right) return false;
    }
    // An empty block's interval goes to either.
    const bool to_right = n == 0 ? suits_right : cut < n, to_left = n == 0 ? !to_right : cut > 0;
    const Key border = !to_left ? lower : !to_right ? upper : places_[cut].key;
    // Their age stays: they are no more in use than before.
    const std::uint64_t left_used = to_left ? blocks_[left].used_at : 0;
    const std::uint64_t right_used = to_right ? blocks_[right].used_at : 0;
    if (to_left) share_settled(b, left, cut, n);
    if (to_right) share_settled(b, right, n - cut, n - cut);
    for (std::size_t i = 0; i < n; ++i) move(places_[i].handle, i < cut ? left : right);
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
    ++counters.merges;
    return true;
}

template <int D> void Cache<D>::fill_up(BlockIndex b, bool only_leaving) {
    const BlockIndex next = directory_.after(blocks_[b].lower);
    if (next == no_block || !blocks_[b].dirty || !has_changed_much(b) || !is_followed_by(b, next) ||
        (only_leaving && !blocks_[next].leaving))
        return;
    const std::size_t room = room_to_pack(b);
    if (room < least_move * blocks_[b].capacity && room < blocks_[next].count)
        return; // not worth it
    collect_places(next);
    draw(b, next, room);
}

template <int D> std::size_t Cache<D>::room_to_pack(BlockIndex b) const {
    const auto full = static_cast<std::uint32_t>(packed * blocks_[b].capacity);
    return full - std::min<std::uint32_t>(full, blocks_[b].count);
}

template <int D> bool Cache<D>::has_changed_much(BlockIndex b) const {
    const int settled = blocks_[b].settled, change = static_cast<int>(blocks_[b].count) - settled;
    return settled == 0 || std::abs(change) >= much * blocks_[b].capacity;
}

template <int D>
void Cache<D>::share_settled(BlockIndex from, BlockIndex to, std::size_t moving, std::size_t all) {
    if (moving == 0) return;
    const std::size_t share = blocks_[from].settled * moving / all;
    blocks_[from].settled = static_cast<std::uint16_t>(blocks_[from].settled - share);
    // Of many blocks that became one there may be more than it has room to tell.
    blocks_[to].settled =
        static_cast<std::uint16_t>(std::min<std::size_t>(blocks_[to].settled + share, 0xffff));
}

template <int D> bool Cache<D>::is_followed_by(BlockIndex b, BlockIndex next) const {
    return blocks_[next].lower == blocks_[b].upper && blocks_[next].dirty &&
           !blocks_[b].has_parts() && !blocks_[next].has_parts();
}

template <int D> bool Cache<D>::draw(BlockIndex b, BlockIndex next, std::size_t most) {
    const Key border = blocks_[next].lower, upper = blocks_[next].upper;
    std::size_t cut = places_.size();
    if (cut > most) cut = places_.cut_near(most);
    if (cut > most) return false;
    const std::uint64_t used = blocks_[b].used_at, next_used = blocks_[next].used_at;
    const bool is_whole = cut == places_.size();
    const Key moved = is_whole ? upper : places_[cut].key;
    share_settled(next, b, cut, places_.size());
    for (std::size_t i = 0; i < cut; ++i) move(places_[i].handle, b);
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

template <int D> void Cache<D>::erase_page(BlockIndex b) {
    Block &block = blocks_[b];
    if (block.location == 0) return;
    host_.erase(ABACUS_SIMPLEX_PAGES, {block.lower, nullptr, 0, block.location});
    block.location = 0;
}

template <int D> BlockIndex Cache<D>::split_at(BlockIndex b, std::size_t cut, const Key &border) {
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
    share_settled(b, right, places_.size() - cut, places_.size());
    for (std::size_t i = cut; i < places_.size(); ++i) move(places_[i].handle, right);
    return right;
}

template <int D> BlockIndex Cache<D>::split_near(BlockIndex b, std::size_t wanted) {
    const std::size_t cut = places_.cut_near(wanted);
    if (cut == 0 || cut >= places_.size())
        throw Error(ABACUS_ERROR_LIMIT, "too many simplices share one key",
                    "More simplices than fit a page cannot be told apart on the curve.");
    return split_at(b, cut, places_[cut].key);
}

template <int D> BlockIndex Cache<D>::halve(BlockIndex b) {
    collect_places(b);
    return split_near(b, places_.size() / 2);
}

template class Cache<2>;
template class Cache<3>;

} // namespace abacus
