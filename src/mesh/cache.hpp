// The computational cache (dissertation §4.4-4.10): simplices linked by direct
// handles, as in a program that has the whole mesh in memory, over pages that hold
// it really.
//
// A block owns an interval of keys and holds the simplices whose keys fall into
// it; it maps to one stored page. The directory orders the cached intervals. The
// intervals of all pages, cached or not, partition the curve.
//
//   miss     A link that is absent names a visible facet, which knows the key of
//            the simplex beyond. One floor search finds its page (cache_load.cpp).
//            Only a link without a usable key has to be probed for (probing.cpp).
//   place    A new simplex goes to the block that owns its key. When that block has
//            no slot or is not cached, it goes to a limbo block for now, so that nothing
//            is split or loaded in the middle of an insertion and handles stay valid;
//            settle() brings limbo home and splits overfull blocks afterwards
//            (cache_place.cpp).
//   evict    When the cache has outgrown its budget, trim() drops a tenth of the
//            blocks, those that will not be missed soon (cache_evict.cpp); changed
//            ones are written first. Nothing is evicted during an insertion.
//
// Why links never go stale: an insertion looks at the simplex beyond every facet
// of the cavity's rim, so both sides of a facet are cached whenever the simplex on
// one side is replaced, and both their blocks are marked dirty.
//
// cross() and everything that loads may move the arrays: a reference to a simplex
// or vertex does not survive it, a handle does. settle() changes handles; a slot
// that a simplex left forwards to its new place until it is used again.
#pragma once

#include "blocks/block.hpp"
#include "blocks/directory.hpp"
#include "blocks/key_cut.hpp"
#include "blocks/replacement.hpp"
#include "geometry/predicates.hpp"
#include "host/host.hpp"
#include "keys/locational_code.hpp"
#include "mesh/inner_links.hpp"
#include "mesh/page_capacity.hpp"
#include "mesh/page_writer.hpp"
#include "mesh/simplex.hpp"
#include "mesh/vertex_heap.hpp"
#include "mesh/visible_facets.hpp"

#include <abacus/header.h>

