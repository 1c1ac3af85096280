// The simplex page: a block's serialized form, complete in itself.
//
//   header      what is in it, the interval [lower, upper) of keys it owns
//   ids         column of the vertices' ids (cache/bit_column.hpp)
//   points      column of the vertices' ranks on each axis
//   attributes  column of each attribute
//   codes       column of codes of vertices in other pages
//   parts       column of parts of the links' keys; all 0 in most meshes
//   links       for each facet whose neighbour is in another page, in the order simplex by
//               simplex, facet by facet: the number of the vertex whose code is that of the
//               neighbour's key; beyond the vertices come the codes
//   steps       D + 1 bits a simplex, see below
//   corners     vertex numbers that do not follow from the steps
//   checksum    8 bytes, XXH3 of all before
//
// Simplices come in trees, each breadth first across facets (cf. Rossignac's Edgebreaker,
// 1999). The root of a tree names its D + 1 vertices. Each other simplex shares a facet with
// its parent, and needs one vertex more, its apex. A bit tells whether that is the next vertex
// in the order of first use, or has to be named. D further bits tell, for each other facet,
// whether a child lies across it. Of a root all D + 1 bits do. So most vertex numbers and
// links need no bytes; of the links inside the page, half are known without a search.
//
// Everything is little-endian; the fields after the header start at whole bytes. Pages are
// ordinary column values that any writer of the table can change, so nothing in them is
// trusted: PageView::read checks sizes, counts, numbers and finiteness, and load() what
// concerns the topology. The checksum is there for what no check can tell: an id, an
// attribute, a small move of a vertex.
#pragma once

#include "cache/bit_column.hpp"
#include "cache/key.hpp"
#include "geometry/point.hpp"
#include "mesh/simplex.hpp"

#include <algorithm>
#include <utility>

namespace abacus {

struct PageHeader {
    static constexpr std::uint32_t expected_magic = 0x50534241; // "ABSP"
    static constexpr std::uint8_t expected_version = 2;

    std::uint32_t magic;
    std::uint8_t version;
    std::uint8_t dimension;
    std::uint8_t attributes;
    std::uint8_t reserved; // 0
    std::uint16_t simplices;
    std::uint16_t vertices;
    std::uint16_t links;
    std::uint16_t codes;
    Key lower, upper;
};
static_assert(sizeof(PageHeader) == 48);

inline constexpr std::size_t checksum_bytes = sizeof(std::uint64_t);
/// Writes the checksum into a page that is otherwise complete; `size` includes it.
void seal_page(unsigned char *bytes, std::size_t size);
/// Whether a page of at least checksum_bytes ends with its checksum.
bool page_is_sealed(const unsigned char *bytes, std::size_t size);

/// Vertices of a page are at most as many as simplices of a block.
template <int D> inline constexpr std::uint32_t page_vertices = block_slots<D>;

/// Vertices of the simplex across facet `f` of `parent`, whose apex is `apex`, in an order
/// of the same orientation with the point at infinity last; and the facet towards the parent.
template <int D, class Number>
constexpr int child_across(const Number *parent, int f, Number apex, Number infinity,
                           Number *child) {
    std::array<Number, D + 1> corner;
    for (int i = 0; i <= D; ++i) { // which one is replaced no processor can foresee
        const auto mask = static_cast<Number>(-(i == f));
        corner[i] = static_cast<Number>((parent[i] & ~mask) | (apex & mask));
    }
    if (apex == infinity && f != D) [[unlikely]] {
        std::swap(corner[f], corner[D]);
        for (int i = 0; i <= D; ++i) child[i] = corner[i];
        return D;
    }
    child[0] = corner[1];
    child[1] = corner[0];
    for (int i = 2; i <= D; ++i) child[i] = corner[i];
    return f ^ static_cast<int>(f < 2);
}

/// A stored page, checked. What it says of vertices is read in place: it is valid as long as
/// its bytes.
template <int D> class PageView {
public:
    enum class Checksum { verify, ignore };

    /// Throws Error (corrupted) unless the bytes are a page of this dimension with
    /// `attributes` attributes.
    void read(const unsigned char *bytes, std::size_t size, int attributes,
              Checksum checksum = Checksum::verify);

    const Key &lower() const { return header_.lower; }
    const Key &upper() const { return header_.upper; }
    int simplices() const { return header_.simplices; }
    int vertices() const { return header_.vertices; }
    int links() const { return header_.links; }
    int attributes() const { return header_.attributes; }

    /// Whether the box of the page's vertices meets the box [lower, upper].
    bool meets(const Point<D> &lower, const Point<D> &upper) const {
        for (int i = 0; i < D; ++i)
            if (upper[i] < box(i) || box(D + i) < lower[i]) return false;
        return true;
    }
    /// The box's lower bounds, then its upper ones.
    double box(int i) const { return box_[i]; }
    std::int64_t id(int vertex) const { return static_cast<std::int64_t>(ids_[vertex]); }
    const Point<D> &point(int vertex) const { return points_[vertex]; }
    double attribute(int vertex, int i) const {
        return from_ordered(attributes_[i][vertex]);
    }

    /// Number of the vertex whose code is the link's; from vertices() on, foreign_code()
    /// has the code.
    int link_vertex(int link) const { return static_cast<int>(link_vertices_[link]); }
    std::uint64_t foreign_code(int link_vertex) const { return codes_[link_vertex - vertices()]; }
    bool has_parts() const { return has_parts_; }
    std::uint64_t link_part(int link) const { return has_parts_ ? parts_[link] : unknown_part; }

    /// Vertex number of a corner; vertices() for the point at infinity.
    int corner(int simplex, int i) const { return corners_[simplex * (D + 1) + i]; }
    const std::uint16_t *corners(int simplex) const { return &corners_[simplex * (D + 1)]; }
    bool is_ghost(int simplex) const { return corner(simplex, D) == vertices(); }

    /// The facet across which a simplex was reached, as its parent sees it: simplices of the
    /// page are its handles; `no_link` of a root.
    static constexpr std::uint16_t no_link = 0xffff;
    std::uint16_t parent(int simplex) const { return steps_[simplex].parent; }
    /// ... and as the simplex itself sees it.
    int facet_to_parent(int simplex) const { return steps_[simplex].facet; }

private:
    struct Step {
        std::uint16_t parent;
        std::uint16_t facet;
    };

    void read_header(const unsigned char *bytes, std::size_t size, int attributes);
    void read_points();
    void read_simplices(BitFields steps, const unsigned char *at, const unsigned char *end);
    /// Reads the corners of a tree's first simplex; returns how many vertices are known then.
    int read_root(int simplex, const BitFields &numbers, std::size_t named, int fresh);

    PageHeader header_;
    Column ids_;
    std::array<Column, D> axes_;
    std::array<Column, ABACUS_MAX_ATTRIBUTES> attributes_;
    Column codes_, parts_;
    BitFields link_vertices_;
    bool has_parts_;
    std::array<double, 2 * D> box_;
    std::array<Point<D>, page_vertices<D>> points_;
    std::array<std::uint16_t, block_slots<D> *(D + 1)> corners_;
    std::array<Step, block_slots<D> + D + 1> steps_; // the last ones are overwritten
};

} // namespace abacus
