// The simplex page: a block's serialized form, complete in itself.
//
//   header      what is in it, the interval [lower, upper) of keys it owns
//   box         bounding box of its vertices: D doubles lower, D upper
//   ids         int64 of each vertex; vertices on the page's border come first
//   points      D doubles of each vertex
//   attributes  the vertex's attributes, doubles
//   links       for each facet whose neighbour is in another page, in the order
//               simplex by simplex, facet by facet: the code of the neighbour's key
//   parts       the parts of those keys, if any is not 0 (flag long_links)
//   simplices   D + 1 vertex numbers each, of 8 bits, or of 16 (flag wide); the
//               number after the last vertex is the point at infinity
//
// Links between simplices of one page are not stored: they follow from the vertex
// numbers, and finding them again at load costs less than their bytes would.
// Everything is little-endian and aligned to its size. Pages are ordinary column
// values that any writer of the table can change, so nothing in them is trusted:
// PageView::parse checks sizes, counts, numbers and finiteness, and load() what
// concerns the topology.
#pragma once

#include "cache/key.hpp"
#include "geometry/point.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace abacus {

struct PageHeader {
    static constexpr std::uint32_t expected_magic = 0x50534241; // "ABSP"
    static constexpr std::uint8_t expected_version = 1;
    enum Flags : std::uint8_t { wide = 1, long_links = 2 };

    std::uint32_t magic;
    std::uint8_t version;
    std::uint8_t dimension;
    std::uint8_t attributes;
    std::uint8_t flags;
    std::uint16_t simplices;
    std::uint16_t vertices;
    std::uint16_t border_vertices;
    std::uint16_t links;
    Key lower, upper;
};
static_assert(sizeof(PageHeader) == 48);

/// Where the arrays of a page lie; the same sums serve writing and reading.
template <int D> struct PageLayout {
    std::size_t box, ids, points, attributes, links, parts, simplices, size;

    explicit PageLayout(const PageHeader &h) {
        const std::size_t v = h.vertices, l = h.links;
        box = sizeof(PageHeader);
        ids = box + 2 * D * sizeof(double);
        points = ids + v * sizeof(std::int64_t);
        attributes = points + v * D * sizeof(double);
        links = attributes + v * h.attributes * sizeof(double);
        parts = links + l * sizeof(std::uint64_t);
        simplices = parts + (h.flags & PageHeader::long_links ? l * sizeof(std::uint64_t) : 0);
        const std::size_t number = h.flags & PageHeader::wide ? 2 : 1;
        size = simplices + std::size_t(h.simplices) * (D + 1) * number;
    }
};

/// A stored page, checked and readable in place. Valid as long as its bytes.
template <int D> class PageView {
public:
    /// Throws Error (corrupted) unless the bytes are a page of this dimension with
    /// `attributes` attributes.
    static PageView parse(const unsigned char *bytes, std::size_t size, int attributes);

    const Key &lower() const { return header_.lower; }
    const Key &upper() const { return header_.upper; }
    int simplices() const { return header_.simplices; }
    int vertices() const { return header_.vertices; }
    int border_vertices() const { return header_.border_vertices; }
    int links() const { return header_.links; }
    int attributes() const { return header_.attributes; }

    /// Whether the box of the page's vertices meets the box [lower, upper].
    bool meets(const Point<D> &lower, const Point<D> &upper) const {
        for (int i = 0; i < D; ++i)
            if (upper[i] < box(i) || box(D + i) < lower[i]) return false;
        return true;
    }
    /// The box's lower bounds, then its upper ones.
    double box(int i) const { return get<double>(layout_.box, i); }
    bool has_parts() const { return (header_.flags & PageHeader::long_links) != 0; }
    std::int64_t id(int vertex) const { return get<std::int64_t>(layout_.ids, vertex); }
    Point<D> point(int vertex) const {
        Point<D> p;
        std::memcpy(p.data(), bytes_ + layout_.points + vertex * sizeof p, sizeof p);
        return p;
    }
    double attribute(int vertex, int i) const {
        return get<double>(layout_.attributes, vertex * header_.attributes + i);
    }
    const double *attributes(int vertex) const {
        return reinterpret_cast<const double *>(bytes_ + layout_.attributes) +
               vertex * header_.attributes;
    }
    Key link(int i) const {
        return {get<std::uint64_t>(layout_.links, i),
                has_parts() ? get<std::uint64_t>(layout_.parts, i) : unknown_part};
    }
    /// Vertex number of a corner; vertices() for the point at infinity.
    int corner(int simplex, int i) const {
        const int at = simplex * (D + 1) + i;
        return header_.flags & PageHeader::wide ? get<std::uint16_t>(layout_.simplices, at)
                                                : bytes_[layout_.simplices + at];
    }
    bool is_ghost(int simplex) const { return corner(simplex, D) == vertices(); }

private:
    PageView(const unsigned char *bytes, const PageHeader &header)
        : bytes_(bytes), header_(header), layout_(header) {}

    template <class T> T get(std::size_t base, std::size_t i) const {
        T value;
        std::memcpy(&value, bytes_ + base + i * sizeof(T), sizeof(T));
        return value;
    }

    const unsigned char *bytes_;
    PageHeader header_;
    PageLayout<D> layout_;
};

} // namespace abacus
