#include "segments/crossings.hpp"

#include <algorithm>

namespace abacus {

Crossings::Crossings(const Host &host, std::size_t memory)
    : host_(host), share_(memory / 4), sweep_(host, memory / 2),
      ends_(host, place_words, place_words, memory / 8),
      exact_(host, place_words + pair_words, place_words, memory / 8),
      found_(host, crossing_words, pair_words, share_) {}

void Crossings::sweep() {
    is_swept_ = true;
    if (corners_) {
        corners_->each_segment([this](const LineSegment &segment) { sweep_.add(segment); });
        corners_->close();
    }
    sweep_.each([this](const LineSegment &a, const LineSegment &b) {
        find(std::min(a, b), std::max(a, b));
    });
    sweep_.close();
    leave_out_ends();
    found_.finish();
}

void Crossings::find(const LineSegment &a, const LineSegment &b) {
    const CrossingPlace at = crossing_place(a.a, a.b, b.a, b.b);
    std::uint64_t *const record = at.is_exact ? exact_.add() : found_.add();
    std::uint64_t *const pair = record + (at.is_exact ? place_words : 0);
    std::uint64_t *const place = at.is_exact ? record : record + pair_words;
    write_segment(a, pair);
    write_segment(b, pair + segment_words);
    put_ordered(place, at.place);
    if (!at.is_exact) record[pair_words + place_words] = 0;
}

void Crossings::leave_out_ends() {
    ends_.finish();
    exact_.finish();
    const std::uint64_t *end = ends_.next();
    while (const std::uint64_t *const crossing = exact_.next()) {
        const std::uint64_t *const place_end = crossing + place_words;
        while (end != nullptr &&
               std::lexicographical_compare(end, end + place_words, crossing, place_end))
            end = ends_.next();
        if (end != nullptr && std::equal(crossing, place_end, end)) continue;
        std::uint64_t *const record = found_.add();
        std::copy_n(place_end, pair_words, record);
        std::copy_n(crossing, place_words, record + pair_words);
        record[pair_words + place_words] = 1;
    }
    ends_.close();
    exact_.close();
}

bool Crossings::next(Crossing &crossing) {
    if (!is_swept_) sweep();
    const std::uint64_t *const record = found_.next();
    if (record == nullptr) return false;
    crossing.first = read_segment(record);
    crossing.second = read_segment(record + segment_words);
    const std::uint64_t *const place = record + pair_words;
    crossing.at.place = point_from_ordered<2>(place);
    crossing.at.is_exact = place[place_words] != 0;
    return true;
}

void Crossings::close() {
    if (corners_) corners_->close();
    sweep_.close();
    ends_.close();
    exact_.close();
    found_.close();
}

} // namespace abacus
