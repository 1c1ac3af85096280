#include "segments/line_corners.hpp"

#include <optional>
#include <string>

namespace abacus {

void LineCorners::each_segment(const std::function<void(const LineSegment &)> &visit) {
    corners_.finish();
    std::optional<LineSegment> last; // from the last corner on
    std::uint64_t last_part = 0;
    while (const std::uint64_t *const record = corners_.next()) {
        LineSegment next{from_ordered_integer(record[0]), from_ordered_integer(record[1]), {}, {}};
        for (int i = 0; i < 2; ++i) next.a[i] = std::bit_cast<double>(record[2 + i]);
        if (last && last->line == next.line) {
            if (last->position == next.position)
                throw Error(ABACUS_ERROR_ARGUMENT,
                            "line " + std::to_string(next.line) + " has position " +
                                std::to_string(next.position) + " twice",
                            {}, "Number the corners of a line in their order.");
            last->b = next.a;
            if (last_part == record[4]) visit(*last);
        }
        last = next;
        last_part = record[4];
    }
}

} // namespace abacus
