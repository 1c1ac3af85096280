// The vertex page: points that wait for their insertion, in its order (dissertation
// §4.12.2).
//
//   header    what is in it, and the sequence number of its first record
//   records   packed; each as in abacus_stage_add: id, coordinates, attributes
//
// Little-endian words. Pages are ordinary column values, which any writer of the table
// can change. So the view checks sizes, counts and coordinates.
#pragma once

#include "host/host.hpp"
#include "points/record.hpp"
#include "points/record_sink.hpp"

#include <abacus/facts.h>

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

/// Packs records into full pages and appends them to the host's.
class VertexPageWriter final : public RecordSink {
public:
    VertexPageWriter(const Host &host, unsigned dimension, unsigned attributes,
                     std::uint64_t first);

    void add(const std::uint64_t *record) override {
        std::uint64_t *to = page_ + VertexPageHeader::words + count_ * stride_;
        for (std::size_t i = 0; i < stride_; ++i) to[i] = record[i];
        if (++count_ == capacity_) flush();
    }
    /// Writes the last page.
    void finish() override {
        if (count_ > 0) flush();
    }
    /// Sequence number of the next record.
    std::uint64_t next() const { return first_ + count_; }

    abacus_phase phase() const override { return ABACUS_PHASE_STAGING; }
    PagesMoved pages_moved() const override { return {0, pages_}; }

private:
    void flush();

    const Host &host_;
    const unsigned dimension_, attributes_;
    const std::size_t stride_, capacity_;
    std::uint64_t first_;
    std::size_t count_ = 0;
    std::uint64_t pages_ = 0;
    std::uint64_t page_[ABACUS_MAX_PAGE_BYTES / 8];
};

/// A checked view of a page's words, which it does not own.
template <int D> class VertexPage {
public:
    /// `key` is the one under which the host found the page.
    VertexPage(const std::uint64_t *words, std::size_t size, unsigned attributes,
               const abacus_key &key);

    std::size_t size() const { return count_; }
    std::uint64_t first() const { return first_; }
    const std::uint64_t *record(std::size_t i) const { return records_ + i * stride_; }

private:
    const std::uint64_t *records_;
    std::size_t stride_; // words
    std::size_t count_;
    std::uint64_t first_;
};

/// False for infinities, NaN and -0.0, none of which is ever staged.
template <int D> bool is_canonical(const Point<D> &p) {
    constexpr std::uint64_t exponent = 0x7ffull << 52;
    for (const double x : p) {
        const auto bits = std::bit_cast<std::uint64_t>(x);
        if ((bits & exponent) == exponent || bits == 1ull << 63) return false;
    }
    return true;
}

extern template class VertexPage<2>;
extern template class VertexPage<3>;

} // namespace abacus
