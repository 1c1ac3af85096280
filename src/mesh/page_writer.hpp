// Makes simplex pages (mesh/page_format.hpp) of simplices and their vertices.
//
//   order(), then each link, then finish()
//
// A link to a simplex of the page tells what lies across the facet, one to anywhere else that
// the facet is on the page's border. A facet may also be `untold`: the reader of the page
// finds out by comparing vertices; it only takes more bytes and time.
#pragma once

#include "host/arena.hpp"
#include "mesh/page_format.hpp"
#include "mesh/vertex_heap.hpp"

namespace abacus {

template <int D> class PageWriter {
public:
    using Vertices = VertexHeap<D>;
    using Numbering = typename VertexHeap<D>::Numbering;

    static constexpr Link untold = unset;

    explicit PageWriter(const Host &host)
        : order_(host), patches_(host), prefixes_(host), reached_(host), cut_(host), corners_(host),
          named_(host), links_(host), columns_(host), plans_(host), foreign_(host), parts_(host),
          link_vertices_(host), fixed_(host), regions_(host), codes_(host), coded_(host),
          index_(host) {}

    /// Begins a page of the simplices in the slots [slots, end), whose handles begin with
    /// `first`. Sets `numbered` to the page's vertices and `border` to the inner sides of its
    /// border, both in the page's order. `fixed` is of the slots; null if no facet is fixed
    /// and no simplex in a region.
    void order(const Simplex<D> *slots, std::uint32_t end, Handle first, Vertices &vertices,
               Numbering &numbered, Arena<Link> &border, const FixedFacets<D> *fixed = nullptr);
    /// So many links follow, where facets are untold: in the order of those that turn out to
    /// lie on the border.
    void expect_links(std::size_t links) { links_.resize(links); }
    /// Key of the neighbour across a facet of the border.
    void set_link(std::size_t link, const Key &key) { links_[link] = key; }
    /// Makes the page that owns [lower, upper), of these vertices, those on the border marked;
    /// false if it would have too many bytes, or too many vertices.
    bool finish(const Key &lower, const Key &upper, const Vertices &vertices,
                const Numbering &numbered, const bool *on_border);

    const unsigned char *bytes() const { return page_; }
    /// Bytes of the page; also of one that has too many, but 0 if it has too many vertices.
    std::size_t size() const { return size_; }

private:
    static constexpr std::uint16_t none = 0xffff;

    class Tour; // page_order.cpp

    void gather(const Vertices &vertices, const Numbering &numbered);
    /// In the page's order.
    void gather_fixed(const Simplex<D> *slots, const FixedFacets<D> *fixed);
    void gather_regions(const FixedFacets<D> *fixed);
    void bound_patches();
    void code_links(const Vertices &vertices, const Numbering &numbered, const bool *on_border);
    std::size_t planned_size() const;
    void write(const Key &lower, const Key &upper);

    std::size_t simplices_ = 0, vertices_ = 0;
    int attributes_ = 0;

    // What comes out, in the page's order.
    struct Placed {
        std::uint32_t slot;
        PageLink parent;     // no link for a root
        std::uint8_t mirror; // facet to the parent, in the slot
        std::uint8_t step;
    };
    Arena<Placed> order_;
    Arena<PagePatch<D>> patches_;
    Arena<Column::Prefix> prefixes_; // of the vertices on an axis
    Arena<std::uint8_t> reached_;    // of the slots
    Arena<std::uint32_t> cut_;       // slots that a full patch had no room for
    Arena<WideLanes> corners_;
    Arena<std::uint16_t> named_; // numbers that do not follow from the steps; none: infinity
    Arena<Key> links_;
    Arena<std::uint64_t> columns_; // ranks of coordinates, ids, ranks of attributes
    Arena<ColumnPlan> plans_;
    Arena<std::uint64_t> foreign_; // codes
    Arena<std::uint64_t> parts_;
    ColumnPlan foreign_plan_, parts_plan_;
    Arena<std::uint16_t> link_vertices_;
    Arena<std::uint8_t> fixed_;    // bits of the simplices; empty if no facet is fixed
    int fixed_width_ = 0;          // of each
    Arena<std::uint64_t> regions_; // of the simplices; empty if none is in one
    ColumnPlan regions_plan_;
    Arena<std::uint64_t> codes_;                           // that index_ knows
    Arena<std::uint16_t> coded_;                           // their numbers
    Arena<std::uint16_t> index_;                           // hash table of codes_
    alignas(8) unsigned char page_[ABACUS_PAGE_BYTES + 8]; // BitWriter writes beyond
    std::size_t size_ = 0;
};

} // namespace abacus
