// Lines of a tile: segments that are cut at its buffer, rounded, and joined end to end.
//
// Each segment has a direction, and segments of one line follow one another. So joining them is
// looking for the one that begins where another ends. Where rounding brings several together any
// will do.
#pragma once

#include "geometry/box.hpp"
#include "tiles/vector_layer.hpp"

#include <cmath>
#include <functional>

namespace abacus {

/// What is kept around a tile, so that strokes at its border are whole.
inline constexpr std::int32_t tile_buffer = 64;

inline Box<2> buffered_tile() {
    return {{-tile_buffer, -tile_buffer}, {tile_extent + tile_buffer, tile_extent + tile_buffer}};
}

/// Of a point within the buffer.
inline TilePoint rounded(const Point<2> &p) {
    return {static_cast<std::int32_t>(std::floor(p[0] + 0.5)),
            static_cast<std::int32_t>(std::floor(p[1] + 0.5))};
}

/// The part of a segment within the buffered tile; false if there is none.
bool clip_to_tile(Point<2> &a, Point<2> &b);

class TileLines {
public:
    /// Tags a feature with its level.
    using Tag = std::function<void(VectorLayer &layer, double level)>;

    explicit TileLines(const Host &host) : host_(host), segments_(host), ends_(host), line_(host) {}

    /// A segment from a to b of the line, or the lines, of a level.
    void add(double level, const Point<2> &a, const Point<2> &b);
    void add_rounded(double level, TilePoint a, TilePoint b) {
        if (a != b) segments_.push_back({level, a, b, false});
    }
    void clear() { segments_.clear(); }
    /// A feature for each level, tagged with it unless `tag` is null.
    void put_into(VectorLayer &layer, const Tag &tag);

private:
    struct Segment {
        double level;
        TilePoint from, to;
        bool is_used;
    };
    struct End {
        double level;
        TilePoint at;
    };

    template <class T> static auto key_of(const T &t) {
        if constexpr (std::is_same_v<T, Segment>)
            return std::tuple(t.level, t.from);
        else
            return std::tuple(t.level, t.at);
    }
    /// An unused segment that begins there; null if there is none.
    Segment *next(const End &end);
    void put_line(VectorLayer &layer, Segment *first);

    const Host &host_;
    Arena<Segment> segments_;
    Arena<End> ends_;
    Arena<TilePoint> line_;
};

} // namespace abacus
