// The simplex page: a block's serialized form, complete in itself.
//
//   header      what is in it, the interval [lower, upper) of keys it owns
//   patches     for each, how far corners and vertices go, and the box of its vertices
//   heads       of the columns (blocks/bit_column.hpp): ranks of the vertices on each axis, their
//               ids, each attribute, codes of vertices in other pages, parts of the links'
//               keys, which are all 0 in most meshes
//   steps       D + 1 bits a simplex, see below
//   corners     vertex numbers that do not follow from the steps
//   deltas      of the columns, in the same order
//   links       for each facet whose neighbour is in another page, in the order simplex by
//               simplex, facet by facet: the number of the vertex whose code is that of the
//               neighbour's key; beyond the vertices come the codes
//   fixed       if a facet is fixed, D + 1 bits a simplex: which of its facets are; if one is soft,
//               D + 1 more: which of these are soft
//   regions     if a simplex is in a region, a column, head and deltas together: the number of
//               each simplex's region
//   checksum    8 bytes, XXH3 of all before
//
// Simplices come in trees, each breadth first across facets (cf. Rossignac's Edgebreaker,
// 1999). The root of a tree names its D + 1 vertices. Each other simplex shares a facet with
// its parent, and needs one vertex more, its apex. A bit tells whether that is the next vertex
// in the order of first use, or has to be named. D further bits tell, for each other facet,
// whether a child lies across it. Of a root all D + 1 bits do. So most vertex numbers and
// links need no bytes; of the links inside the page, half are known without a search.
//
// Simplices by the dozen make a patch. No tree goes on from one to the next, so each can be read
// by itself; and trees that end early are compact. Who looks for the simplex at a place reads
// the patches whose boxes contain it: on average one and a half of twelve in the plane.
//
// Everything is little-endian; the fields after the header start at whole bytes. Pages are
// ordinary column values that any writer of the table can change, so nothing in them is
// trusted: PageView::read checks sizes, counts, numbers and finiteness, and load() what
// concerns the topology. The checksum is there for what no check can tell: an id, an
// attribute, a small move of a vertex.
#pragma once

#include "blocks/bit_column.hpp"
#include "blocks/page_seal.hpp"
#include "geometry/point.hpp"
#include "keys/key.hpp"
#include "mesh/fixed_facets.hpp"
#include "mesh/page_tree.hpp"
#include "mesh/simplex.hpp"

#include <algorithm>

namespace abacus {

struct PageHeader {
    static constexpr std::uint32_t expected_magic = 0x50534241; // "ABSP"
    static constexpr std::uint8_t expected_version = 3;
    static constexpr unsigned has_regions = 4;

