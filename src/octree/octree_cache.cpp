#include "octree/octree_cache.hpp"

#include "blocks/block_cache_code.hpp"

#include <algorithm>

namespace abacus {

template <int D>
OctreeCache<D>::OctreeCache(const Host &host, const abacus_facts &facts, std::size_t budget)
    : Blocks(host, budget, {.after_others = budget, .alone = budget},
             PageCapacity(octant_pages(static_cast<int>(facts.columns.attributes)))),
      stride_(facts.columns.attributes), values_(host), free_values_(host),
      writer_(host, static_cast<int>(facts.columns.attributes)), order_(host), kept_(host) {
    kept_.resize(stride_);
}

// ---- Leaves ------------------------------------------------------------------

template <int D> Handle OctreeCache<D>::last_up_to(BlockIndex b, std::uint64_t cell) const {
    const Handle first = Blocks::first_of(b);
    const std::uint32_t used = blocks_[b].high_water;
    if (notes_[b].in_order) {
        // A free slot keeps its code.
        const Leaf<D> *const begin = &slots_[first];
        const Leaf<D> *after = std::partition_point(
            begin, begin + used, [&](const Leaf<D> &leaf) { return leaf.code <= cell; });
        while (after != begin && (after - 1)->is_free()) --after;
        return after == begin ? no_handle : first + static_cast<std::uint32_t>(after - begin - 1);
    }
    Handle last = no_handle;
    this->for_each_record(b, [&](Handle h) {
        const std::uint64_t code = slots_[h].code;
        if (code <= cell && (last == no_handle || slots_[last].code < code)) last = h;
    });
    return last;
}

template <int D> Handle OctreeCache<D>::find(std::uint64_t cell) {
    for (Key key{cell, 0};;) {
        this->trim();
        const BlockIndex b = this->owner(key);
        if (b == no_block) throw_octree_corrupted("No page owns a part of the curve.");
        const Handle h = last_up_to(b, cell);
        if (h != no_handle) {
            if (!octant(h).contains(cell))
                throw_octree_corrupted("A part of the domain is in no leaf.");
            this->use(h);
            return h;
        }
        // The leaf begins on an earlier page: leaves after that have been merged.
        if (blocks_[b].lower == first_key)
            throw_octree_corrupted("A part of the domain is in no leaf.");
        key = predecessor(blocks_[b].lower);
        this->poll();
    }
}

template <int D> Handle OctreeCache<D>::leaf(const Octant<D> &sought) {
    const BlockIndex b = this->owner({sought.code, 0});
    const Handle h = b == no_block ? no_handle : last_up_to(b, sought.code);
    if (h == no_handle || !(octant(h) == sought))
        throw_octree_corrupted("A part of the domain is in no leaf.");
    return h;
}

template <int D> std::uint32_t OctreeCache<D>::new_values() {
    if (!free_values_.empty()) return free_values_.take();
    const auto number = static_cast<std::uint32_t>(stride_ == 0 ? 0 : values_.size() / stride_);
    values_.extend(stride_);
    return number;
}

template <int D> void OctreeCache<D>::add(const Octant<D> &octant, const double *values) {
    const Handle h = this->allot(octant.code);
    const std::uint32_t number = new_values();
    this->set(h, {octant.code, number, static_cast<std::uint32_t>(octant.level)});
    std::copy_n(values, stride_, values_.data() + number * stride_);
    notes_[Blocks::block_of(h)].in_order = false;
}

template <int D> void OctreeCache<D>::remove(Handle h) {
    if (stride_ > 0) free_values_.add(slots_[h].values);
    this->give_back(h, no_handle);
    ++this->counters.deleted;
}

template <int D> void OctreeCache<D>::split(Handle h) {
    const Octant<D> parent = octant(h);
    std::copy_n(values(h), stride_, kept_.data());
    remove(h);
    for (int i = 0; i < Octant<D>::children; ++i) add(parent.child(i), kept_.data());
    this->settle(parent.code);
}

template <int D> std::uint64_t OctreeCache<D>::merge(const Octant<D> &merged) {
    if (octant(find(merged.code)).level <= merged.level) return 1;
    std::uint64_t leaves = 0;
    this->poll();
    for (int i = 0; i < Octant<D>::children; ++i) leaves += merge(merged.child(i));
    // Now its children are leaves, perhaps on several pages. The first one, which begins at the
    // same place, replaces them all.
    const Handle first = leaf(merged.child(0));
    std::fill(kept_.begin(), kept_.end(), 0);
    for (int i = 0; i < Octant<D>::children; ++i) {
        const Handle h = i == 0 ? first : leaf(merged.child(i));
        for (std::size_t a = 0; a < stride_; ++a) kept_[a] += values(h)[a] / Octant<D>::children;
        if (h != first) remove(h);
    }
    slots_[first].level = static_cast<std::uint32_t>(merged.level);
    set_values(first, kept_.data());
    this->settle(0);
    return leaves;
}

// ---- Between page and block ----------------------------------------------------

template <int D> PageContents OctreeCache<D>::open_page(const abacus_page &page) {
    view_.read(page.bytes, page.size, static_cast<int>(stride_));
    return {{view_.lower(), 0}, {view_.upper(), 0}, view_.leaves()};
}

template <int D> void OctreeCache<D>::tie(BlockIndex b) {
    std::uint64_t code = view_.first();
    const Handle first = Blocks::first_of(b);
    for (std::uint32_t i = 0; i < view_.leaves(); ++i) {
        const std::uint32_t number = new_values();
        Leaf<D> &leaf = slots_[first + i];
        leaf = {code, number, static_cast<std::uint32_t>(view_.level(i))};
        for (std::size_t a = 0; a < stride_; ++a)
            values_[number * stride_ + a] = view_.attribute(i, static_cast<int>(a));
        code = leaf.octant().end();
    }
    notes_[b].in_order = true;
}

template <int D> EncodedPage OctreeCache<D>::encode_page(BlockIndex b) {
    order_.clear();
    this->for_each_record(b, [&](Handle h) { order_.push_back(h); });
    std::sort(order_.begin(), order_.end(),
              [&](Handle a, Handle b) { return slots_[a].code < slots_[b].code; });
    const bool fits = writer_.write(
        blocks_[b].lower.code, blocks_[b].upper.code, order_.size(),
        [&](std::size_t i) { return octant(order_[i]); },
        [&](std::size_t i) { return values(order_[i]); });
    return {writer_.bytes(), writer_.size(), fits};
}

template <int D> void OctreeCache<D>::untie(BlockIndex b) {
    if (stride_ > 0)
        this->for_each_record(b, [&](Handle h) { free_values_.add(slots_[h].values); });
}

template class OctreeCache<2>;
template class OctreeCache<3>;
template class BlockCache<OctreeCache<2>, LeafBlocks<2>>;
template class BlockCache<OctreeCache<3>, LeafBlocks<3>>;

} // namespace abacus
