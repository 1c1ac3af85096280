// Tiles: where they are; their contents, compared with all triangles one by one; and adjacent tiles
// fit together. Vector tiles are read with protozero's reader, field by field.
#include "query/locate/reader.hpp"
#include "query/scan/cell_scan.hpp"
#include "query/values/barycentric.hpp"
#include "support/image.hpp"
#include "support/large_mesh.hpp"
#include "tiles/fixed_lines.hpp"
#include "tiles/picture_tile.hpp"
#include "tiles/terrain_tile.hpp"
#include "tiles/tile_lines.hpp"
#include "tiles/vector_tile.hpp"

#include <protozero/pbf_reader.hpp>

#include <functional>
#include <map>
#include <memory>
#include <numbers>

namespace abacus::test {
namespace {

constexpr abacus_tile_memory plenty{8 << 20, 8 << 20};

double height_at(const Point<2> &p) { return 800 + 700 * std::sin(3 * p[0]) * std::cos(4 * p[1]); }

/// Points in a part of the globe of `width` degrees, with heights.
std::unique_ptr<MeshOf<2>> mesh_of(int points, double width) {
    Random random(points);
    auto mesh = std::make_unique<MeshOf<2>>(1);
    std::vector<InputOf<2>> input;
    for (int i = 0; i < points; ++i) {
        const Point<2> unit = unit_point<2>(random);
        const Point<2> p{7 + width * unit[0], 46 + width * unit[1]};
        input.push_back({i, p, {height_at(p)}});
    }
    EXPECT_EQ(mesh->insert(input), ABACUS_OK);
    return mesh;
}

/// The tile that has a place.
abacus_tile tile_at(int zoom, double lon, double lat) {
    const double n = std::ldexp(1, zoom), phi = lat * std::numbers::pi / 180;
    return {zoom,
            static_cast<std::int32_t>((lon + 180) / 360 * n),
            static_cast<std::int32_t>((1 - std::asinh(std::tan(phi)) / std::numbers::pi) / 2 * n),
            1,
            {},
            0};
}
/// A place in a tile, as shares of its width and height from the upper left; by another formula
/// than the tested one.
Point<2> place_in(const abacus_tile &tile, double x, double y) {
    const double n = std::ldexp(1, tile.zoom);
    const double t = std::numbers::pi * (1 - 2 * (tile.y + y) / n);
    return {(tile.x + x) / n * 360 - 180,
            (2 * std::atan(std::exp(t)) - std::numbers::pi / 2) * 180 / std::numbers::pi};
}
Point<2> units_of(const abacus_tile &tile, const Point<2> &p) {
    const double n = std::ldexp(1, tile.zoom), phi = p[1] * std::numbers::pi / 180;
    const double y =
        (1 - std::log(std::tan(std::numbers::pi / 4 + phi / 2)) / std::numbers::pi) / 2;
    return {((p[0] + 180) / 360 * n - tile.x) * 4096, (y * n - tile.y) * 4096};
}

std::string error_of(const std::function<void()> &call) {
    try {
        call();
    } catch (const Error &error) {
        return error.what();
    }
    return "";
}

// ---- Vector tiles, read ----------------------------------------------------------------

struct ReadFeature {
    std::uint32_t type = 0;
    std::map<std::string, double> tags;
    std::map<std::string, std::string> words;
    std::vector<std::vector<TilePoint>> parts;
};
using ReadTile = std::map<std::string, std::vector<ReadFeature>>;

std::vector<std::vector<TilePoint>> parts_of(const std::vector<std::uint32_t> &commands) {
    std::vector<std::vector<TilePoint>> parts;
    TilePoint pen{0, 0};
    for (std::size_t i = 0; i < commands.size();) {
        const std::uint32_t id = commands[i] & 7, count = commands[i] >> 3;
        ++i;
        for (std::uint32_t n = 0; id != 7 && n < count; ++n, i += 2) {
            pen.x += protozero::decode_zigzag32(commands[i]);
            pen.y += protozero::decode_zigzag32(commands[i + 1]);
            if (id == 1) parts.emplace_back();
            parts.back().push_back(pen);
        }
    }
    return parts;
}

void read_layer(protozero::pbf_reader layer, ReadTile &tile) {
    std::string name;
    std::vector<std::string> keys;
    std::vector<double> values;
    std::map<std::size_t, std::string> words; // values that are texts
    std::vector<std::vector<std::uint32_t>> tags;
    std::vector<ReadFeature> features;
    while (layer.next()) switch (layer.tag()) {
        case 1:
            name = layer.get_string();
            break;
        case 3:
            keys.push_back(layer.get_string());
            break;
        case 5:
            EXPECT_EQ(layer.get_uint32(), 4096u);
            break;
        case 15:
            EXPECT_EQ(layer.get_uint32(), 2u);
            break;
        case 4: {
            protozero::pbf_reader value = layer.get_message();
            ASSERT_TRUE(value.next());
            if (value.tag() == 1) words[values.size()] = value.get_string();
            values.push_back(value.tag() == 3   ? value.get_double()
                             : value.tag() == 6 ? static_cast<double>(value.get_sint64())
                                                : NAN);
            break;
        }
        case 2: {
            protozero::pbf_reader feature = layer.get_message();
            features.emplace_back();
            tags.emplace_back();
            while (feature.next()) switch (feature.tag()) {
                case 2:
                    for (const auto n : feature.get_packed_uint32()) tags.back().push_back(n);
                    break;
                case 3:
                    features.back().type = feature.get_uint32();
                    break;
                case 4: {
                    std::vector<std::uint32_t> commands;
                    for (const auto n : feature.get_packed_uint32()) commands.push_back(n);
                    features.back().parts = parts_of(commands);
                    break;
                }
                default:
                    FAIL() << feature.tag();
                }
            break;
        }
        default:
            FAIL() << layer.tag();
        }
    for (std::size_t i = 0; i < features.size(); ++i)
        for (std::size_t n = 0; n < tags[i].size(); n += 2) {
            const std::string &key = keys.at(tags[i][n]);
            features[i].tags[key] = values.at(tags[i][n + 1]);
            if (words.count(tags[i][n + 1]) > 0) features[i].words[key] = words.at(tags[i][n + 1]);
        }
    tile[name] = features;
}

ReadTile read_vector(MeshOf<2> &mesh, const abacus_tile &tile, const abacus_tile_vector_kind &kind,
                     std::size_t *bytes = nullptr) {
    const Host host = mesh.host.host();
    const Png encoded = vector_tile(host, mesh.header, tile, kind, {}, plenty).bytes;
    if (bytes != nullptr) *bytes = encoded.size();
    ReadTile result;
    protozero::pbf_reader reader(reinterpret_cast<const char *>(encoded.data()), encoded.size());
    while (reader.next(3)) read_layer(reader.get_message(), result);
    return result;
}

/// Twice the area; positive if the ring turns clockwise with y pointing down, as outer rings do.
std::int64_t area_of(const std::vector<TilePoint> &ring) {
    std::int64_t area = 0;
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
        area += std::int64_t{ring[j].x} * ring[i].y - std::int64_t{ring[i].x} * ring[j].y;
    return area;
}

TEST(VectorTile, HasTheTrianglesAndVerticesOfItsWindow) {
    const auto mesh = mesh_of(4000, 1);
    const abacus_tile tile = tile_at(10, 7.5, 46.5);
    const ReadTile read = read_vector(*mesh, tile, {0, 100, {}});

    std::map<std::array<double, 3>, double> found;
    for (const ReadFeature &f : read.at("triangles")) {
        EXPECT_EQ(f.type, 3u);
        ASSERT_EQ(f.parts.size(), 1u);
        EXPECT_GT(area_of(f.parts[0]), 0);
        std::array<double, 3> ids{f.tags.at("v0"), f.tags.at("v1"), f.tags.at("v2")};
        std::sort(ids.begin(), ids.end());
        EXPECT_TRUE(found.emplace(ids, f.tags.at("value")).second);
    }
    // All triangles with a corner well inside are there, and none that is far outside.
    const Host host = mesh->host.host();
    CellScan<2> cells(host, mesh->header, abacus_window{}, {});
    const std::uint32_t attribute = 0;
    CornerValues values(&attribute, 1);
    abacus_simplex simplex;
    std::size_t within = 0;
    std::map<double, Point<2>> vertices;
    while (cells.next(simplex, &values)) {
        bool is_within = false, is_beyond[4] = {true, true, true, true};
        double mean = 0;
        std::array<double, 3> ids;
        for (int i = 0; i < 3; ++i) {
            const Point<2> at = units_of(tile, {simplex.corner[i][0], simplex.corner[i][1]});
            ids[i] = static_cast<double>(simplex.id[i]);
            mean += values.value(i, 0) / 3;
            const bool is_here = at[0] > -63 && at[0] < 4159 && at[1] > -63 && at[1] < 4159;
            is_within = is_within || is_here;
            if (is_here) vertices[ids[i]] = at;
            is_beyond[0] = is_beyond[0] && at[0] < -65;
            is_beyond[1] = is_beyond[1] && at[0] > 4161;
            is_beyond[2] = is_beyond[2] && at[1] < -65;
            is_beyond[3] = is_beyond[3] && at[1] > 4161;
        }
        std::sort(ids.begin(), ids.end());
        const auto place = found.find(ids);
        if (is_within) {
            ++within;
            ASSERT_NE(place, found.end());
            EXPECT_NEAR(place->second, mean, 1e-9);
        }
        if (is_beyond[0] || is_beyond[1] || is_beyond[2] || is_beyond[3]) {
            EXPECT_EQ(place, found.end());
        }
    }
    EXPECT_GT(within, 300u);
    std::size_t seen = 0;
    for (const ReadFeature &f : read.at("vertices")) {
        EXPECT_EQ(f.type, 1u);
        const auto vertex = vertices.find(f.tags.at("id"));
        if (vertex == vertices.end()) continue; // exactly at the border
        ++seen;
        EXPECT_NEAR(f.parts[0][0].x, vertex->second[0], 0.51);
        EXPECT_NEAR(f.parts[0][0].y, vertex->second[1], 0.51);
    }
    EXPECT_EQ(seen, vertices.size());
}

TEST(VectorTile, TrianglesFillTheWindow) {
    const auto mesh = mesh_of(4000, 1);
    const ReadTile read = read_vector(*mesh, tile_at(10, 7.5, 46.5), {0, 0, {}});
    double area = 0;
    for (const ReadFeature &f : read.at("triangles"))
        area += 0.5 * static_cast<double>(area_of(f.parts[0]));
    EXPECT_NEAR(area, 4224.0 * 4224.0, 4224.0 * 4224.0 * 1e-3);
    EXPECT_EQ(read.count("contours"), 0u);
    EXPECT_EQ(read.count("hull"), 0u);
}

/// Values whose differences and sums are not doubles.
TEST(VectorTile, ContoursOfTheGreatestValues) {
    MeshOf<2> mesh(1);
    std::vector<InputOf<2>> input;
    for (int i = 0; i < 4; ++i) {
        const double east = i % 2;
        input.push_back({i, {7 + east, 46.0 + i / 2}, {east == 0 ? -1.5e308 : 1.5e308}});
    }
    ASSERT_EQ(mesh.insert(input), ABACUS_OK);
    const abacus_tile tile = tile_at(8, 7.5, 46.5);
    const double middle = ((7.5 + 180) / 360 * 256 - tile.x) * 4096;
    std::size_t lines = 0;
    const ReadTile read = read_vector(mesh, tile, {0, 1e308, {}});
    for (const ReadFeature &f : read.at("contours")) {
        if (f.tags.at("value") != 0) continue;
        for (const auto &line : f.parts)
            for (const TilePoint &p : line) EXPECT_NEAR(p.x, middle, 1.01);
        ++lines;
    }
    EXPECT_EQ(lines, 1u);
}

TEST(VectorTile, RingsHaveNoCornerTwiceInSuccession) {
    // Beside a side of the tile, the corners of small triangles and the corners from cutting are
    // rounded to the same place.
    const auto mesh = mesh_of(1900, 0.1);
    std::size_t cut = 0;
    for (int zoom = 7; zoom <= 10; ++zoom) {
        const ReadTile read = read_vector(*mesh, tile_at(zoom, 7.05, 46.05), {0, 0, {}});
        for (const ReadFeature &f : read.at("triangles")) {
            const std::vector<TilePoint> &ring = f.parts.at(0);
            for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
                EXPECT_NE(ring[i], ring[j]) << zoom << " " << ring[i].x << " " << ring[i].y;
            cut += ring.size() > 3;
        }
    }
    EXPECT_GT(cut, 50u);
}

/// Where lines cross the seam between a tile and its right neighbour.
std::map<double, std::vector<int>> crossings(const ReadTile &tile, int seam) {
    std::map<double, std::vector<int>> result;
    for (const ReadFeature &f : tile.at("contours"))
        for (const auto &line : f.parts)
            for (std::size_t i = 1; i < line.size(); ++i) {
                const TilePoint a = line[i - 1], b = line[i];
                if ((a.x < seam) == (b.x < seam)) continue;
                const double y = a.y + double(b.y - a.y) * (seam - a.x) / (b.x - a.x);
                if (y > 8 && y < 4088) result[f.tags.at("value")].push_back(static_cast<int>(y));
            }
    for (auto &[value, places] : result) std::sort(places.begin(), places.end());
    return result;
}

TEST(VectorTile, ContoursGoOnInTheNextTile) {
    const auto fine = mesh_of(30000, 1);
    const auto coarse = mesh_of(3000, 1);
    for (const bool is_sampled : {false, true}) {
        MeshOf<2> &mesh = is_sampled ? *fine : *coarse;
        const abacus_tile left = tile_at(is_sampled ? 9 : 10, 7.3, 46.5);
        abacus_tile right = left;
        ++right.x;
        const abacus_tile_vector_kind kind{0, 10, {}};
        const ReadTile a = read_vector(mesh, left, kind), b = read_vector(mesh, right, kind);
        EXPECT_EQ(a.count("triangles"), is_sampled ? 0u : 1u);
        const auto leaving = crossings(a, 4096), entering = crossings(b, 0);
        ASSERT_GT(leaving.size(), 3u);
        ASSERT_EQ(leaving.size(), entering.size());
        for (const auto &[value, places] : leaving) {
            const auto &others = entering.at(value);
            ASSERT_EQ(places.size(), others.size()) << value;
            for (std::size_t i = 0; i < places.size(); ++i)
                EXPECT_NEAR(places[i], others[i], 2) << value;
        }
    }
}

TEST(VectorTile, StaysSmallWhateverTheMeshHas) {
    const auto mesh = mesh_of(30000, 1);
    for (int zoom = 0; zoom <= 14; ++zoom) {
        std::size_t bytes = 0;
        const ReadTile read =
            read_vector(*mesh, tile_at(zoom, 7.5, 46.5), {0, zoom > 12 ? 1.0 : 0.01, {}}, &bytes);
        EXPECT_LT(bytes, most_tile_bytes) << zoom;
        EXPECT_GT(bytes, 0u) << zoom;
    }
}

TEST(VectorTile, FarFromTheMeshIsEmpty) {
    const auto mesh = mesh_of(100, 1);
    std::size_t bytes = 1;
    read_vector(*mesh, tile_at(9, -100, -30), {0, 100, {}}, &bytes);
    EXPECT_EQ(bytes, 0u);
    MeshOf<2> empty(1);
    read_vector(empty, tile_at(9, -100, -30), {0, 100, {}}, &bytes);
    EXPECT_EQ(bytes, 0u);
}

TEST(VectorTile, HullClosesAroundTheMesh) {
    const auto mesh = mesh_of(20000, 1);
    const abacus_tile tile = tile_at(5, 7.5, 46.5);
    const ReadTile read = read_vector(*mesh, tile, {0, 0, {}});
    ASSERT_EQ(read.at("hull").size(), 1u);
    const auto &rings = read.at("hull")[0].parts;
    ASSERT_EQ(rings.size(), 1u);
    EXPECT_EQ(rings[0].front(), rings[0].back());
    const Point<2> lower = units_of(tile, {7, 46}), upper = units_of(tile, {8, 47});
    const double box = (upper[0] - lower[0]) * (lower[1] - upper[1]);
    EXPECT_NEAR(std::abs(0.5 * static_cast<double>(area_of(rings[0]))), box, box * 0.05);
}

// ---- Lines -----------------------------------------------------------------------------

TEST(TileLines, AreJoinedAndCut) {
    MemoryHost memory;
    const Host host = memory.host();
    TileLines lines(host);
    lines.add(1, {10, 10}, {20, 10});
    lines.add(1, {0, 0}, {10, 10});
    lines.add(1, {20, 10}, {9000, 10}); // leaves the tile
    lines.add(2, {0, 0}, {0.2, 0.3});   // nothing after rounding
    lines.add(3, {-500, 0}, {0, -500}); // outside
    VectorLayer layer(host, "lines", {"value"});
    lines.put_into(layer, [](VectorLayer &l, double level) { l.tag(0, level); });
    TileBuffer bytes(host);
    {
        TileWriter tile(bytes);
        layer.write(host, tile);
    }
    ReadTile read;
    protozero::pbf_reader reader(bytes.data(), bytes.size());
    while (reader.next(3)) read_layer(reader.get_message(), read);
    ASSERT_EQ(read.at("lines").size(), 1u);
    EXPECT_EQ(read.at("lines")[0].parts,
              (std::vector<std::vector<TilePoint>>{{{0, 0}, {10, 10}, {20, 10}, {4160, 10}}}));
}

ReadTile read_fixed(const Host &host, FixedLines &lines) {
    VectorLayer layer(host, "fixed", {"kind"});
    lines.put_into(layer);
    TileBuffer bytes(host);
    {
        TileWriter tile(bytes);
        layer.write(host, tile);
    }
    EXPECT_LE(bytes.size(), most_tile_bytes);
    ReadTile read;
    protozero::pbf_reader reader(bytes.data(), bytes.size());
    while (reader.next(3)) read_layer(reader.get_message(), read);
    return read;
}

TEST(FixedLines, AreThereOnceWithTheirKind) {
    MemoryHost memory;
    const Host host = memory.host();
    FixedLines lines(host);
    lines.add(Fixed::hard, {10, 10}, {0, 0});
    lines.add(Fixed::hard, {0, 0}, {10, 10}); // from the other side
    lines.add(Fixed::hard, {10, 10}, {9000, 10});
    lines.add(Fixed::soft, {50, 0}, {50, -9000});
    lines.add(Fixed::soft, {5, 5}, {5.2, 5.1});
    const ReadTile read = read_fixed(host, lines);
    const auto &features = read.at("fixed");
    ASSERT_EQ(features.size(), 2u);
    EXPECT_EQ(features[0].words.at("kind"), "hard");
    EXPECT_EQ(features[0].parts,
              (std::vector<std::vector<TilePoint>>{{{0, 0}, {10, 10}, {4160, 10}}}));
    EXPECT_EQ(features[1].words.at("kind"), "soft");
    EXPECT_EQ(features[1].parts, (std::vector<std::vector<TilePoint>>{{{50, -64}, {50, 0}}}));
}

TEST(FixedLines, StayFewInAnyOrder) {
    MemoryHost memory;
    const Host host = memory.host();
    Random random(7);
    std::vector<std::pair<Point<2>, Point<2>>> edges;
    for (int i = 0; i < 200000; ++i) {
        const Point<2> a = unit_point<2>(random), b = unit_point<2>(random);
        edges.push_back(
            {{a[0] * 4096, a[1] * 4096}, {a[0] * 4096 + b[0] * 40, a[1] * 4096 + b[1] * 40}});
    }
    const auto parts = [&] {
        FixedLines lines(host);
        for (const auto &[a, b] : edges) lines.add(Fixed::hard, a, b);
        return read_fixed(host, lines).at("fixed").at(0).parts;
    };
    const auto first = parts();
    std::size_t segments = 0;
    for (const auto &line : first) segments += line.size() - 1;
    EXPECT_GT(segments, 2000u);
    EXPECT_LE(segments, FixedLines::most);
    std::reverse(edges.begin(), edges.end());
    EXPECT_EQ(parts(), first);
}

// ---- Pictures --------------------------------------------------------------------------

TEST(TerrainTile, HasTheHeightsOfItsPixels) {
    for (const auto &[points, zoom] : {std::pair{3000, 10}, std::pair{30000, 7}}) {
        const auto mesh = mesh_of(points, 1);
        const abacus_tile tile = tile_at(zoom, 7.1, 46.9); // across the hull
        const Host host = mesh->host.host();
        Reader<2> reader(host, mesh->header, ample);
        const std::uint32_t attribute = 0;
        CornerValues values(&attribute, 1);
        std::uint64_t beyond;
        const Image image =
            decode(terrain_tile(host, mesh->header, tile, {64, 0, {}, -50}, plenty, beyond));
        EXPECT_EQ(beyond, 0u);
        ASSERT_EQ(image.width, 64);
        ASSERT_EQ(image.height, 64);
        int inside = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                const Point<2> place = place_in(tile, (x + 0.5) / 64, (y + 0.5) / 64);
                abacus_simplex simplex;
                double expected = -50;
                if (reader.locate(place, simplex, &values)) {
                    ++inside;
                    const auto weights = barycentric_weights<2>(simplex, place);
                    expected = 0;
                    for (int i = 0; i < 3; ++i) expected += weights[i] * values.value(i, 0);
                }
                const std::uint32_t rgb = image(x, y);
                const double height = red(rgb) * 256 + green(rgb) + blue(rgb) / 256.0 - 32768;
                EXPECT_NEAR(height, expected, 1.0 / 256) << x << ", " << y;
            }
        EXPECT_GT(inside, 100);
        EXPECT_LT(inside, 64 * 64);
    }
}

abacus_drawing coloured(std::int32_t width) {
    abacus_drawing drawing{};
    drawing.width = width;
    drawing.range[1] = 1600;
    drawing.transparent = 1;
    return drawing;
}

TEST(PictureTile, SamplesShowWhatIsAtTheCentre) {
    const auto mesh = mesh_of(40000, 1);
    const abacus_tile tile = tile_at(7, 7.1, 46.9);
    const Host host = mesh->host.host();
    const Image image =
        decode(draw_picture_tile(host, mesh->header, tile, coloured(64), plenty).png);
    Reader<2> reader(host, mesh->header, ample);
    const std::uint32_t attribute = 0;
    CornerValues values(&attribute, 1);
    const Palette palette = Palette::terrain();
    const Encoder encode;
    int inside = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const Point<2> place = place_in(tile, (x + 0.5) / 64, (y + 0.5) / 64);
            abacus_simplex simplex;
            const bool is_inside = reader.locate(place, simplex, &values);
            EXPECT_EQ(image.alphas[y * 64 + x], is_inside ? 255 : 0);
            if (!is_inside) continue;
            ++inside;
            const auto weights = barycentric_weights<2>(simplex, place);
            double value = 0;
            for (int i = 0; i < 3; ++i) value += weights[i] * values.value(i, 0);
            EXPECT_LE(difference(image(x, y), encode(palette(static_cast<float>(value / 1600)))),
                      2);
        }
    EXPECT_GT(inside, 50);
}

