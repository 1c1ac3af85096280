// Attributes of vertices in pages of their own.
//
// A simplex page is complete in itself, so whatever a vertex carries would be stored in each page
// that names it. A mesh whose attributes take many bytes has them apart: each vertex once, found
// by its place alone. Location and walks read none of these pages.
//
// The order of vertices is that of their codes, and of a hash of their coordinates where codes are
// equal. Vertices with the same key, which only happens on purpose, share a page. The attributes of
// a mesh are cut into groups, and each group has pages of its own, from one end of the curve to the
// other: who reads one attribute of many reads its group. So the first word of a page's key is the
// group, followed by the code, which goes on in the second word, followed by the hash.
//
//   header    what is in it
//   heads     of the columns (blocks/bit_column.hpp): ranks of the vertices on each axis, then each
//             attribute of the group
//   deltas    of the columns, in the same order
//   checksum  8 bytes, XXH3 of all before
//
// Pages own intervals of keys without saying so: each from its key to that of the next, or to the
// end of its group; the first one of a group begins at the least key of all. Nothing read here is
// trusted.
#pragma once

#include "blocks/bit_column.hpp"
#include "geometry/point.hpp"
#include "host/arena.hpp"
#include "keys/key.hpp"
#include "keys/locational_code.hpp"

#include "attributes/attribute_groups.hpp"

#include <array>

namespace abacus {

inline constexpr int attribute_hash_bits = 53, attribute_code_low_bits = 10;
/// Codes have 63 bits, a key's words as many.
inline constexpr int attribute_group_shift = 63 - attribute_code_low_bits;

/// The least key of a group; also the end of the one before.
constexpr Key group_begin(unsigned group) {
    return {std::uint64_t{group} << attribute_group_shift, 0};
}
constexpr unsigned group_of(const Key &key) {
    return static_cast<unsigned>(key.code >> attribute_group_shift);
}

template <int D> std::uint64_t hash_of(const Point<D> &p) {
    std::uint64_t h = 0;
    for (const double x : p) {
        h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15ull;
        h ^= h >> 32;
    }
    h *= 0xff51afd7ed558ccdull;
    return h ^ h >> 29;
}

/// Key of a vertex in the first group.
template <int D> Key attribute_key(const Point<D> &p, std::uint64_t code) {
    constexpr std::uint64_t low = (std::uint64_t{1} << attribute_code_low_bits) - 1;
    return {code >> attribute_code_low_bits,
            (code & low) << attribute_hash_bits | hash_of<D>(p) >> (64 - attribute_hash_bits)};
}
/// The same in another one.
constexpr Key in_group(const Key &key, unsigned group) {
    return {group_begin(group).code | key.code, key.part};
}

/// For standard algorithms.
struct KeyBefore {
    constexpr bool operator()(const Key &a, const Key &b) const { return a < b; }
};

struct AttributePageHeader {
    static constexpr std::uint32_t expected_magic = 0x54544241; // "ABTT"
    static constexpr std::uint8_t expected_version = 1;

    std::uint32_t magic;
    std::uint8_t version;
    std::uint8_t dimension;
    std::uint16_t group;
    std::uint16_t columns;
    std::uint16_t vertices;
    std::uint32_t reserved; // 0
};
static_assert(sizeof(AttributePageHeader) == 16);

/// A stored page, checked; read in place, and valid as long as its bytes.
template <int D> class AttributePage {
public:
    /// Throws Error (corrupted) unless the bytes are a page of this group with so many columns.
    void read(const unsigned char *bytes, std::size_t size, unsigned group, unsigned columns);

    std::size_t vertices() const { return vertices_; }
    Point<D> point(std::size_t vertex) const {
        Point<D> p;
        for (int i = 0; i < D; ++i) p[i] = from_ordered(axes_[i][vertex]);
        return p;
    }
    double value(std::size_t vertex, unsigned column) const {
        return from_ordered(columns_[column][vertex]);
    }
    /// The rank of a coordinate, or of an attribute behind those.
    std::uint64_t rank(std::size_t vertex, unsigned column) const {
        return column < D ? axes_[column][vertex] : columns_[column - D][vertex];
    }
    /// Computes the keys of the vertices, in the page's group. Throws unless they ascend and lie
    /// in the interval.
    void keys(const Domain<D> &domain, const Key &lower, const Key &upper, Arena<Key> &keys) const;

private:
    std::size_t vertices_ = 0;
    unsigned group_ = 0;
    std::array<Column, D> axes_;
    std::array<Column, AttributeGroups::widest> columns_;
};

/// Vertices of a page at most, however little they take: as many as are read, and as are written.
/// Readers hold 16 bytes for each beside the page.
inline constexpr std::size_t most_in_attribute_page = 8192;
inline constexpr std::size_t most_written_in_attribute_page = 1024;

/// Writes pages from rows of ranks: coordinates, then the attributes of a group.
class AttributePageWriter {
public:
    AttributePageWriter(const Host &host, int dimension, unsigned group, unsigned columns)
        : dimension_(dimension), group_(group), stride_(static_cast<unsigned>(dimension) + columns),
          column_(host) {}

    unsigned stride() const { return stride_; }
    /// Bytes of a page of the first n rows.
    std::size_t size(const std::uint64_t *rows, std::size_t n);
    /// How many of n rows fit a page, nearly; all if they do.
    std::size_t count_that_fits(const std::uint64_t *rows, std::size_t n);
    /// The page of n rows, which fit.
    void write(const std::uint64_t *rows, std::size_t n);

    const unsigned char *bytes() const { return bytes_; }
    std::size_t size() const { return size_; }

private:
    const std::uint64_t *gather(const std::uint64_t *rows, std::size_t n, unsigned column);

    const int dimension_;
    const unsigned group_, stride_;
    Arena<std::uint64_t> column_;
    std::size_t size_ = 0;
    alignas(8) unsigned char bytes_[ABACUS_PAGE_BYTES + sizeof(std::uint64_t)];
};

extern template class AttributePage<2>;
extern template class AttributePage<3>;

} // namespace abacus
