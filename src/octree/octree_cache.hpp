// Leaves of an octree in the block cache (blocks/block_cache.hpp): found by a cell, their
// attributes changed, split and merged in place.
//
// Neighbours are arithmetic on codes, so a leaf has no links, and nothing has to follow when one
// moves. That makes this owner short: a leaf is its octant and a number of its attributes, in a
// heap beside the blocks. A block that comes from a page has its leaves in order, and is searched
// by halving; one that has changed since is searched from end to end.
#pragma once

#include "blocks/block_cache.hpp"
#include "host/free_numbers.hpp"
#include "octree/octant_page.hpp"

#include <abacus/facts.h>
#include <abacus/mesh_counters.h>

namespace abacus {

template <int D> struct Leaf {
    std::uint64_t code;
    std::uint32_t values; // number of its attributes; of a free slot the next one
    std::uint32_t level;  // of a free slot where its record moved

    static constexpr std::uint32_t free_mark = 1u << 31, nowhere = free_mark - 1;

    bool is_free() const { return (level & free_mark) != 0; }
    std::uint32_t next_free() const { return values; }
    Handle moved_to() const {
        return level == (free_mark | nowhere) ? no_handle : Handle{level & ~free_mark};
    }
    void set_free(std::uint32_t next, Handle moved) {
        values = next;
        level = free_mark | (moved == no_handle ? nowhere : to_number(moved));
    }
    Octant<D> octant() const { return {code, static_cast<int>(level)}; }
};

template <int D> struct LeafBlocks {
    using Record = Leaf<D>;
    struct Note {
        bool in_order; // slots are along the curve, free ones too, as leaves were loaded
    };
    using Counters = abacus_counters;
    static constexpr std::uint32_t slots = page_octants + page_octants / 4;
    static constexpr std::uint64_t handles_end = 1u << 30;
    static constexpr abacus_page_kind page_kind = ABACUS_OCTANT_PAGES;
    static constexpr const char *a_record = "A leaf", *records = "leaves", *whole = "octree";
};
static_assert(BlockDescription<LeafBlocks<2>> && BlockDescription<LeafBlocks<3>>);

/// What pages of leaves with so many attributes are like.
constexpr PageShape octant_pages(int attributes) {
    constexpr double overhead = sizeof(OctantPageHead) + checksum_bytes + 10;
    return {.overhead = overhead,
            .room = ABACUS_PAGE_BYTES - overhead,
            .record_bytes = 0.5 + 6.0 * attributes,
            .inverse_growth = -1,
            .slots = page_octants};
}

template <int D> class OctreeCache : public BlockCache<OctreeCache<D>, LeafBlocks<D>> {
    using Blocks = BlockCache<OctreeCache<D>, LeafBlocks<D>>;

public:
    OctreeCache(const Host &host, const abacus_facts &facts, std::size_t budget);

    /// The leaf that has a cell. Other handles may die.
    Handle find(std::uint64_t cell);
    Octant<D> octant(Handle h) const { return slots_[h].octant(); }
    const double *values(Handle h) const { return values_.data() + slots_[h].values * stride_; }
    void set_values(Handle h, const double *values) {
        std::copy_n(values, stride_, values_.data() + slots_[h].values * stride_);
        this->mark_dirty(h);
    }
    /// Its children take its place and its attributes. Handles die.
    void split(Handle h);
    /// An octant takes the place of all leaves in it, with the mean of their attributes by volume,
    /// family by family. Nothing happens if it is a leaf or lies in one. Returns how many leaves
    /// there were in it. Handles die.
    std::uint64_t merge(const Octant<D> &octant);

    // ---- What the block cache calls (blocks/data_type.hpp) -------------------------

    std::uint64_t code(const Leaf<D> &leaf) const { return leaf.code; }
    std::uint64_t part(const Leaf<D> &) const { return 0; }
    void ask_for_code(const Leaf<D> &) const {}
    void ask_for_contents(BlockIndex) const {}
    std::size_t bytes_beside_blocks() const {
        return (values_.size() - free_values_.size() * stride_) * sizeof(double);
    }
    void moved(Handle from, Handle to) {
        notes_[Blocks::block_of(from)].in_order = false;
        notes_[Blocks::block_of(to)].in_order = false;
    }
    PageContents open_page(const abacus_page &page);
    void tie(BlockIndex b);
    EncodedPage encode_page(BlockIndex b);
    void survey(BlockIndex) {}
    void untie(BlockIndex b);
    void begin_eviction() {}
    void end_eviction() {}

private:
    using Blocks::slots_, Blocks::blocks_, Blocks::notes_;

    /// The last leaf of a block that begins at or before a cell, or no_handle.
    Handle last_up_to(BlockIndex b, std::uint64_t cell) const;
    /// One that is there for certain. All handles stay.
    Handle leaf(const Octant<D> &sought);
    void add(const Octant<D> &octant, const double *values);
    void remove(Handle h);
    std::uint32_t new_values();

    std::size_t stride_;   // attributes of a leaf
    Arena<double> values_; // so many of each leaf
    FreeNumbers free_values_;
    OctantPageView<D> view_;
    OctantPageWriter<D> writer_;
    Arena<Handle> order_; // leaves of a block, along the curve
    Arena<double> kept_;  // attributes of a leaf that goes
};

} // namespace abacus