/// The picture of a tile is that of its four children, except for details finer than a pixel.
TEST(PictureTile, ChildrenFillTheirParent) {
    const auto mesh = mesh_of(2000, 1);
    const Host host = mesh->host.host();
    const abacus_tile tile = tile_at(9, 7.4, 46.6);
    const Image whole =
        decode(draw_picture_tile(host, mesh->header, tile, coloured(128), plenty).png);
    for (int child = 0; child < 4; ++child) {
        const abacus_tile part{
            tile.zoom + 1, 2 * tile.x + child % 2, 2 * tile.y + child / 2, 1, {}, 0};
        const Image quarter =
            decode(draw_picture_tile(host, mesh->header, part, coloured(64), plenty).png);
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x)
                EXPECT_LE(difference(quarter(x, y), whole(x + child % 2 * 64, y + child / 2 * 64)),
                          1);
    }
}

TEST(PictureTile, WithoutAttributeHasOneBrightness) {
    const auto mesh = mesh_of(2000, 1);
    const Host host = mesh->host.host();
    abacus_drawing drawing = coloured(64);
    drawing.attribute = -1;
    const abacus_tile tile = tile_at(9, 7.4, 46.6);
    drawing.width = 128;
    const Image whole = decode(draw_picture_tile(host, mesh->header, tile, drawing, plenty).png);
    drawing.width = 64;
    const abacus_tile part{tile.zoom + 1, 2 * tile.x, 2 * tile.y, 1, {}, 0};
    const Image quarter = decode(draw_picture_tile(host, mesh->header, part, drawing, plenty).png);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) EXPECT_LE(difference(quarter(x, y), whole(x, y)), 1);
}

