// Makes simplex pages (cache/page_format.hpp) of vertices, simplices and links, wherever
// these come from.
//
//   order(), then each vertex and each link, then finish()
//
// A facet is told what lies across it: a simplex of the page, a link by its number, or
// `untold`. Whoever reads the page finds out what is untold by comparing vertices; it only
// takes more bytes and time. When all facets are untold, links come in the order of those
// that turn out to lie on the border.
#pragma once

#include "cache/page_format.hpp"
#include "host/arena.hpp"

namespace abacus {

template <int D> class PageWriter {
public:
    static constexpr std::uint32_t at_infinity = 0xffffffffu; // corner
    static constexpr Link untold = 0xffffffffu;               // neighbour
    /// Neighbour in another page: the number of a link.
    static constexpr Link outside(std::size_t link) { return absent | static_cast<Link>(link); }

    explicit PageWriter(const Host &host)
        : order_(host), reached_(host), written_(host), numbers_(host), named_(host),
          link_order_(host), links_(host), codes_(host), columns_(host), plans_(host),
          foreign_(host), parts_(host), link_vertices_(host), index_(host) {}

    /// Begins a page of `simplices` simplices: D + 1 corners of each, by the numbers of
    /// `vertices` vertices, the point at infinity last; and what lies across each facet.
    /// Neighbours in the page are links to simplices by their numbers. Only the first `shared`
    /// vertices belong to other pages too; there are `links` facets towards these.
    void order(const std::uint32_t *corners, const Link *across, std::size_t simplices,
               std::size_t vertices, std::size_t shared, std::size_t links, int attributes);
    /// A vertex and its code; `attributes` may be null when there are none.
    void set_vertex(std::size_t vertex, std::int64_t id, const Point<D> &point,
                    std::uint64_t code, const double *attributes) {
        if (vertex < shared_) codes_[vertex] = code;
        std::uint64_t *word = columns_.data() + numbers_[1 + vertex];
        *word = static_cast<std::uint64_t>(id);
        for (const double x : point) *(word += vertices_) = ordered(x);
        for (int i = 0; i < attributes_; ++i) *(word += vertices_) = ordered(attributes[i]);
    }
    /// Key of a neighbour in another page.
    void set_link(std::size_t link, const Key &key) { links_[link] = key; }
    /// Makes the page that owns [lower, upper); false if it would have too many bytes, or
    /// too many vertices.
    bool finish(const Key &lower, const Key &upper);

    const unsigned char *bytes() const { return page_; }
    /// Bytes of the page; also of one that has too many.
    std::size_t size() const { return size_; }

private:
    static constexpr std::uint16_t none = 0xffff;

    void code_links();
    void plan_columns();
    std::size_t planned_size() const;
    void write(const Key &lower, const Key &upper);

    std::size_t simplices_ = 0, vertices_ = 0, shared_ = 0;
    int attributes_ = 0;

    // What comes out, in the page's order.
    struct Placed {
        std::uint32_t simplex; // as added
        std::uint16_t parent;  // no link for a root
        std::uint8_t mirror;   // facet to the parent, as added
        std::uint8_t step;
    };
    Arena<Placed> order_;
    Arena<std::uint8_t> reached_;  // of the simplices as added
    Arena<std::uint32_t> written_; // corners as added, in the page's order
    Arena<std::uint16_t> numbers_; // of the point at infinity, then the vertices as added
    Arena<std::uint16_t> named_;   // numbers that do not follow from the steps
    Arena<std::uint32_t> link_order_;
    Arena<Key> links_;             // as added
    Arena<std::uint64_t> codes_;   // of the shared vertices, as added
    Arena<std::uint64_t> columns_; // ids, ranks of coordinates and of attributes
    Arena<ColumnPlan> plans_;
    Arena<std::uint64_t> foreign_; // codes
    Arena<std::uint64_t> parts_;
    ColumnPlan foreign_plan_, parts_plan_;
    Arena<std::uint16_t> link_vertices_;
    Arena<std::uint16_t> index_; // hash table: codes to numbers
    alignas(8) unsigned char page_[ABACUS_PAGE_BYTES + 8]; // BitWriter writes beyond
    std::size_t size_ = 0;
};

} // namespace abacus
