#include "tiles/vector_layer.hpp"

#include <string>

namespace abacus {

namespace {

// Numbers of fields: of a tile, a layer, a feature, a value.
enum : protozero::pbf_tag_type {
    tile_layer = 3,
    layer_name = 1,
    layer_feature = 2,
    layer_key = 3,
    layer_value = 4,
    layer_extent = 5,
    layer_version = 15,
    feature_tags = 2,
    feature_type = 3,
    feature_geometry = 4,
    value_string = 1,
    value_double = 3,
    value_integer = 6 // sint64
};

// Commands of a geometry; the bits above are the number of repetitions.
constexpr std::uint32_t move_to = 1, line_to = 2, close_path = 7;

constexpr std::uint32_t command(std::uint32_t id, std::size_t count) {
    return id | static_cast<std::uint32_t>(count << 3);
}

} // namespace

void VectorLayer::begin(Kind kind) {
    features_.push_back({kind, static_cast<std::uint32_t>(geometry_.size()),
                         static_cast<std::uint32_t>(tags_.size())});
    pen_ = {0, 0};
}

void VectorLayer::go(TilePoint p) {
    geometry_.push_back(protozero::encode_zigzag32(p.x - pen_.x));
    geometry_.push_back(protozero::encode_zigzag32(p.y - pen_.y));
    pen_ = p;
}

void VectorLayer::begin_point(TilePoint p) {
    begin(Kind::point);
    geometry_.push_back(command(move_to, 1));
    go(p);
}

void VectorLayer::begin_polygon(std::span<const TilePoint> corners) {
    begin(Kind::polygon);
    add_line(corners);
    geometry_.push_back(command(close_path, 1));
}

void VectorLayer::begin_lines() { begin(Kind::lines); }

void VectorLayer::add_line(std::span<const TilePoint> points) {
    geometry_.push_back(command(move_to, 1));
    go(points[0]);
    geometry_.push_back(command(line_to, points.size() - 1));
    for (const TilePoint p : points.subspan(1)) go(p);
}

void VectorLayer::write(const Host &host, TileWriter &tile) {
    if (empty()) return;
    Arena<Value> values(host);
    values.reserve(tags_.size());
    for (const Tag &tag : tags_) values.push_back(tag.value);
    std::sort(values.begin(), values.end());
    values.resize(
        static_cast<std::size_t>(std::unique(values.begin(), values.end()) - values.begin()));
    TileWriter layer(tile, tile_layer);
    layer.add_uint32(layer_version, 2);
    layer.add_string(layer_name, name_);
    for (std::size_t i = 0; i < features_.size(); ++i) {
        host.poll();
        write_feature(layer, i, {values.data(), values.size()});
    }
    for (std::size_t i = 0; i < key_count_; ++i) layer.add_string(layer_key, keys_[i]);
    for (std::size_t i = 0; has_texts_ && i < key_count_; ++i)
        layer.add_string(layer_key, std::string(keys_[i]) + "_text");
    for (const Value &value : values) {
        TileWriter writer(layer, layer_value);
        const auto integer = std::bit_cast<std::int64_t>(value.bits);
        switch (value.kind) {
        case ValueKind::number:
            writer.add_double(value_double, std::bit_cast<double>(value.bits));
            break;
        case ValueKind::integer:
            writer.add_sint64(value_integer, integer);
            break;
        case ValueKind::text:
            writer.add_string(value_string, std::to_string(integer));
            break;
        case ValueKind::word:
            writer.add_string(value_string, value.word);
            break;
        }
    }
    layer.add_uint32(layer_extent, tile_extent);
}

void VectorLayer::write_feature(TileWriter &layer, std::size_t i,
                                std::span<const Value> values) const {
    const bool is_last = i + 1 == features_.size();
    const std::size_t tags_end = is_last ? tags_.size() : features_[i + 1].tags;
    const std::size_t geometry_end = is_last ? geometry_.size() : features_[i + 1].geometry;
    TileWriter feature(layer, layer_feature);
    std::array<std::uint32_t, 2 * 2 * most_keys> numbers;
    auto number = numbers.begin();
    for (std::size_t n = features_[i].tags; n < tags_end; ++n) {
        *number++ = tags_[n].key;
        *number++ = static_cast<std::uint32_t>(
            std::lower_bound(values.begin(), values.end(), tags_[n].value) - values.begin());
    }
    feature.add_packed_uint32(feature_tags, numbers.begin(), number);
    feature.add_enum(feature_type, static_cast<std::int32_t>(features_[i].kind));
    feature.add_packed_uint32(feature_geometry, geometry_.begin() + features_[i].geometry,
                              geometry_.begin() + geometry_end);
}

} // namespace abacus
