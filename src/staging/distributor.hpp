// Distributes records over spools, one for each part of a slice of the insertion order.
#pragma once

#include "points/record.hpp"
#include "sort/spool.hpp"
#include "staging/splitters.hpp"

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
        const unsigned part = splitters_.part(record_point<D>(record));
        std::uint64_t *to = buffers_.data() + (part * piece_ + waiting_[part]) * stride_;
        for (std::size_t word = 0; word < stride_; ++word) to[word] = record[word];
        if (++waiting_[part] == piece_) write(part);
        ++size_;
    }
    /// After the last record: the parts in their order.
    Arena<Part<D>> finish();

private:
    void write(unsigned part) {
        parts_[part].spool.write(host_, buffers_.data() + part * piece_ * stride_, waiting_[part],
                                 stride_);
        waiting_[part] = 0;
    }

    const Host &host_;
    const std::size_t stride_, piece_;
    const Slice<D> slice_;
    const Splitters<D> splitters_;
    std::uint64_t size_ = 0;
    Arena<Part<D>> parts_;
    Arena<std::uint64_t> buffers_; ///< a piece of each part
    Arena<std::size_t> waiting_;   ///< records in the buffer of each part
};

extern template class Distributor<2>;
extern template class Distributor<3>;

} // namespace abacus
