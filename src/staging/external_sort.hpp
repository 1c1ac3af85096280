// Brings any number of records into insertion order within a bound of memory.
//
// A slice of the order that fits in memory is sorted there (curve_sort.hpp) and goes to
// the sink. A larger slice is cut into parts (splitters.hpp) and distributed over
// spools, one for each part. The parts are then treated in their order in the same way.
// Points that share one code are cut by the codes of their bounding box. If that is a
// single point they are in order already.
//
// With several threads some parts are read at once, and each is sorted by a thread. Threads also
// bring the records together in their order, and find their codes, if the sink takes codes.
#pragma once

#include "points/record_sink.hpp"
#include "staging/curve_sort.hpp"
#include "staging/distributor.hpp"

namespace abacus {

/// How a bound of memory is divided.
struct SortBudget {
    /// Taken at least: room for a few spools and a few hundred records.
    static constexpr std::size_t least = std::size_t{512} << 10;

    SortBudget(std::size_t memory, std::size_t record_bytes, std::size_t dimension);

    std::size_t records; ///< held and sorted at once
    std::size_t sampled; ///< points of a sample
    unsigned spools;     ///< written at once
    std::size_t piece;   ///< records that are read or written at once

    /// The number of parts while it is unknown how many records will come.
    unsigned parts(unsigned rounds) const {
        return std::max(3u, spools - std::min(spools, rounds));
    }
};

template <int D> class ExternalSort {
public:
    ExternalSort(const Host &host, std::size_t stride, const SortBudget &budget, Sample<D> &sample,
                 Pacer &pacer, RecordSink &sink);

    /// Sorts n records in memory, at most budget.records.
    void run(const std::uint64_t *records, std::size_t n, const Slice<D> &slice);
    /// Sorts spools, of which `sample` is a sample, and closes them.
    void run(Arena<Spool> &spools, const Slice<D> &slice);
    /// Sorts parts that come one after the other, and closes their spools.
    void run(Arena<Part<D>> &parts);

private:
    void sort_spool(Spool &spool, const Slice<D> &slice);
    Arena<Part<D>> cut(Spool *spools, std::size_t n, const Slice<D> &slice, bool report);
    unsigned parts_for(std::uint64_t records, const Slice<D> &slice) const;
    void sort_parts(Arena<Part<D>> &parts);
    std::size_t parts_at_once(const Arena<Part<D>> &parts, std::size_t first) const;
    void sort_together(Part<D> *parts, std::size_t n);
    void read(Spool &spool, std::uint64_t *to);
    Box<D> survey(Spool &spool);
    void emit(const std::uint64_t *records, const std::uint64_t *order, std::size_t n);
    void gather(const std::uint64_t *records, const std::uint64_t *order, std::size_t n,
                std::uint64_t *to) const;
    void emit_by_threads(const std::uint64_t *records, const std::uint64_t *order, std::size_t n);
    void emit_as_is(Spool &spool);
    void handed_on(std::size_t n) {
        done_ += n;
        pacer_.reached(done_ - sink_.held_back(), sink_.pages_moved());
    }
    void close(Spool &spool);

    const Host &host_;
    const std::size_t stride_;
    const SortBudget &budget_;
    Sample<D> &sample_;
    Pacer &pacer_;
    RecordSink &sink_;
    std::uint64_t done_ = 0; ///< records that the sink has got
    CurveSort<D> sort_;
    Arena<std::uint64_t> records_;
    Arena<std::uint64_t> gathered_; ///< the next ones in order
    unsigned open_spools_ = 0;
};

extern template class ExternalSort<2>;
extern template class ExternalSort<3>;

} // namespace abacus