/// Where the mesh has its mean density, the picture has the middle colour, drawn or sampled.
TEST(PictureTile, WithoutAttributeHasAMiddle) {
    const auto mesh = mesh_of(30000, 1);
    const Host host = mesh->host.host();
    const Palette palette = Palette::shore();
    const Encoder encode;
    for (const int zoom : {7, 11}) {
        abacus_drawing drawing = coloured(64);
        drawing.attribute = -1;
        const Image image = decode(
            draw_picture_tile(host, mesh->header, tile_at(zoom, 7.5, 46.5), drawing, plenty).png);
        double light = 0, pixels = 0;
        for (int i = 0; i < 64 * 64; ++i)
            if (image.alphas[i] == 255) {
                light += sum(image.pixels[i]);
                ++pixels;
            }
        ASSERT_GT(pixels, 50) << zoom;
        EXPECT_GT(light / pixels, sum(encode(palette(0.3f)))) << zoom;
        EXPECT_LT(light / pixels, sum(encode(palette(0.7f)))) << zoom;
    }
}

TEST(PictureTile, OfWebMercatorIsTheDrawingOfItsWindow) {
    MeshOf<2> mesh(1);
    std::vector<InputOf<2>> input;
    Random random(5);
    for (int i = 0; i < 500; ++i) {
        const Point<2> unit = unit_point<2>(random);
        input.push_back(
            {i, {800000 + 100000 * unit[0], 5800000 + 100000 * unit[1]}, {1600 * unit[0]}});
    }
    ASSERT_EQ(mesh.insert(input), ABACUS_OK);
    const Host host = mesh.host.host();
    const abacus_tile tile{
        9, 266, 181, 0, {-20037508.342789244, -20037508.342789244}, 2 * 20037508.342789244};
    abacus_drawing drawing = coloured(100);
    drawing.height = 100;
    const double side = 2 * 20037508.342789244 / 512;
    drawing.lower[0] = -20037508.342789244 + 266 * side;
    drawing.upper[0] = drawing.lower[0] + side;
    drawing.upper[1] = 20037508.342789244 - 181 * side;
    drawing.lower[1] = drawing.upper[1] - side;
    const Image expected = decode(draw_mesh(host, mesh.header, drawing).png);
    const Image image = decode(draw_picture_tile(host, mesh.header, tile, drawing, plenty).png);
    int seen = 0;
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 100; ++x) {
            EXPECT_LE(difference(image(x, y), expected(x, y)), 1);
            seen += image.alphas[y * 100 + x] > 0;
        }
    EXPECT_GT(seen, 1000);
}