namespace abacus {

struct CacheOptions {
    std::size_t budget = 64u << 20; // bytes; exceeded only while one operation needs it
    bool stored_links = true;       // false: probe at every miss, to measure §4.10
    bool verify_links = false;      // compare every stored key with the simplex it leads to
    bool verify_checksums = true;   // false: for who looks for the damage itself
    bool linked_ghosts = true;      // false: a ghost is its own neighbour across its ridges
};

/// A simplex for Cache::append(): its vertices as records (id, coordinates, attributes), the
/// last null for the point at infinity; the keys of its neighbours.
template <int D> struct LooseSimplex {
    std::array<const std::uint64_t *, D + 1> vertex;
    std::array<Key, D + 1> beyond;
};

template <int D> class Cache {
public:
    Cache(const Host &host, const Domain<D> &domain, int attributes, const CacheOptions &options);
    Cache(const Cache &) = delete;
    Cache &operator=(const Cache &) = delete;

    // ---- Topology ----------------------------------------------------------

    const Simplex<D> &simplex(Handle h) const { return slots_[h]; }
    const Point<D> &point(VertexIndex v) const { return vertices_.point(v); }
    const VertexHeap<D> &vertices() const { return vertices_; }
    /// Corners of a finite simplex.
    Corners<D> corners(const Simplex<D> &s) const {
        Corners<D> c;
        for (int i = 0; i <= D; ++i) c[i] = &point(s.vertex[i]);
        return c;
    }
    /// The neighbour's side of a facet, loaded if need be.
    Link cross(Handle h, int facet) {
        ++counters.steps;
        const Link link = slots_[h].link[facet];
        return is_absent(link) ? miss(h, facet) : link;
    }
    /// Whether a handle kept from earlier is a simplex still (perhaps another one).
    bool is_live(Handle h) const {
        if (h >= slots_.size()) return false;
        const BlockIndex b = block_of<D>(h);
        return blocks_[b].state == Block::cached &&
               h - b * block_slots<D> < blocks_[b].high_water && !slots_[h].is_free();
    }
    /// Where settle() took the simplex, or no_handle; another simplex, if its slot has been
    /// taken meanwhile, so no more than a hint.
    Handle follow(Handle h) const;

    /// Number of a vertex in a numbering of the caller's.
    std::uint32_t number(typename VertexHeap<D>::Numbering &numbering, VertexIndex v) {
        return numbering.number(vertices_, v);
    }
    /// The same without branches, in a numbering that has room.
    std::uint32_t number_in_room(typename VertexHeap<D>::Numbering &numbering, VertexIndex v) {
        return numbering.number_in_room(vertices_, v);
    }
    /// Makes a numbering valid again after another, which loading a page does, too.
    void renumber(const typename VertexHeap<D>::Numbering &numbering) {
        numbering.renew(vertices_);
    }

    // ---- Keys ----------------------------------------------------------------

    const Domain<D> &domain() const { return domain_; }
    /// Greatest code of the vertices.
    std::uint64_t code(const std::array<VertexIndex, D + 1> &vertices) const {
        std::uint64_t greatest = 0;
        for (const VertexIndex v : vertices) greatest = std::max(greatest, vertices_[v].code);
        return greatest;
    }
    std::uint64_t code(const Simplex<D> &s) const { return code(s.vertex); }
    /// Whether the simplex is in the block that owns its key.
    bool is_home(Handle h) const {
        const Simplex<D> &s = slots_[h];
        const Block &block = blocks_[block_of<D>(h)];
        const std::uint64_t code = this->code(s);
        return block.surely_owns(code) || block.owns({code, part(s)});
    }
    /// Whether the cached block around h owns the code.
    bool near(Handle h, std::uint64_t code) const {
        return blocks_[block_of<D>(h)].surely_owns(code);
    }
    /// Asks for the slots of a block, and for the vertices that came with its page.
    void ask_for_slots(BlockIndex b) const;
    void ask_for_loaded_vertices(BlockIndex b) const;
    /// Asks for the simplices across all facets, before it is known which of them is wanted.
    void ask_for_neighbours(const Simplex<D> &s) const {
        for (const Link link : s.link)
            if (!is_absent(link)) __builtin_prefetch(&slots_[link_simplex(link)]);
    }
    /// The block that owns what comes on the curve behind a block; no_block if it is not cached.
    BlockIndex next_on_curve(BlockIndex b) const {
        return blocks_[b].upper == end_key ? no_block : cached_owner(blocks_[b].upper);
    }
    /// Lower key of the block, and of its page, that h is in.
    const Key &lower(Handle h) const { return blocks_[block_of<D>(h)].lower; }
    /// The block around h is in use, as those are that change: for who only reads.
    void use(Handle h) { blocks_[block_of<D>(h)].used_at = clock_; }
    /// Some simplex of the block that owns the code, loaded if need be, preferably
    /// close to p; no_handle if the mesh has none there.
    Handle start(std::uint64_t code, const Point<D> &p);
    /// Calls visit(handle) for the simplices with this code, in all blocks that have some. These
    /// may be more than there is room for: a block may be evicted before the next one is loaded.
    template <class Visit> void visit_code(std::uint64_t code, Visit visit);
    /// Calls visit(handle) for the simplices of the block that owns the key, loaded if
    /// need be; returns the lower key of the next block, end_key after the last.
    template <class Visit> Key visit(const Key &key, Visit visit);

    // ---- Change ----------------------------------------------------------------

    /// Gives an empty mesh its first block.
    void create_first_block();
    VertexIndex create_vertex(const Point<D> &p, std::int64_t id, const double *attributes) {
        return create_vertex(p, domain_.code(p), id, attributes);
    }
    /// With p's code, where it is known already.
    VertexIndex create_vertex(const Point<D> &p, std::uint64_t code, std::int64_t id,
                              const double *attributes) {
        return vertices_.create(p, code, id, attributes);
    }
    /// Of a vertex whose whole star has been destroyed.
    void destroy_vertex(VertexIndex v) {
        if (vertices_.in_use(v)) throw_corrupted("A vertex has two separate stars.");
        vertices_.destroy(v);
    }
    /// The caller marks the vertex's whole star as changed, and has loaded it.
    void rename_vertex(VertexIndex v, std::int64_t id, const double *attributes) {
        vertices_.rename(v, id, attributes);
    }
    /// A new simplex with unset links.
    Handle create(const std::array<VertexIndex, D + 1> &vertices) {
        const Handle h = allot(code(vertices));
        for (int i = 0; i <= D; ++i) {
            slots_[h].vertex[i] = vertices[i];
            vertices_.acquire(vertices[i]);
        }
        return h;
    }
    /// The same in parts, for who knows the code already: a slot for a simplex with this code,
    /// whose content is then to be set and its vertices to be acquired.
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
    void set(Handle h, const Simplex<D> &s) { slots_[h] = s; }
    void set_corner(Handle h, int i, VertexIndex v) { slots_[h].vertex[i] = v; }
    /// So many simplices more have the vertex.
    void acquire(VertexIndex v, std::uint32_t simplices) { vertices_.acquire(v, simplices); }
    /// Frees the slot; the neighbours keep their links to it.
    void destroy(Handle h) {
        for (const VertexIndex v : slots_[h].vertex) vertices_.release(v);
        give_back(h, no_handle);
        ++counters.deleted;
    }
    void connect(Link a, Link b) {
        point_at(a, b);
        point_at(b, a);
    }
    /// One side of it: beyond the facet `from` is the facet `to`.
    void point_at(Link from, Link to) { point_at(link_simplex(from), link_facet(from), to); }
    void point_at(Handle h, int facet, Link to) { slots_[h].link[facet] = to; }
    /// The block's page has to be written: call it for the neighbours of what changed.
    void mark_dirty(Handle h) {
        Block &block = blocks_[block_of<D>(h)];
        block.dirty = true;
        block.used_at = clock_;
    }
    /// Ends an operation: limbo comes home, overfull blocks make room. Sequential splits cut at
    /// `code`, which is 0 if the operations do not come along the curve. Returns whether
    /// simplices moved: see follow().
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
    /// Writes every changed block; they stay cached.
    void flush();
    /// Writes a page of a mesh that is made in the order of keys, and keeps nothing of it.
    /// False, and nothing is written, if it would have too many bytes.
    bool append(const Key &lower, const Key &upper, const LooseSimplex<D> *simplices,
                std::size_t n);
    /// Simplices that a block takes, if nothing else is known of it.
    std::uint32_t capacity() const { return capacity_.usual(); }

    const Host &host() const { return host_; }
    void poll() const { host_.poll(); }

    std::size_t bytes() const {
        return cached_blocks_ * block_bytes + vertices_.bytes() + visible_.bytes();
    }
    std::size_t cached_blocks() const { return cached_blocks_; }
    /// Whether the block that owns the key is in memory.
    bool is_cached(const Key &key) const { return cached_owner(key) != no_block; }

    abacus_counters counters{};

private:
    static constexpr std::size_t block_bytes = sizeof(Block) + block_slots<D> * sizeof(Simplex<D>);

    // cache.cpp
    BlockIndex new_block(Block::State state);
    void free_block(BlockIndex b);
    BlockIndex cached_owner(const Key &key) const;
    BlockIndex place_elsewhere(std::uint64_t code);
    Handle closest_of_some(BlockIndex b, const Point<D> &p) const;
    bool has_slot(BlockIndex b) const { return blocks_[b].count < block_slots<D>; }
    void note_overfull(BlockIndex b) {
        if (overfull_.empty() || overfull_.back() != b) overfull_.push_back(b);
    }
    Handle take_slot(BlockIndex b) {
        Block &block = blocks_[b];
        std::uint32_t slot = block.free;
        if (slot != no_slot)
            block.free = slots_[b * block_slots<D> + slot].link[0];
        else
            slot = block.high_water++;
        ++block.count;
        block.dirty = true;
        block.used_at = clock_;
        return b * block_slots<D> + slot;
    }
    /// Frees a slot; `moved` is where its simplex went.
    void give_back(Handle h, Handle moved) {
        const BlockIndex b = block_of<D>(h);
        Block &block = blocks_[b];
        Simplex<D> &s = slots_[h];
        s.vertex[0] = free_mark;
        s.link[0] = block.free;
        s.link[1] = moved;
        block.free = h - b * block_slots<D>;
        --block.count;
        block.dirty = true;
        block.used_at = clock_;
    }
    template <class Visit> void for_each_simplex(BlockIndex b, Visit visit) {
        for (std::uint32_t slot = 0; slot < blocks_[b].high_water; ++slot) {
            const Handle h = b * block_slots<D> + slot;
            if (!slots_[h].is_free()) visit(h);
        }
    }
    FacetVertices<D, VertexIndex> facet(Link link) const {
        return {slots_[link_simplex(link)].vertex, link_facet(link)};
    }
    /// Of the facet, among those visible.
    std::uint32_t hash(Link link) const { return VisibleFacets<D>::hash(facet(link)); }
    std::uint64_t part(const Simplex<D> &s) const;

    // cache_place.cpp
    void bring_home(std::uint64_t code);
    void relieve(std::uint64_t code);
    /// The block that owns the simplex's key, loaded if need be.
    BlockIndex home(const Simplex<D> &s);
    Handle move(Handle h, BlockIndex to);
    /// Fills places_ with the block's simplices and their keys.
    void collect_places(BlockIndex b);
    void make_room(BlockIndex b, std::uint64_t code);
    /// Moves at most so many simplices, those with the least keys, to the block before, if that
    /// has room for them; so that a block that has nearly all its points is not cut.
    bool lend(BlockIndex b, std::size_t most);
    /// Gives all simplices of a block that was never stored, or has lost many, to its
    /// neighbours on the curve, if they take them; so that no page is written half empty.
    bool dissolve(BlockIndex b);
    /// Removes the block's page, if it is stored.
    void erase_page(BlockIndex b);
    /// Fills a block that is to be written from the next one on the curve, if that is to be
    /// written too, with `only_leaving` now: so that pages are full from the beginning of the
    /// curve on.
    void fill_up(BlockIndex b, bool only_leaving);
    /// How many simplices the block may take from its neighbours.
    std::size_t room_to_pack(BlockIndex b) const;
    /// Whether the block is new, or has won or lost more simplices since it was loaded than a
    /// few points bring with them.
    bool has_changed_much(BlockIndex b) const;
    /// Before so many simplices, of all that are left there, move from one block to another.
    void share_settled(BlockIndex from, BlockIndex to, std::size_t moving, std::size_t all);
    /// Whether the second block continues the first one, and is to be written as well.
    bool is_followed_by(BlockIndex b, BlockIndex next) const;
    /// Moves at most so many simplices, those with the least keys, from the next block, whose
    /// places have been collected. False if there is no border for it.
    bool draw(BlockIndex b, BlockIndex next, std::size_t most);
    /// Cuts the block, whose simplices from places_[cut] on, and no others, have keys from
    /// `border` on; returns the new block, the upper part.
    BlockIndex split_at(BlockIndex b, std::size_t cut, const Key &border);
    /// Cuts it where so many, or nearly, are below.
    BlockIndex split_near(BlockIndex b, std::size_t wanted);
    BlockIndex halve(BlockIndex b);

    // cache_load.cpp
    Link miss(Handle h, int facet);
    bool follow_stored_link(Handle h, int facet, const Key &beyond);
    bool present(Handle h, int facet) const { return !is_absent(slots_[h].link[facet]); }
    /// The block that owns the key, loaded if need be; no_block if no page does.
    BlockIndex owner(const Key &key);
    BlockIndex load(const abacus_page &page);
    void load_vertices();
    void note_vertices(Block &block) const;
    void load_simplices(Handle first);
    void link_outside();
    void link_outside(Link link, std::uint32_t hash, const Key &beyond);
    bool leads_to(const Key &link, Handle h) const;

    // cache_append.cpp
    VertexIndex appended_vertex(const std::uint64_t *record);

    // probing.cpp
    void probe(Handle h, int facet);
    bool load_uncached(std::uint64_t code);
    bool quick_probe(Handle h, int facet, std::uint64_t greatest);
    bool ray_probe(Handle h, int facet, const Cell<D> &middle);
    bool concentric_probe(Handle h, int facet, const Cell<D> &middle);
    /// Edge, as a power of two, of the largest octant around a cell that lies in
    /// the cached block owning it.
    int octant_level(const Cell<D> &cell) const;

    // cache_evict.cpp
    void shrink();
    void evict(Arena<BlockIndex> &victims);
    /// Asks for what the blocks after this one of a list need to be made pages: the vertices of
    /// the next, and the slots of the one after it, which tell its vertices.
    void ask_ahead(const Arena<BlockIndex> &blocks, std::size_t at) const;
    void ask_for_vertices(BlockIndex b) const;
    /// Lists the block's facets on its border, and numbers its vertices.
    void survey(BlockIndex b);
    void mark_border();
    /// Makes the block's page, which surveys it; false if that has too many bytes.
    bool encode(BlockIndex b);
    void store(BlockIndex b);
    /// Parts the block, just surveyed, from those that stay.
    void unlink(BlockIndex b);
    Key key_beyond(Handle h, int facet) const;

    const Host &host_;
    Domain<D> domain_;
    CacheOptions options_;
    PageCapacity<D> capacity_;
    unsigned full_blocks_ = 0; // so far

    Arena<Block> blocks_;
    Arena<Simplex<D>> slots_; // block_slots of each block
    VertexHeap<D> vertices_;
    VisibleFacets<D> visible_;
    Directory directory_;
    Arena<BlockIndex> unused_blocks_;
    Arena<BlockIndex> overfull_; // to make room when the operation ends, some more than once
    Arena<BlockIndex> limbo_;
    KeyCut places_;
    Replacement replacement_;
    std::size_t cached_blocks_ = 0;
    std::array<BlockIndex, 2> at_hand_{no_block, no_block}; // took the last simplices
    std::uint64_t clock_ = 0; // operations so far, for the replacement

    // Page translation: reused from page to page.
    PageView<D> view_;
    InnerLinks<D> inner_links_;
    PageWriter<D> writer_;
    typename VertexHeap<D>::Numbering numbered_; // vertices by local number
    Arena<bool> on_border_;                      // of these
    Arena<std::uint32_t> uses_;                  // of the vertices of the page being loaded
    Arena<VertexIndex> left_;                    // border vertices of the blocks evicted together
    Arena<Link> border_;                         // facets on the border of a block, from inside
    Arena<double> values_;                       // attributes of a vertex
    Arena<std::uint64_t> codes_;                 // of the vertices of a page
    Arena<std::uint32_t> hashes_;                // of the facets of border_
    Arena<std::uint32_t> guesses_;               // their entries among the visible ones, perhaps
};

template <int D> template <class Visit> void Cache<D>::visit_code(std::uint64_t code, Visit visit) {
    // Several blocks share the code when it has parts: from the last one back.
    for (Key key{code, key_word_end - 1};;) {
        const BlockIndex b = owner(key);
        if (b == no_block) return;
        for_each_simplex(b, [&](Handle h) {
            if (this->code(slots_[h]) == code) visit(h);
        });
        if (blocks_[b].lower <= Key{code, 0}) return;
        key = predecessor(blocks_[b].lower);
        trim();
        poll();
    }
}

template <int D> template <class Visit> Key Cache<D>::visit(const Key &key, Visit visit) {
    const BlockIndex b = owner(key);
    if (b == no_block) throw_corrupted("No page owns a part of the curve.");
    blocks_[b].used_at = ++clock_; // page by page is an order of use, too
    // What visit() loads goes to other blocks: this one keeps its simplices.
    for_each_simplex(b, visit);
    return blocks_[b].upper;
}

} // namespace abacus
