#include "tiles/fixed_lines.hpp"

#include <algorithm>

namespace abacus {

void FixedLines::add(Fixed kind, const Point<2> &a, const Point<2> &b) {
    Point<2> from = a, to = b;
    if (b < a) std::swap(from, to); // both triangles cut it alike
    if (!clip_to_tile(from, to)) return;
    const auto cell = [&](const Point<2> &p) {
        const TilePoint unit = rounded(p);
        return TilePoint{unit.x >> shift_, unit.y >> shift_};
    };
    const TilePoint first = cell(from), last = cell(to);
    if (first != last) segments_.push_back({kind, std::min(first, last), std::max(first, last)});
    if (segments_.size() < 4 * most) return;
    host_.poll();
    remove_repeated();
    while (segments_.size() > 2 * most) coarsen();
}

void FixedLines::remove_repeated() {
    std::sort(segments_.begin(), segments_.end());
    segments_.resize(static_cast<std::size_t>(std::unique(segments_.begin(), segments_.end()) -
                                              segments_.begin()));
}

void FixedLines::coarsen() {
    ++shift_;
    std::size_t kept = 0;
    for (const Segment &s : segments_) {
        const TilePoint from{s.from.x >> 1, s.from.y >> 1}, to{s.to.x >> 1, s.to.y >> 1};
        if (from != to) segments_[kept++] = {s.kind, std::min(from, to), std::max(from, to)};
    }
    segments_.resize(kept);
    remove_repeated();
}

TilePoint FixedLines::middle(TilePoint cell) const {
    const std::int32_t half = (1 << shift_) / 2;
    return {(cell.x << shift_) + half, (cell.y << shift_) + half};
}

void FixedLines::put_into(VectorLayer &layer) {
    remove_repeated();
    while (segments_.size() > most) coarsen();
    TileLines lines(host_);
    for (const Segment &s : segments_)
        lines.add_rounded(s.kind == Fixed::soft ? 1 : 0, middle(s.from), middle(s.to));
    lines.put_into(layer, [](VectorLayer &l, double level) {
        l.tag_word(0, level > 0, level > 0 ? "soft" : "hard");
    });
}

} // namespace abacus
