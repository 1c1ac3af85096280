// The mesh cache: simplices in the block cache (blocks/block_cache.hpp), linked by direct
// handles, as in a program that has the whole mesh in memory (dissertation §4.4-4.10).
//
//   link     A simplex has a link for each facet: to its neighbour, if that is cached; else to an
//            entry of the visible facets, which knows the neighbour's key.
//   miss     One floor search with that key finds the neighbour's page (cache_load.cpp), and the
//            page's simplices are tied to those cached. Only a link without a usable key
//            has to be probed for (probing.cpp).
//   vertex   Vertices live in one heap, with a count of the simplices that use them. Those that a
//            page outside may name as well are found by their coordinates (vertex_heap.hpp).
//
// Why links never go stale: an insertion looks at the simplex beyond every facet
// of the cavity's rim, so both sides of a facet are cached whenever the simplex on
// one side is replaced, and both their blocks are marked dirty.
//
// cross() and everything that loads may move the arrays: a reference to a simplex
// or vertex does not survive it, a handle does. settle() changes handles; a slot
// that a simplex left forwards to its new place until it is used again.
//
// The states of a facet of a cached simplex:
//
//                   tie(): the neighbour was cached
//   (page) ──┬────────────────────────────────────────► linked ◄───────────┐
//            │                                            │                │
//            │ tie(): it was not           untie() of the │                │ tie() of the
//            └──────────────────────► visible ◄───────────┘                │ neighbour's page
//                                        └─────────────────────────────────┘
//   create() ──► unset ── connect() ──► linked       destroy(), untie() of its own block: gone
//
// Invariants, when no operation is under way (check_invariants()), besides those of blocks:
//
//   1. A link leads to a facet whose link leads back. Both simplices have the facet's vertices,
//      in opposite orientations; or the facet is a loose ridge, which is its own neighbour.
//   2. An absent link names a visible facet whose owner is the facet; there are no other visible
//      facets. No link is unset.
//   3. A vertex has as many references as cached simplices have it as a corner, the point at
//      infinity too.
//   4. A vertex of a visible facet is shared: a page that comes in finds it by its coordinates.
//   5. The point at infinity is the last corner of a ghost, and no other one's.
//   6. A facet is fixed on both sides or on none; none at the point at infinity is.
//   7. Simplices on both sides of a facet that is not fixed are in the same region, or in none. No
//      ghost is in one.
#pragma once

#include "blocks/block_cache.hpp"
#include "geometry/predicates.hpp"
#include "keys/locational_code.hpp"
#include "mesh/former_attributes.hpp"
#include "mesh/inner_links.hpp"
#include "mesh/page_writer.hpp"
#include "mesh/simplex_blocks.hpp"
#include "mesh/vertex_heap.hpp"
#include "mesh/visible_facets.hpp"

