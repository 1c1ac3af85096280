// Insertion order of records in memory: by round, then along the Hilbert curve.
//
// Each record is sorted by one word: a piece of its code above its number. The first 33
// bits of the order separate nearly all points. The few that share them get the next
// bits in the same words. Points that share a whole code get codes of their own
// bounding box, again and again, until the box is a single point. So clusters far below
// the resolution of the codes are also in the order of the curve, and equal points end
// up adjacent, in the order of their numbers.
//
// Many records are sorted by several threads (shared_sort.hpp), or runs of them, each by one.
#pragma once

#include "host/arena.hpp"
#include "points/record.hpp"
#include "sort/pacer.hpp"
#include "sort/shared_sort.hpp"
#include "staging/slice.hpp"

namespace abacus {

template <int D> class CurveSort {
public:
    CurveSort(const Host &host, std::size_t stride)
        : stride_(stride), memory_(host), shared_(host) {}

    /// Sorts n records of `stride` words (at most most_sorted_records), all of them in the slice.
    /// Their numbers in order are in the index_mask bits of the result, which is valid until the
    /// next call.
    const std::uint64_t *sort(const std::uint64_t *records, std::size_t n, const Slice<D> &slice,
                              Pacer &pacer);
    /// Records [begin, end), which are in this slice.
    struct Run {
        std::size_t begin, end;
        Slice<D> slice;
    };
    /// The same for runs that follow one another; each gets the words at its place.
    const std::uint64_t *sort_each(const std::uint64_t *records, const Arena<Run> &runs,
                                   Pacer &pacer);
    /// Words that nobody uses until the next call: as many as records were sorted.
    std::uint64_t *free_words() { return scratch_; }
    /// Calls piece(begin, end) for pieces of n records, in several threads.
    template <class Piece> void each_piece(std::size_t n, Piece piece) {
        const std::size_t pieces = (n + Pacer::stride - 1) / Pacer::stride;
        shared_.each(pieces, [&](std::size_t i, const Host &) {
            piece(i * Pacer::stride, std::min(n, (i + 1) * Pacer::stride));
        });
    }
    /// Whether several threads would sort so many records.
    bool is_shared(std::size_t n) const { return shared_.is_worth_while(n); }
    void release() { memory_.reset(); }

private:
    void begin(const std::uint64_t *records, std::size_t n, const Pacer &pacer);
    /// Sets words [begin, end) at `to`.
    void set_words(std::uint64_t *to, std::size_t begin, std::size_t end,
                   const Slice<D> &slice) const;
    void sort_run(const Run &run, const Pacer &pacer);
    void refine_ties(std::size_t begin, std::size_t end, const Slice<D> &slice, const Pacer &pacer);
    Point<D> point(std::uint64_t word) const {
        return record_point<D>(records_ + (word & index_mask) * stride_);
    }
    template <class Key> void set_keys(std::size_t begin, std::size_t end, Key key);
    void sort_words(std::size_t begin, std::size_t end, const Pacer &pacer);
    template <class Each> void each_tie(std::size_t begin, std::size_t end, Each each);
    void refine(std::size_t begin, std::size_t end, const Slice<D> &slice, const Pacer &pacer);
    void zoom(std::size_t begin, std::size_t end, const Pacer &pacer);

    const std::size_t stride_;
    const std::uint64_t *records_ = nullptr;
    Arena<std::uint64_t> memory_;
    std::uint64_t *words_ = nullptr, *scratch_ = nullptr; ///< its halves
    SharedSort shared_;
};

extern template class CurveSort<2>;
extern template class CurveSort<3>;

} // namespace abacus
