// The vertex page: staged points in insertion order (dissertation §4.12.2).
//
//   header    what is in it, and the sequence number of its first record
//   records   packed; each as in abacus_stage_add: id, coordinates, attributes
//
// Little-endian words. Pages are ordinary column values that any writer of the
// table can change, so the view checks sizes, counts and coordinates.
#pragma once

#include "geometry/point.hpp"
#include "host/host.hpp"

#include <cstdint>
#include <cstring>

namespace abacus {

struct VertexPageHeader {
    static constexpr std::uint32_t current_magic = 0x31565041; // "APV1": format version 1

    std::uint32_t magic;
    std::uint16_t dimension;
    std::uint16_t attributes;
    std::uint64_t count;
    std::uint64_t first;

    static constexpr std::size_t words = 3;
};
static_assert(sizeof(VertexPageHeader) == 8 * VertexPageHeader::words);

/// Words of a record of a vertex.
constexpr std::size_t record_words(unsigned dimension, unsigned attributes) {
    return 1 + dimension + attributes;
}

template <int D> Point<D> record_point(const std::uint64_t *record) {
    Point<D> point;
    std::memcpy(point.data(), record + 1, sizeof point);
    return point;
}

/// Packs records into full pages and appends them to the host's.
class VertexPageWriter {
public:
    VertexPageWriter(const Host &host, unsigned dimension, unsigned attributes,
                     std::uint64_t first);

    void add(const std::uint64_t *record) {
        std::uint64_t *to = page_ + VertexPageHeader::words + count_ * stride_;
        for (std::size_t i = 0; i < stride_; ++i) to[i] = record[i];
        if (++count_ == capacity_) flush();
    }
    /// Writes the last page.
    void finish() {
        if (count_ > 0) flush();
    }
    /// Sequence number of the next record.
    std::uint64_t next() const { return first_ + count_; }
    std::uint64_t pages() const { return pages_; }

private:
    void flush();

    const Host &host_;
    const unsigned dimension_, attributes_;
    const std::size_t stride_, capacity_;
    std::uint64_t first_;
    std::size_t count_ = 0;
    std::uint64_t pages_ = 0;
    std::uint64_t page_[ABACUS_PAGE_BYTES / 8];
};

/// A checked view of a page's bytes, which it does not own.
template <int D> class VertexPage {
public:
    /// `first` is the key under which the host found the page.
    VertexPage(const unsigned char *bytes, std::size_t size, unsigned attributes,
               std::uint64_t first);

    std::size_t size() const { return count_; }
    std::uint64_t first() const { return first_; }

    std::int64_t id(std::size_t i) const {
        std::int64_t id;
        std::memcpy(&id, at(i), sizeof id);
        return id;
    }
    Point<D> point(std::size_t i) const {
        Point<D> point;
        std::memcpy(point.data(), at(i) + 8, sizeof point);
        return point;
    }
    void attributes(std::size_t i, double *to) const {
        const std::size_t size = stride_ - 8 * (1 + D);
        if (size > 0) std::memcpy(to, at(i) + 8 * (1 + D), size);
    }

private:
    const unsigned char *at(std::size_t i) const { return records_ + i * stride_; }

    const unsigned char *records_;
    std::size_t stride_; // bytes
    std::size_t count_;
    std::uint64_t first_;
};

extern template class VertexPage<2>;
extern template class VertexPage<3>;

} // namespace abacus
