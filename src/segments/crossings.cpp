#include "segments/crossings.hpp"

#include <algorithm>

namespace abacus {

Crossings::Crossings(const Host &host, std::size_t memory)
    : host_(host), share_(memory / 4), sweep_(host, memory / 2),
      found_(host, 2 * segment_words, 2 * segment_words, share_) {}

void Crossings::sweep() {
    is_swept_ = true;
    if (corners_) {
        corners_->each_segment([this](const LineSegment &segment) { add(segment); });
        corners_->close();
    }
    sweep_.each([this](const LineSegment &a, const LineSegment &b) {
        std::uint64_t *const record = found_.add();
        write_segment(std::min(a, b), record);
        write_segment(std::max(a, b), record + segment_words);
    });
    sweep_.close();
    found_.finish();
}

bool Crossings::next(Crossing &crossing) {
    if (!is_swept_) sweep();
    const std::uint64_t *const record = found_.next();
    if (record == nullptr) return false;
    crossing.first = read_segment(record);
    crossing.second = read_segment(record + segment_words);
    crossing.at =
        crossing_place(crossing.first.a, crossing.first.b, crossing.second.a, crossing.second.b);
    return true;
}

void Crossings::close() {
    if (corners_) corners_->close();
    sweep_.close();
    found_.close();
}

} // namespace abacus
