// The pairs of segments that cross, in the order of their lines and positions: a function of the
// segments alone, whatever their order and the memory.
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
    void add(const LineSegment &segment) { sweep_.add(segment); }
    /// A corner of a line that comes in corners.
    void add_corner(std::int64_t line, std::int64_t position, const Point<2> &place) {
        if (!corners_) corners_.emplace(host_, share_);
        corners_->add(line, position, place);
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
    void sweep();

    const Host &host_;
    const std::size_t share_; // of the memory
    std::optional<LineCorners> corners_;
    SegmentSweep sweep_;
    RecordSort found_; // pairs of segments
    bool is_swept_ = false;
};

} // namespace abacus
