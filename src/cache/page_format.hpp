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
#include "cache/page_tree.hpp"
#include "geometry/point.hpp"
#include "mesh/simplex.hpp"

#include <algorithm>

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

/// A stored page, checked. What it says of vertices is read in place: it is valid as long as
/// its bytes.
///
/// Who looks for one simplex opens the page and reads on until it is found. What has been read
/// has been checked; what comes behind has not been looked at.
template <int D> class PageView {
public:
    enum class Checksum { verify, ignore };

    /// Throws Error (corrupted) unless the bytes are a page of this dimension with
    /// `attributes` attributes.
    void read(const unsigned char *bytes, std::size_t size, int attributes,
              Checksum checksum = Checksum::verify);

    /// The same in parts. First all but links, points and simplices, ...
    void open(const unsigned char *bytes, std::size_t size, int attributes,
              Checksum checksum = Checksum::verify);
    /// ... then the simplices before this one, and perhaps a few more; returns how many have been
    /// read by now.
    int read_simplices(int until);
    /// Vertices of the simplices that have been read: they are numbered in order of use.
    int vertices_read() const { return fresh_; }
    /// The coordinate of a vertex as it is stored, ordered().
    const Column &ranks(int axis) const { return axes_[axis]; }
    /// One vertex's point(), and no others'.
    void read_point(int vertex);

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
    int corner(int simplex, int i) const { return corners(simplex)[i]; }
    const Lanes &corners(int simplex) const { return corners_[simplex]; }
    bool is_ghost(int simplex) const { return corner(simplex, D) == vertices(); }

    /// The facet across which a simplex was reached, as its parent sees it: simplices of the
    /// page are its handles; `no_link` of a root.
    static constexpr std::uint16_t no_link = 0xffff;
    std::uint16_t parent(int simplex) const { return parents_[simplex]; }
    /// ... and as the simplex itself sees it.
    int facet_to_parent(int simplex) const {
        const std::uint16_t up = parent(simplex);
        const bool begins_ghosts = is_ghost(simplex) && !is_ghost(link_simplex(up));
        return begins_ghosts ? D : facet_back(link_facet(up));
    }

private:
    /// So many steps end with a byte, and come in one word.
    static constexpr int simplices_at_once = 16;

    void read_header(const unsigned char *bytes, std::size_t size, int attributes);
    void read_points();
    /// Reads the corners of a tree's first simplex; returns how many vertices are known then.
    int read_root(int simplex, std::size_t named, int fresh);

    PageHeader header_;
    Column ids_;
    std::array<Column, D> axes_;
    std::array<Column, ABACUS_MAX_ATTRIBUTES> attributes_;
    Column codes_, parts_;
    BitFields link_vertices_;
    bool has_parts_;
    BitFields steps_, numbers_;
    const unsigned char *end_; // of the numbers
    std::size_t most_named_;   // numbers before the end
    // How far read_simplices() has come:
    std::size_t named_;  // numbers read
    int fresh_;          // vertices used
    int reached_, read_; // simplices
    std::array<double, 2 * D> box_;
    std::array<Point<D>, page_vertices<D>> points_;
    std::array<Lanes, block_slots<D>> corners_;
    // The last ones are overwritten, until it is known that there are too many.
    std::array<std::uint16_t, block_slots<D> + simplices_at_once * (D + 2) + lanes> parents_;
};

} // namespace abacus