    std::uint32_t magic;
    std::uint8_t version;
    std::uint8_t dimension;
    std::uint8_t attributes;
    /// 1: some facets are fixed; 2: and some of these are soft. 4 is added if there are regions.
    std::uint8_t lined;
    std::uint16_t simplices;
    std::uint16_t vertices;
    std::uint16_t links;
    std::uint16_t codes;
    Key lower, upper;
};
static_assert(sizeof(PageHeader) == 48);

/// Simplices of a patch; the last one of a page may have fewer.
inline constexpr int patch_simplices = 64;

/// A patch ends where the next one begins.
template <int D> struct PagePatch {
    std::uint16_t named_end; // of the numbers in `corners`
    std::uint16_t fresh_end; // of the vertices in the order of first use
    /// Of its vertices' ranks.
    std::array<Column::Prefix, D> least, greatest;
};
static_assert(sizeof(PagePatch<2>) == 12 && sizeof(PagePatch<3>) == 16);

constexpr std::size_t patches_of(std::size_t simplices) {
    return (simplices + patch_simplices - 1) / patch_simplices;
}

/// Vertices of a page are at most as many as simplices of a block.
template <int D> inline constexpr std::uint32_t page_vertices = block_slots<D>;

/// A stored page, checked. What it says of vertices is read in place: it is valid as long as
/// its bytes.
///
/// Who looks for one simplex opens the page and reads patches until it is found. What has been
/// read has been checked; what else is there has not been looked at.
template <int D> class PageView {
public:
    enum class Checksum { verify, ignore };
    struct Range {
        int begin, end;
    };

    /// Throws Error (corrupted) unless the bytes are a page of this dimension with
    /// `attributes` attributes.
    void read(const unsigned char *bytes, std::size_t size, int attributes,
              Checksum checksum = Checksum::verify);

    /// The same in parts. First all but links, points and simplices, ...
    void open(const unsigned char *bytes, std::size_t size, int attributes,
              Checksum checksum = Checksum::verify);
    /// ... then all that is left, ...
    void read_rest();
    /// ... or patches, in any order.
    void read_patch(int patch);
    int patches() const { return static_cast<int>(patches_of(header_.simplices)); }
    Range simplices_of(int patch) const {
        return {patch * patch_simplices, std::min((patch + 1) * patch_simplices, simplices())};
    }
    /// Vertices of a patch: those that are used there first, and what its numbers name, the point
    /// at infinity, vertices(), among them.
    Range fresh_of(int patch) const {
        return {patch == 0 ? 0 : patches_[patch - 1].fresh_end, patches_[patch].fresh_end};
    }
    Range named_of(int patch) const {
        return {patch == 0 ? 0 : patches_[patch - 1].named_end, patches_[patch].named_end};
    }
    int named(int i) const {
        return static_cast<int>(numbers_.narrow(static_cast<std::size_t>(i)));
    }
    /// The box of a patch's vertices.
    const PagePatch<D> &patch(int patch) const { return patches_[patch]; }
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
    void ask_for_id(int vertex) const { ids_.ask_for(static_cast<std::size_t>(vertex)); }
    std::int64_t id(int vertex) const { return static_cast<std::int64_t>(ids_[vertex]); }
    const Point<D> &point(int vertex) const { return points_[vertex]; }
    /// Whether the head of an attribute's column lets a value be from `least` to `greatest`; true
    /// where one is.
    bool may_have_attribute(int i, double least, double greatest) const {
        return column_may_have(attributes_[i], least, greatest);
    }
    double attribute(int vertex, int i) const { return from_ordered(attributes_[i][vertex]); }

    /// Number of the vertex whose code is the link's; from vertices() on, foreign_code()
    /// has the code.
    int link_vertex(int link) const { return static_cast<int>(link_vertices_[link]); }
    std::uint64_t foreign_code(int link_vertex) const { return codes_[link_vertex - vertices()]; }
    bool has_parts() const { return has_parts_; }
    std::uint64_t link_part(int link) const { return has_parts_ ? parts_[link] : unknown_part; }

    /// Vertex number of a corner; vertices() for the point at infinity.
    int corner(int simplex, int i) const { return corners(simplex)[i]; }
    const Lanes &corners(int simplex) const { return corners_[simplex]; }
    /// Whether a facet is fixed or a simplex in a region.
    bool is_lined() const { return header_.lined != 0; }
    FixedFacets<D> fixed(int simplex) const {
        const unsigned facets = fixed_width() != 0 ? static_cast<unsigned>(fixed_[simplex]) : 0u;
        return FixedFacets<D>::from_bits(facets, region(simplex));
    }
    bool has_regions() const { return (header_.lined & PageHeader::has_regions) != 0; }
    /// Whether the head of the column lets a simplex be in this region; true where one is.
    bool may_have_region(RegionNumber region) const {
        return has_regions() && regions_.may_have(region, region);
    }
    /// Its number; checked by read_rest() alone.
    RegionNumber region(int simplex) const {
        return has_regions() ? static_cast<RegionNumber>(regions_[simplex]) : no_region;
    }
    bool is_ghost(int simplex) const { return corner(simplex, D) == vertices(); }

    /// The facet across which a simplex was reached, as its parent sees it: `no_link` of
    /// a root.
    static constexpr PageLink no_link = 0xffff;
    PageLink parent(int simplex) const { return parents_[simplex]; }
    /// ... and as the simplex itself sees it.
    int facet_to_parent(int simplex) const {
        const PageLink up = parent(simplex);
        const bool begins_ghosts =
            is_ghost(simplex) && !is_ghost(static_cast<int>(page_simplex(up)));
        return begins_ghosts ? D : facet_back(page_facet(up));
    }

private:
    /// So many steps end with a byte, and come in one word.
    static constexpr int simplices_at_once = 16;
    static_assert(patch_simplices % simplices_at_once == 0);

    void read_header(const unsigned char *bytes, std::size_t size, int attributes);
    /// Takes the patches off the bytes.
    void read_patches(const unsigned char *&at, const unsigned char *end);
    int fixed_width() const {
        return (header_.lined & ~PageHeader::has_regions) * FixedFacets<D>::width;
    }
    void read_points();
    void check_regions() const;
    /// Reads the corners of a tree's first simplex; returns how many vertices are known then.
    std::size_t read_root(int simplex, std::size_t named, std::size_t fresh);

    PageHeader header_;
    std::array<PagePatch<D>, patches_of(block_slots<D>)> patches_;
    std::array<Column, D> axes_;
    Column ids_;
    std::array<Column, ABACUS_MAX_PAGE_ATTRIBUTES> attributes_;
    Column codes_, parts_, regions_;
    BitFields link_vertices_;
    bool has_parts_;
    BitFields steps_, numbers_, fixed_;
    std::array<double, 2 * D> box_;
    std::array<Point<D>, page_vertices<D>> points_;
    std::array<Lanes, block_slots<D>> corners_;
    // The last ones are overwritten, until it is known that there are too many.
    std::array<PageLink, block_slots<D> + simplices_at_once *(D + 2) + lanes> parents_;
};

} // namespace abacus