namespace abacus {

struct CacheOptions {
    std::size_t budget = 64u << 20; // bytes; exceeded only while one operation needs it
    bool stored_links = true;       // false: probe at every miss, to measure §4.10
    bool verify_links = false;      // compare every stored key with the simplex it leads to
    bool verify_checksums = true;   // false: for callers that look for the damage itself
    bool linked_ghosts = true;      // false: a ghost is its own neighbour across its ridges
    bool split_nodes = false;       // vertices at one place are told apart by their ids
    FormerAttributes former{};      // what is loaded with these will be written with those of now
};

/// A simplex for Cache::append(): its vertices as records (id, coordinates, attributes), the
/// last null for the point at infinity; the keys of its neighbours.
template <int D> struct LooseSimplex {
    std::array<const std::uint64_t *, D + 1> vertex;
    std::array<Key, D + 1> beyond;
};

template <int D> class Cache : public BlockCache<Cache<D>, SimplexBlocks<D>> {
    using Blocks = BlockCache<Cache<D>, SimplexBlocks<D>>;

public:
    Cache(const Host &host, const Domain<D> &domain, int attributes, const CacheOptions &options);

    using Blocks::allot, Blocks::block_of, Blocks::counters;

    /// Before anything is loaded: pages of which a vertex gets other values will be written.
    void give_other_values(OtherValues<D> &values) { other_values_ = &values; }

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

    // ---- Fixed facets and regions, of a constrained mesh in the plane ------------------

    FixedFacets<D> fixed(Handle h) const {
        return static_cast<std::size_t>(h) < fixed_.size() ? fixed_[h] : FixedFacets<D>{};
    }
    bool is_fixed(Link facet) const {
        return fixed(link_simplex(facet)).is_fixed(link_facet(facet));
    }
    Fixed fixed(Link facet) const { return fixed(link_simplex(facet))[link_facet(facet)]; }
    void set_fixed(Handle h, FixedFacets<D> facets);
    RegionNumber region(Handle h) const { return fixed(h).region(); }
    void set_region(Handle h, RegionNumber region) {
        FixedFacets<D> facets = fixed(h);
        facets.set_region(region);
        set_fixed(h, facets);
    }
    /// One side of it.
    void set_fixed(Link facet, Fixed how) {
        FixedFacets<D> facets = fixed(link_simplex(facet));
        facets.set(link_facet(facet), how);
        set_fixed(link_simplex(facet), facets);
    }

    /// Number of a vertex in a numbering of the caller's.
    std::uint32_t number(typename VertexHeap<D>::Numbering &numbering, VertexIndex v) {
        return numbering.number(vertices_, v);
    }
    /// The same without branches, in a numbering that has room.
    std::uint32_t number_in_room(typename VertexHeap<D>::Numbering &numbering, VertexIndex v) {
        return numbering.number_in_room(vertices_, v);
    }
    /// Makes a numbering valid again after another, which loading a page does, too.
    /// Numbers vertices anew, in the order of their coordinates.
    void sort_by_place(typename VertexHeap<D>::Numbering &numbering) {
        numbering.sort(vertices_, [this](VertexIndex a, VertexIndex b) {
            return vertices_.point(a) < vertices_.point(b);
        });
    }
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
    std::uint64_t part(const Simplex<D> &s) const;
    /// Asks for the vertices that came with a block's page.
    void ask_for_loaded_vertices(BlockIndex b) const {
        prefetch(&vertices_[notes_[b].first], notes_[b].count);
    }
    /// Asks for the simplices across all facets, before it is known which of them is wanted.
    void ask_for_neighbours(const Simplex<D> &s) const {
        for (const Link link : s.link)
            if (!is_absent(link)) __builtin_prefetch(&slots_[link_simplex(link)]);
    }
    /// Some simplex of the block that owns the code, loaded if need be, preferably
    /// close to p; no_handle if the mesh has none there.
    Handle start(std::uint64_t code, const Point<D> &p) {
        const BlockIndex b = this->nearest_with_records(code);
        return b == no_block ? no_handle : closest_of_some(b, p);
    }

    // ---- Change ----------------------------------------------------------------

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
    void set_corner(Handle h, int i, VertexIndex v) { slots_[h].vertex[i] = v; }
    /// So many simplices more have the vertex.
    void acquire(VertexIndex v, std::uint32_t simplices) { vertices_.acquire(v, simplices); }
    /// Frees the slot; the neighbours keep their links to it.
    void destroy(Handle h) {
        for (const VertexIndex v : slots_[h].vertex) vertices_.release(v);
        forget_fixed(h);
        this->give_back(h, no_handle);
        ++counters.deleted;
    }
    void connect(Link a, Link b) {
        point_at(a, b);
        point_at(b, a);
    }
    /// One side of it: beyond the facet `from` is the facet `to`.
    void point_at(Link from, Link to) { point_at(link_simplex(from), link_facet(from), to); }
    void point_at(Handle h, int facet, Link to) { slots_[h].link[facet] = to; }
    /// Writes a page of a mesh that is made in the order of keys, and keeps nothing of it.
    /// False, and nothing is written, if it would have too many bytes.
    bool append(const Key &lower, const Key &upper, const LooseSimplex<D> *simplices,
                std::size_t n);

    /// What is wrong with the cache, between two operations; null if nothing is.
    const char *check_invariants(bool forged = false) const;

    // ---- What the block cache calls (blocks/data_type.hpp) -------------------------

    void ask_for_code(const Simplex<D> &s) const { touch(&vertices_[s.vertex[0]].code); }
    void ask_for_contents(BlockIndex b) const;
    std::size_t bytes_beside_blocks() const {
        return vertices_.bytes() + visible_.bytes() + fixed_.size() * sizeof(FixedFacets<D>);
    }
    /// The neighbours' links follow.
    void moved(Handle from, Handle to) {
        if (const FixedFacets<D> facets = fixed(from); facets.any()) [[unlikely]] {
            set_fixed(to, facets);
            forget_fixed(from);
        }
        for (int i = 0; i <= D; ++i) {
            const Link link = slots_[from].link[i];
            if (is_absent(link))
                visible_[visible_facet(link)].owner = make_link(to, i);
            else if (link_simplex(link) == from) // a loose ridge
                slots_[to].link[i] = make_link(to, i);
            else
                slots_[link_simplex(link)].link[link_facet(link)] = make_link(to, i);
        }
    }
    PageContents open_page(const abacus_page &page);
    void tie(BlockIndex b);
    EncodedPage encode_page(BlockIndex b);
    void survey(BlockIndex b);
    void untie(BlockIndex b);
    void begin_eviction() { left_.clear(); }
    void end_eviction();

private:
    using Blocks::slots_, Blocks::blocks_, Blocks::notes_, Blocks::host_, Blocks::owner,
        Blocks::cached_owner, Blocks::load, Blocks::for_each_record, Blocks::for_each_cached,
        Blocks::first_of;

    /// The border of a block and its vertices: of the one that was tied, encoded or surveyed last.
    struct Border {
        explicit Border(const Host &host)
            : facets(host), hashes(host), vertices(host), has_vertex(host) {}

        BlockIndex block = no_block; // whose border it is
        Arena<Link> facets;          // whose neighbours are in other blocks, from inside
        Arena<std::uint32_t> hashes; // of these facets, among those visible
        typename VertexHeap<D>::Numbering vertices; // all of the block, by local number
        Arena<bool> has_vertex;                     // of these, whether they are on the border
    };

    FacetVertices<D, VertexIndex> facet(Link link) const {
        return {slots_[link_simplex(link)].vertex, link_facet(link)};
    }
    /// Of the facet, among those visible.
    std::uint32_t hash(Link link) const { return VisibleFacets<D>::hash(facet(link)); }

    // cache.cpp
    Handle closest_of_some(BlockIndex b, const Point<D> &p) const;

    // cache_load.cpp
    Link miss(Handle h, int facet);
    bool follow_stored_link(Handle h, int facet, const Key &beyond);
    bool present(Handle h, int facet) const { return !is_absent(slots_[h].link[facet]); }
    void load_vertices();
    /// To values_, as they are now.
    void read_attributes(int vertex);
    bool has_former_attributes(const abacus_page &page) const;
    VertexRun run_of_vertices() const;
    void load_simplices(Handle first);
    void load_fixed(Handle first);
    void link_outside();
    void link_outside(Link link, std::uint32_t hash, const Key &beyond);
    bool leads_to(const Key &link, Handle h) const;
    /// Both sides of a facet that is linked must say the same.
    void check_fixed(Link facet, Link beyond) const {
        if (fixed(facet) != fixed(beyond))
            throw_corrupted(is_fixed(facet) == is_fixed(beyond)
                                ? "A fixed edge is soft on one of its sides only."
                                : "An edge is fixed on one of its sides only.");
    }
    void forget_fixed(Handle h) {
        if (static_cast<std::size_t>(h) < fixed_.size()) [[unlikely]]
            fixed_[h] = {};
    }
    /// Of the slots of a block; null if none is fixed or in a region.
    const FixedFacets<D> *fixed_of(Handle first) const {
        return static_cast<std::size_t>(first) < fixed_.size() ? &fixed_[first] : nullptr;
    }

    // cache_store.cpp
    void mark_border();
    Key key_beyond(Handle h, int facet) const;

    // cache_append.cpp
    VertexIndex appended_vertex(const std::uint64_t *record);

    // probing.cpp
    void probe(Handle h, int facet);
    bool load_uncached(std::uint64_t code);
    bool quick_probe(Handle h, int facet, std::uint64_t greatest);
    bool ray_probe(Handle h, int facet, const Cell<D> &middle);
    bool concentric_probe(Handle h, int facet, const Cell<D> &middle);
    bool probe_every_page(Handle h, int facet);
    /// Edge, as a power of two, of the largest octant around a cell that lies in
    /// the cached block owning it.
    int octant_level(const Cell<D> &cell) const;

    // cache_check.cpp
    const char *check_links(Handle h) const;
    const char *check_vertices() const;

    Domain<D> domain_;
    CacheOptions options_;
    VertexHeap<D> vertices_;
    VisibleFacets<D> visible_;
    /// Of all slots, if there is or was anything in it; nothing of free ones.
    Arena<FixedFacets<D>, Handle> fixed_;

    // Page translation: reused from page to page.
    PageView<D> view_;
    InnerLinks<D> inner_links_;
    PageWriter<D> writer_;
    Border border_;
    Arena<VertexIndex> left_;   // border vertices of the blocks evicted together
    Arena<std::uint32_t> uses_; // of the vertices of the page being loaded
    Arena<double> values_;      // attributes of a vertex
    OtherValues<D> *other_values_ = nullptr;
    Arena<std::uint64_t> codes_;   // of the vertices of a page
    Arena<std::uint32_t> guesses_; // entries of the border's facets among the visible ones, perhaps
};

} // namespace abacus
