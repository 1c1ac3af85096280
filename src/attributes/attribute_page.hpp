// Attributes in pages of their own.
//
// A simplex page is complete in itself, so whatever a vertex carries would be stored in each page
// that names it. A mesh whose attributes take many bytes has them apart: each vertex once, found
// by its place alone. Location and walks read none of these pages. Simplices have their
// attributes so as well, those that have any: attribute_key.hpp tells who is named how.
//
// The order of owners is that of their keys. Those with the same key, which only happens on
// purpose, share a page. To read one attribute of many, read its group.
//
//   header    what is in it
//   heads     of the columns (blocks/bit_column.hpp): ranks of the points on each axis; for each
//             point of an owner its number, and which attributes are NULL, unless owners are
//             vertices; then each attribute of the group
//   deltas    of the columns, in the same order
//   checksum  8 bytes, XXH3 of all before
//
// The points of a page of vertices are these. Simplices share their points: a page has each once,
// in lexicographic order, so the numbers of an owner's ascend. What is NULL takes a bit; its column
// repeats some other value there, which makes no delta wider.
//
// Pages own intervals of keys without saying so: each from its key to that of the next, or to the
// end of its group; the first one of a group begins at the least key of all. Nothing read here is
// trusted.
#pragma once

#include "attributes/attribute_groups.hpp"
#include "attributes/attribute_key.hpp"
#include "host/arena.hpp"

#include <array>

namespace abacus {

struct AttributePageHeader {
    static constexpr std::uint32_t expected_magic = 0x54544241; // "ABTT"
    static constexpr std::uint8_t expected_version = 1;

    std::uint32_t magic;
    std::uint8_t version;
    std::uint8_t dimension;
    std::uint16_t group;
    std::uint16_t columns;
    std::uint16_t rows;   // owners
    std::uint32_t points; // that owners share; 0 if they are vertices
};
static_assert(sizeof(AttributePageHeader) == 16);

/// Owners of a page that is read, however little they take.
inline constexpr std::size_t most_in_attribute_page = 8192;

/// A stored page, checked; read in place, and valid as long as its bytes.
template <int D, int K = 1> class AttributePage {
public:
    /// Throws Error (corrupted) unless the bytes are a page of this group with so many columns.
    void read(const unsigned char *bytes, std::size_t size, unsigned group, unsigned columns);

    std::size_t rows() const { return rows_; }
    Owner<D, K> owner(std::size_t row) const {
        if constexpr (K == 1) {
            return point(row);
        } else {
            Owner<D, K> owner;
            for (int k = 0; k < K; ++k) owner[k] = point(numbers_[k][row]);
            return owner;
        }
    }
    double value(std::size_t row, unsigned column) const {
        return from_ordered(value_rank(row, column));
    }
    /// Whether the head of a column lets a value be in a range; true where one is.
    bool may_have(unsigned column, double least, double greatest) const {
        return rows_ > 0 && column_may_have(columns_[column], least, greatest);
    }
    /// The rank of a coordinate of the owner's points, or of an attribute behind those.
    std::uint64_t rank(std::size_t row, unsigned word) const {
        if (word >= D * K) return value_rank(row, word - D * K);
        if constexpr (K == 1)
            return axes_[word][row];
        else
            return axes_[word % D][numbers_[word / D][row]];
    }
    /// Computes the keys of the owners, in the page's group. Throws unless they ascend and lie
    /// in the interval.
    void keys(const Domain<D> &domain, const Key &lower, const Key &upper, Arena<Key> &keys) const;

private:
    Point<D> point(std::size_t i) const {
        Point<D> p;
        for (int axis = 0; axis < D; ++axis) p[axis] = from_ordered(axes_[axis][i]);
        return p;
    }
    std::uint64_t value_rank(std::size_t row, unsigned column) const {
        if constexpr (K > 1)
            if (nulls_[row] >> column & 1) return ordered(null_value);
        return columns_[column][row];
    }
    void check_points(std::size_t points) const;
    void check_owners(std::size_t points, unsigned columns) const;

    std::size_t rows_ = 0;
    unsigned group_ = 0;
    std::array<Column, D> axes_;
    std::array<Column, K == 1 ? 0 : K> numbers_; // of the points of a row
    Column nulls_;                               // a bit for each attribute
    std::array<Column, AttributeGroups::widest> columns_;
};

/// Owners that a writer puts into a page. Readers hold 16 bytes for each beside the page.
inline constexpr std::size_t most_written_in_attribute_page = 1024;

/// Writes pages from rows of ranks: the coordinates of the owner's points, then the attributes of a
/// group.
class AttributePageWriter {
public:
    /// `points` name an owner.
    AttributePageWriter(const Host &host, int dimension, int points, unsigned group,
                        unsigned columns)
        : dimension_(static_cast<unsigned>(dimension)), points_(static_cast<unsigned>(points)),
          group_(group), columns_(columns), stride_(dimension_ * points_ + columns), column_(host),
          corners_(host), numbers_(host), table_(host) {}

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
    /// A point of a row: where its coordinates lie among the rows, and its place in numbers_.
    struct Corner {
        std::uint32_t offset, place;
    };

    /// Of a page, if owners share points.
    void number_points(const std::uint64_t *rows, std::size_t n);
    std::size_t points() const { return table_.size() / dimension_; }
    /// Calls visit(words, count) for each column, in the order of the page.
    template <class Visit>
    void each_column(const std::uint64_t *rows, std::size_t n, const Visit &visit);
    const std::uint64_t *gather(const std::uint64_t *words, std::size_t first, std::size_t n,
                                std::size_t stride);
    const std::uint64_t *gather_nulls(const std::uint64_t *rows, std::size_t n);
    const std::uint64_t *gather_values(const std::uint64_t *rows, unsigned attribute,
                                       std::size_t n);

    const unsigned dimension_, points_, group_, columns_, stride_;
    Arena<std::uint64_t> column_;
    Arena<Corner> corners_;
    Arena<std::uint64_t> numbers_; // of the points of all rows
    Arena<std::uint64_t> table_;   // coordinates of each point
    std::size_t size_ = 0;
    alignas(8) unsigned char bytes_[ABACUS_PAGE_BYTES + sizeof(std::uint64_t)];
};

extern template class AttributePage<2>;
extern template class AttributePage<3>;
extern template class AttributePage<2, 3>;
extern template class AttributePage<3, 4>;

} // namespace abacus
