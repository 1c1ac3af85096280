// The octant page: leaves of an octree that follow one another on the curve.
//
//   head       what is in it, the interval [lower, upper) of codes it owns, its first leaf
//   heads      of the columns (blocks/bit_column.hpp): levels of the leaves, each attribute
//   deltas     of the columns, in the same order
//   checksum   8 bytes, XXH3 of all before
//
// Leaves tile the curve: where one ends the next begins. So their places follow from the first one
// and the levels, which takes some bits a leaf. A page has the leaves that begin in its interval.
// The last one may end beyond it, and the first one may begin behind its lower end, where leaves
// have been merged across a border.
//
// Pages are ordinary column values that any writer of the table can change, so nothing in them is
// trusted: read() checks every size, level and place.
#pragma once

#include "blocks/bit_column.hpp"
#include "blocks/page_seal.hpp"
#include "host/arena.hpp"
#include "keys/key.hpp"
#include "octree/octant.hpp"

namespace abacus {

struct OctantPageHead {
    static constexpr std::uint32_t expected_magic = 0x504f4241; // "ABOP"
    static constexpr std::uint8_t expected_version = 1;

    std::uint32_t magic;
    std::uint8_t version;
    std::uint8_t dimension;
    std::uint8_t attributes;
    std::uint8_t reserved; // 0
    std::uint64_t leaves;
    std::uint64_t lower, upper, first; // codes
};
static_assert(sizeof(OctantPageHead) == 40);

/// Most leaves of a page.
inline constexpr std::uint32_t page_octants = 4096;

/// The message is that of an octree.
[[noreturn]] void throw_octree_corrupted(const std::string &detail);

/// A stored page, checked. Attributes are read in place: valid as long as its bytes.
template <int D> class OctantPageView {
public:
    /// Throws Error (corrupted) unless the bytes are a page of this dimension.
    void read(const unsigned char *bytes, std::size_t size, int attributes);

    std::uint32_t leaves() const { return static_cast<std::uint32_t>(head_.leaves); }
    std::uint64_t lower() const { return head_.lower; }
    std::uint64_t upper() const { return head_.upper; }
    /// Where the first leaf begins; the page's upper end if it has none.
    std::uint64_t first() const { return head_.first; }
    int level(std::uint32_t leaf) const { return static_cast<int>(levels_[leaf]); }
    double attribute(std::uint32_t leaf, int i) const { return from_ordered(columns_[i][leaf]); }

private:
    OctantPageHead head_;
    Column levels_;
    std::array<Column, ABACUS_MAX_PAGE_ATTRIBUTES> columns_;
};

/// Makes a page of leaves that come in the order of the curve.
template <int D> class OctantPageWriter {
public:
    OctantPageWriter(const Memory &memory, int attributes)
        : attributes_(attributes), words_(memory), plans_(memory) {}

    /// `octant(i)` and `values(i)` are those of leaf i of n. False, and no bytes(), if it does not
    /// fit; size() tells how long it would be.
    template <class OctantAt, class ValuesAt>
    bool write(std::uint64_t lower, std::uint64_t upper, std::size_t n, OctantAt octant,
               ValuesAt values) {
        words_.resize(n * static_cast<std::size_t>(1 + attributes_));
        for (std::size_t i = 0; i < n; ++i) {
            words_[i] = static_cast<std::uint64_t>(octant(i).level);
            const double *const value = attributes_ > 0 ? values(i) : nullptr;
            for (int a = 0; a < attributes_; ++a)
                words_[static_cast<std::size_t>(1 + a) * n + i] = ordered(value[a]);
        }
        return write_columns({OctantPageHead::expected_magic, OctantPageHead::expected_version, D,
                              static_cast<std::uint8_t>(attributes_), 0, n, lower, upper,
                              n > 0 ? octant(0).code : upper});
    }
    const unsigned char *bytes() const { return page_; }
    std::size_t size() const { return size_; }

private:
    bool write_columns(const OctantPageHead &head);

    int attributes_;
    Arena<std::uint64_t> words_; // column by column
    Arena<ColumnPlan> plans_;
    std::size_t size_ = 0;
    alignas(8) unsigned char page_[ABACUS_PAGE_BYTES + 8];
};

} // namespace abacus
