#include "tiles/tile_lines.hpp"

namespace abacus {

bool clip_to_tile(Point<2> &a, Point<2> &b) {
    const Box<2> box = buffered_tile();
    double begin = 0, end = 1;
    for (int axis = 0; axis < 2; ++axis) {
        const double length = b[axis] - a[axis];
        if (length == 0) {
            if (a[axis] < box.lower[axis] || a[axis] > box.upper[axis]) return false;
            continue;
        }
        const double enters = ((length > 0 ? box.lower : box.upper)[axis] - a[axis]) / length;
        const double leaves = ((length > 0 ? box.upper : box.lower)[axis] - a[axis]) / length;
        begin = std::fmax(begin, enters);
        end = std::fmin(end, leaves);
    }
    if (!(begin < end)) return false;
    const Point<2> from = a, to = b;
    for (int axis = 0; axis < 2; ++axis) {
        const auto within = [&](double share) { // even if the ends are very far away
            return std::clamp(std::lerp(from[axis], to[axis], share), box.lower[axis],
                              box.upper[axis]);
        };
        if (begin > 0) a[axis] = within(begin);
        if (end < 1) b[axis] = within(end);
    }
    return true;
}

void TileLines::add(double level, const Point<2> &a, const Point<2> &b) {
    Point<2> from = a, to = b;
    if (clip_to_tile(from, to)) add_rounded(level, rounded(from), rounded(to));
}

TileLines::Segment *TileLines::next(const End &end) {
    const auto key = key_of(end);
    Segment *segment = std::lower_bound(
        segments_.begin(), segments_.end(), key,
        [](const Segment &segment, const auto &sought) { return key_of(segment) < sought; });
    while (segment != segments_.end() && key_of(*segment) == key && segment->is_used) ++segment;
    return segment != segments_.end() && key_of(*segment) == key ? segment : nullptr;
}

void TileLines::put_line(VectorLayer &layer, Segment *segment) {
    line_.clear();
    line_.push_back(segment->from);
    for (; segment != nullptr; segment = next({segment->level, segment->to})) {
        segment->is_used = true;
        line_.push_back(segment->to);
    }
    layer.add_line({line_.data(), line_.size()});
}

void TileLines::put_into(VectorLayer &layer, const Tag &tag) {
    const auto by_key = [](const auto &a, const auto &b) { return key_of(a) < key_of(b); };
    std::sort(segments_.begin(), segments_.end(), by_key);
    ends_.clear();
    for (const Segment &segment : segments_) ends_.push_back({segment.level, segment.to});
    std::sort(ends_.begin(), ends_.end(), by_key);
    for (Segment *level = segments_.begin(); level != segments_.end();) {
        Segment *const end = std::find_if(level, segments_.end(), [&](const Segment &segment) {
            return segment.level != level->level;
        });
        layer.begin_lines();
        if (tag) tag(layer, level->level);
        // Open lines first, then closed ones.
        for (const bool is_closed : {false, true})
            for (Segment *segment = level; segment != end; ++segment) {
                host_.poll();
                if (segment->is_used) continue;
                const End begin{segment->level, segment->from};
                if (!is_closed && std::binary_search(ends_.begin(), ends_.end(), begin, by_key))
                    continue;
                put_line(layer, segment);
            }
        level = end;
    }
}

} // namespace abacus
