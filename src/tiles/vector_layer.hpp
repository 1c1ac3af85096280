// A layer of a vector tile: features of whole coordinates with tags, as version 2 of the Mapbox
// Vector Tile specification has them. x grows to the right and y downwards, from 0 to extent;
// coordinates beyond are in the tile's buffer.
//
// Values are numbers of a table of the layer, each in it once. The table is made at the end: all
// values, sorted.
#pragma once

#include "tiles/tile_buffer.hpp"

#include <array>
#include <bit>
#include <initializer_list>
#include <span>
#include <tuple>

namespace abacus {

inline constexpr std::int32_t tile_extent = 4096;

struct TilePoint {
    std::int32_t x, y;
    bool operator==(const TilePoint &) const = default;
    bool operator<(const TilePoint &p) const { return std::tie(x, y) < std::tie(p.x, p.y); }
};

class VectorLayer {
public:
    /// `keys` of the tags, and `name`, live as long as the layer.
    VectorLayer(const Host &host, const char *name, std::initializer_list<const char *> keys)
        : name_(name), features_(host), geometry_(host), tags_(host) {
        for (const char *key : keys) add_key(key);
    }

    /// Another key, before any feature has begun.
    void add_key(const char *key) { keys_[key_count_++] = key; }

    void begin_point(TilePoint p);
    /// A polygon, its corners clockwise as seen.
    void begin_polygon(std::span<const TilePoint> corners);
    void begin_lines();
    /// Another line of the feature.
    void add_line(std::span<const TilePoint> points);

    // Tags of the feature begun last.
    /// An id, which is also tagged as text, by the key with _text behind it, if browsers, whose
    /// numbers are doubles, cannot tell it from others.
    void tag_id(std::uint32_t key, std::int64_t id) {
        tag(key, ValueKind::integer, std::bit_cast<std::uint64_t>(id));
        if (id >= -greatest_id && id <= greatest_id) return;
        tag(key + static_cast<std::uint32_t>(key_count_), ValueKind::text,
            std::bit_cast<std::uint64_t>(id));
        has_texts_ = true;
    }
    /// A word by its number: one word has one number. It lives as long as the layer.
    void tag_word(std::uint32_t key, std::uint64_t number, const char *word) {
        tags_.push_back({key, {ValueKind::word, number, word}});
    }
    /// None if it is NaN.
    void tag(std::uint32_t key, double value) {
        if (value == value) tag(key, ValueKind::number, std::bit_cast<std::uint64_t>(value + 0.0));
    }

    bool empty() const { return features_.empty(); }
    /// Adds the layer to a tile, unless it has no feature.
    void write(const Host &host, TileWriter &tile);

private:
    static constexpr std::size_t most_keys = 5;
    static constexpr std::int64_t greatest_id = (std::int64_t{1} << 53) - 1;

    enum class Kind : std::uint32_t { point = 1, lines = 2, polygon = 3 };
    struct Feature {
        Kind kind;
        std::uint32_t geometry, tags; // where they begin
    };
    enum class ValueKind : std::uint8_t { number, integer, text, word };
    struct Value {
        ValueKind kind;
        std::uint64_t bits; // of a text, of the integer that it says; of a word, its number
        const char *word = nullptr;
        bool operator==(const Value &v) const { return kind == v.kind && bits == v.bits; }
        bool operator<(const Value &v) const {
            return std::tie(kind, bits) < std::tie(v.kind, v.bits);
        }
    };
    struct Tag {
        std::uint32_t key;
        Value value;
    };

    void begin(Kind kind);
    void tag(std::uint32_t key, ValueKind kind, std::uint64_t bits) {
        tags_.push_back({key, {kind, bits}});
    }
    /// From where the pen is, there.
    void go(TilePoint p);
    void write_feature(TileWriter &layer, std::size_t i, std::span<const Value> values) const;

    const char *const name_;
    std::array<const char *, most_keys> keys_{};
    std::size_t key_count_ = 0;
    bool has_texts_ = false;
    Arena<Feature> features_;
    Arena<std::uint32_t> geometry_;
    Arena<Tag> tags_;
    TilePoint pen_{};
};

} // namespace abacus
