// All pairs of segments that cross, by a sweep over segments sorted by their left ends, as many as
// there are. Exact.
//
// The sweep takes fresh segments in batches, and holds those that reach beyond the batch: those
// that are still met by later ones. Both lists are sorted by their low ends. So pairs that overlap
// in y are found by one run over two lists, and then overlap in x and cross, or do not. A batch is
// about as large as what is held, so each fresh segment pays for few held ones.
//
//   1  Every segment is fresh once in the first run. There it is compared with all that are held,
//      and with the others of its batch.
//   2  Held segments begin no later than fresh ones. A held one that ends before the next fresh one
//      begins is dropped: it meets none of those that come.
//   3  If there is no room for all that should be held, the rest is left, with the number of fresh
//      segments that have passed. The sorted segments then pass once more. In this run a left
//      segment is held from that number on, and fresh ones are compared with held ones only. What
//      again finds no room is left for the next run.
//
// By 1 and 3 each pair is compared once: when the one that comes later passes as a fresh one while
// the other is held, in whichever run, or when both are in one batch. In a later run the first
// segments left find room, so runs come to an end. Memory does not grow with what is held; the
// number of runs does.
#pragma once

#include "geometry/ordered.hpp"
#include "segments/line_segment.hpp"
#include "sort/record_sort.hpp"
#include "sort/record_spool.hpp"

#include <functional>
#include <optional>

namespace abacus {

class SegmentSweep {
public:
    /// Segments are sorted in half of the memory, and held in the other half.
    SegmentSweep(const Host &host, std::size_t memory);

    /// Of finite coordinates.
    void add(const LineSegment &segment);

    using Report = std::function<void(const LineSegment &, const LineSegment &)>;
    /// No more segments come: reports each pair that crosses, once, in no order and either way
    /// round.
    void each(const Report &report);
    void close();

private:
    struct Item {
        double left, right, low, high;
        LineSegment segment;
    };
    // The left end, then the segment.
    static constexpr std::size_t words = 1 + segment_words;

    static Item item_of(const LineSegment &segment);
    void advance();
    /// A run over all segments; in those after the first, `left` are the segments to be held.
    void run(RecordSpool *left, const Report &report);
    void read_left(RecordSpool &left);
    /// Holds what was left up to here, as far as there is room.
    void hold_left(RecordSpool &left);
    void leave(const Item &item);
    /// Drops held segments that end, and holds fresh ones.
    void hold_fresh();
    void drop_ended();
    /// The next fresh segments.
    void take_batch();
    static void compare(const Item &a, const Item &b, const Report &report);
    void compare_held(const Report &report) const;
    void compare_fresh(const Report &report) const;

    const Host &host_;
    const std::size_t room_; // for segments held
    RecordSort sorted_;
    std::optional<Item> next_; // the next fresh segment
    std::uint64_t passed_ = 0; // segments that have been fresh in this run
    Arena<Item> held_, fresh_, kept_;
    std::optional<RecordSpool> spools_[2]; // of what is left, by turns
    RecordSpool *leaving_ = nullptr;       // ... in this run
    std::uint64_t left_ = 0;               // how many
    std::optional<LineSegment> waits_;     // the next of those left before
    std::uint64_t since_ = 0;              // its number
};

} // namespace abacus
