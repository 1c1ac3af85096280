// Distributes records over spools, one for each part of a slice of the insertion order.
#pragma once

#include "points/record.hpp"
#include "sort/spool.hpp"
#include "staging/splitters.hpp"

#include <utility>

namespace abacus {

/// What is left of a slice to be sorted by itself.
template <int D> struct Part {
    Spool spool;
    Slice<D> slice;
    unsigned round; ///< of the slice that was cut
};

template <int D> class Distributor {
public:
    /// `piece`: records of a part that are written at once; the memory is one piece a part.
    Distributor(const Host &host, std::size_t stride, std::size_t piece, const Slice<D> &slice,
                const Sample<D> &sample, unsigned parts, bool more_rounds = false);

    const Slice<D> &slice() const { return slice_; }
    /// Records so far.
    std::uint64_t size() const { return size_; }

    void add(const std::uint64_t *record) {
        const unsigned part = part_of(record);
        if (put(part, record)) write(part, exchange(part, piece(part)));
    }
    /// After the last record: the parts in their order.
    Arena<Part<D>> finish();

    // What add() does, for threads (distributor_threads.hpp):

    /// The part of a record; for any thread.
    unsigned part_of(const std::uint64_t *record) const {
        return splitters_.part(record_point<D>(record));
    }
    /// Copies a record to the piece of its part. True if that is full now; it must be exchanged
    /// before the next record comes.
    bool put(unsigned part, const std::uint64_t *record) {
        std::uint64_t *to = piece(part) + waiting_[part] * stride_;
        for (std::size_t word = 0; word < stride_; ++word) to[word] = record[word];
        ++size_;
        return ++waiting_[part] == piece_;
    }
    std::uint64_t *piece(unsigned part) const { return buffer_[part]; }
    /// Gives a part an empty piece, and returns the one that it had.
    std::uint64_t *exchange(unsigned part, std::uint64_t *empty) {
        waiting_[part] = 0;
        return std::exchange(buffer_[part], empty);
    }
    /// Writes a full piece; for the session's thread.
    void write(unsigned part, const std::uint64_t *full) { write(part, full, piece_); }

private:
    void write(unsigned part, const std::uint64_t *records, std::size_t n) {
        parts_[part].spool.write(host_, records, n, stride_);
    }

    const Host &host_;
    const std::size_t stride_, piece_;
    const Slice<D> slice_;
    const Splitters<D> splitters_;
    std::uint64_t size_ = 0;
    Arena<Part<D>> parts_;
    Arena<std::uint64_t> buffers_;  ///< a piece of each part
    Arena<std::uint64_t *> buffer_; ///< that of each part
    Arena<std::size_t> waiting_;    ///< records in it
};

extern template class Distributor<2>;
extern template class Distributor<3>;

} // namespace abacus