TEST(Tile, OutOfRangeIsAnError) {
    for (const abacus_tile &tile :
         {abacus_tile{-1, 0, 0, 1, {}, 0}, abacus_tile{31, 0, 0, 1, {}, 0},
          abacus_tile{3, 8, 0, 1, {}, 0}, abacus_tile{3, 0, -1, 1, {}, 0}})
        EXPECT_NE(error_of([&] { TileWindow window(tile, {}); }), "");
    EXPECT_EQ(error_of([&] { TileWindow window({30, (1 << 30) - 1, 0, 1, {}, 0}, {}); }), "");
}

TEST(Tile, NeedsLatitudes) {
    MeshOf<2> mesh(0);
    ASSERT_EQ(mesh.insert({{1, {0, 0}, {}}, {2, {1000, 0}, {}}, {3, {0, 1000}, {}}}), ABACUS_OK);
    const Host host = mesh.host.host();
    EXPECT_EQ(error_of([&] {
                  vector_tile(host, mesh.header, {0, 0, 0, 1, {}, {}}, {-1, 0, {}}, {}, plenty);
              }),
              "the mesh is not in longitude and latitude");
}

TEST(Tile, MemoryIsGivenBack) {
    const auto mesh = mesh_of(30000, 1);
    const std::size_t before = mesh->host.bytes;
    for (const int zoom : {6, 12}) {
        read_vector(*mesh, tile_at(zoom, 7.5, 46.5), {0, 10, {}});
        const Host host = mesh->host.host();
        draw_picture_tile(host, mesh->header, tile_at(zoom, 7.5, 46.5), coloured(64), plenty);
        std::uint64_t beyond;
        terrain_tile(host, mesh->header, tile_at(zoom, 7.5, 46.5), {64, 0, {}, 0}, plenty, beyond);
    }
    EXPECT_EQ(mesh->host.bytes, before);
}

} // namespace
} // namespace abacus::test
