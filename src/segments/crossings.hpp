// The pairs of segments that cross, in the order of their lines and positions: a function of the
// segments alone, whatever their order and the memory.
//
// A crossing that is exactly at an end of some segment is left out: all ends become vertices, and
// there both segments are split. So the places of all crossings are computed, and those that are
// exact are sorted by place and compared with all ends.
#pragma once

#include "geometry/crossing.hpp"
#include "segments/line_corners.hpp"
#include "segments/segment_sweep.hpp"

#include <optional>

namespace abacus {

class Crossings {
public:
    Crossings(const Host &host, std::size_t memory);

    /// Of finite coordinates.
    void add(const LineSegment &segment) {
        add_end(segment.a);
        add_end(segment.b);
        sweep_.add(segment);
    }
    /// A corner of a line that comes in corners.
    void add_corner(std::int64_t line, std::int64_t position, const Point<2> &place,
                    std::int64_t part) {
        add_end(place);
        if (!corners_) corners_.emplace(host_, share_);
        corners_->add(line, position, place, part);
    }

    /// Ends adding; may be called again.
    std::uint64_t count() {
        if (!is_swept_) sweep();
        return found_.size();
    }
    struct Crossing {
        LineSegment first, second; // the lesser one first
        CrossingPlace at;
    };
    /// The next one, once; false after the last.
    bool next(Crossing &crossing);
    void close();

private:
    // A pair of segments, its place, and whether that is exact.
    static constexpr std::size_t pair_words = 2 * segment_words, crossing_words = pair_words + 3;
    static constexpr std::size_t place_words = 2;

    void add_end(const Point<2> &place) { put_ordered(ends_.add(), place); }
    void sweep();
    void find(const LineSegment &a, const LineSegment &b);
    /// Finds those of exact_ that are at no end.
    void leave_out_ends();

    const Host &host_;
    const std::size_t share_; // of the memory
    std::optional<LineCorners> corners_;
    SegmentSweep sweep_;
    RecordSort ends_, exact_; // by place
    RecordSort found_;
    bool is_swept_ = false;
};

} // namespace abacus
