// Placement: simplices move to the blocks that own their keys, and full blocks
// split in two along the curve.
#include "cache/cache.hpp"

namespace abacus {

// A full block makes room in one of three ways, by where the point being inserted
// lies among its simplices, in curve order. Points come in the same order.
//
//   Somewhere in the upper half: what lies behind the point is nearly finished. A
//   cut just ahead of the point leaves a well-filled page there that will hardly be
//   touched again (the sequential split).
//
//   Behind it: the whole block was finished and overflows now, because a
//   neighbour in the plane got its points. It lends simplices to a cached
//   neighbour on the curve, as B*-trees do, if neither's stored key changes by it.
//
//   Otherwise the block is cut at the median key.
namespace {
constexpr double sequential_from = 0.5;
constexpr double finished_from = 0.95;
constexpr double sequential_to = 0.85; // leaves room for what will still change there
} // namespace

template <int D> void Cache<D>::settle_limbo(std::uint64_t code) {
    for (std::size_t i = 0; i < limbo_.size(); ++i) {
        const BlockIndex b = limbo_[i];
        for (std::uint32_t slot = 0; slot < blocks_[b].high_water; ++slot) {
            const Handle h = b * block_slots<D> + slot;
            if (slots_[h].is_free()) continue;
            const Key key = this->key(slots_[h]);
            BlockIndex home = owner(key);
            if (home == no_block) throw_corrupted("No page owns a part of the curve.");
            while (blocks_[home].count >= capacity_) {
                make_room(home, code);
                home = cached_owner(key);
            }
            move(h, home);
        }
    }
    // The slots forward to where the simplices went until the block is used again.
    while (!limbo_.empty()) {
        free_block(limbo_.back());
        limbo_.pop_back();
    }
}

template <int D> Handle Cache<D>::move(Handle h, BlockIndex to) {
    const Handle moved = take_slot(to);
    slots_[moved] = slots_[h];
    for (int i = 0; i <= D; ++i) {
        const Link link = slots_[h].link[i];
        if (is_absent(link)) visible_[link & ~absent].owner = make_link(moved, i);
        else slots_[link_simplex(link)].link[link_facet(link)] = make_link(moved, i);
    }
    const BlockIndex from = block_of<D>(h);
    Block &block = blocks_[from];
    slots_[h].vertex[0] = free_mark;
    slots_[h].link[0] = block.free;
    slots_[h].link[1] = moved;
    block.free = h - from * block_slots<D>;
    --block.count;
    block.dirty = true;
    return moved;
}

template <int D> void Cache<D>::collect_places(BlockIndex b) {
    places_.clear();
    for_each_simplex(b, [&](Handle h) { places_.push_back({{code(slots_[h]), 0}, h}); });
    const auto by_key = [](const Place &a, const Place &b) { return a.key < b.key; };
    std::sort(places_.begin(), places_.end(), by_key);
    // Parts are dear to compute and rarely matter: only inside one code.
    if (!places_.empty() &&
        (places_[0].key.code == places_.back().key.code || blocks_[b].has_parts())) {
        for (Place &place : places_) place.key.part = part(slots_[place.handle]);
        std::sort(places_.begin(), places_.end(), by_key);
    }
}

template <int D> std::size_t Cache<D>::cut_near(std::size_t wanted) const {
    // Equal keys stay together.
    const auto changes = [&](std::size_t i) { return places_[i - 1].key < places_[i].key; };
    std::size_t up = std::max<std::size_t>(wanted, 1), down = up;
    while (up < places_.size() && !changes(up)) ++up;
    while (down > 0 && !changes(down)) --down;
    if (down == 0 || (up < places_.size() && up - wanted <= wanted - down)) return up;
    return down;
}

template <int D> void Cache<D>::make_room(BlockIndex b, std::uint64_t code) {
    collect_places(b);
    const std::size_t n = places_.size();
    const auto behind = static_cast<std::size_t>(
        std::lower_bound(places_.begin(), places_.end(), code,
                         [](const Place &a, std::uint64_t c) { return a.key.code < c; }) -
        places_.begin());
    if (behind >= sequential_from * n && behind < finished_from * n) {
        split_at(b, std::min(behind, static_cast<std::size_t>(sequential_to * n)));
        return;
    }
    if (behind >= finished_from * n && (lend_left(b) || lend_right(b))) return;
    split_at(b, n / 2);
}

template <int D> bool Cache<D>::lend_left(BlockIndex b) {
    const auto at = directory_.find(blocks_[b].lower);
    if (blocks_[b].location != 0 || at == directory_.begin()) return false;
    const BlockIndex left = std::prev(at)->second;
    if (!takes_loan(left, b) || !(blocks_[left].upper == blocks_[b].lower)) return false;
    const std::size_t cut = cut_near((capacity_ - blocks_[left].count) / 2);
    if (cut >= places_.size() || blocks_[left].count + cut > capacity_) return false;
    for (std::size_t i = 0; i < cut; ++i) move(places_[i].handle, left);
    const Key border = places_[cut].key;
    directory_.erase(at);
    blocks_[left].own(blocks_[left].lower, border);
    blocks_[b].own(border, blocks_[b].upper);
    directory_.emplace(border, b);
    return true;
}

template <int D> bool Cache<D>::lend_right(BlockIndex b) {
    const auto at = std::next(directory_.find(blocks_[b].lower));
    if (at == directory_.end()) return false;
    const BlockIndex right = at->second;
    if (blocks_[right].location != 0 || !takes_loan(right, b) ||
        !(blocks_[right].lower == blocks_[b].upper))
        return false;
    const std::size_t n = places_.size();
    const std::size_t cut = cut_near(n - (capacity_ - blocks_[right].count) / 2);
    if (cut >= n || blocks_[right].count + (n - cut) > capacity_) return false;
    for (std::size_t i = cut; i < n; ++i) move(places_[i].handle, right);
    const Key border = places_[cut].key;
    directory_.erase(at);
    blocks_[b].own(blocks_[b].lower, border);
    blocks_[right].own(border, blocks_[right].upper);
    directory_.emplace(border, right);
    return true;
}

template <int D>
typename Cache<D>::BlockIndex Cache<D>::split_at(BlockIndex b, std::size_t wanted) {
    const std::size_t cut = cut_near(wanted);
    if (cut == 0 || cut >= places_.size())
        throw Error(ABACUS_ERROR_LIMIT, "too many simplices share one key",
                    "More simplices than fit a page cannot be told apart on the curve.");
    ++counters.splits;
    const BlockIndex right = new_block(Block::cached);
    Block &left = blocks_[b];
    blocks_[right].own(places_[cut].key, left.upper);
    blocks_[right].dirty = true;
    blocks_[right].leaving = left.leaving;
    blocks_[right].used_at = left.used_at;
    left.own(left.lower, places_[cut].key);
    left.dirty = true;
    directory_.emplace(blocks_[right].lower, right);
    for (std::size_t i = cut; i < places_.size(); ++i) move(places_[i].handle, right);
    return right;
}

template <int D>
typename Cache<D>::BlockIndex Cache<D>::halve(BlockIndex b) {
    collect_places(b);
    return split_at(b, places_.size() / 2);
}

template class Cache<2>;
template class Cache<3>;

} // namespace abacus
