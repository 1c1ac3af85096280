#include "tiles/glb.hpp"

#include "tiles/little_endian.hpp"
#include "tiles/welded_surface.hpp"

#include <charconv>
#include <string>

namespace abacus {

namespace {

std::string written(double value) {
    std::array<char, 32> text;
    return {text.data(), std::to_chars(text.begin(), text.end(), value).ptr};
}

template <class Numbers> std::string list_of(const Numbers &numbers) {
    std::string list(1, '[');
    for (const double number : numbers) {
        if (list.size() > 1) list.push_back(',');
        list.append(written(number));
    }
    return list + "]";
}

class GlbWriter {
public:
    GlbWriter(const Host &host, const Box<2> &box, const TileFrame &frame)
        : host_(host), frame_(frame), middle_{box.lower[0] / 2 + box.upper[0] / 2,
                                              box.lower[1] / 2 + box.upper[1] / 2},
          axes_(frame.axes(middle_)), bytes_(host) {}

    Png make(const Arena<SurfaceCorner> &corners);

private:
    Point<3> turned(const Point<3> &v) const {
        return {dot(axes_[0], v), dot(axes_[1], v), dot(axes_[2], v)};
    }
    std::string description(const WeldedSurface &surface) const;
    void write(const WeldedSurface &surface);

    const Host &host_;
    const TileFrame &frame_;
    const Point<2> middle_;
    const std::array<Point<3>, 3> axes_;
    double height_ = 0; // of the centre: a whole number in the middle of the heights
    LittleEndian bytes_;
};

/// The least multiple of 4 that is no less.
std::size_t padded(std::size_t size) { return (size + 3) / 4 * 4; }

std::string GlbWriter::description(const WeldedSurface &surface) const {
    const std::string vertices = std::to_string(surface.vertices.size());
    const std::size_t indices = 3 * surface.triangles.size(), places = padded(2 * indices);
    const std::size_t size = 12 * surface.vertices.size();
    Box<3> box;
    for (const PlaceInFile &vertex : surface.vertices) box.extend(vertex);
    const auto view = [](std::size_t offset, std::size_t length, int target) {
        return R"({"buffer":0,"byteOffset":)" + std::to_string(offset) + R"(,"byteLength":)" +
               std::to_string(length) + R"(,"target":)" + std::to_string(target) + "}";
    };
    std::string extras = R"({"centre":)" + list_of(Point<3>{middle_[0], middle_[1], height_});
    if (frame_.is_on_globe()) {
        const Point<2> degrees = frame_.degrees(middle_);
        extras += R"(,"degrees":)" + list_of(degrees) + R"(,"ecef":)" +
                  list_of(TileFrame::on_globe(degrees, height_));
    }
    // glTF's y is up: the matrix turns east, north and up to x, -z and y.
    return R"({"asset":{"version":"2.0","generator":"Abacus","extras":)" + extras +
           R"(}},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"matrix":)"
           "[1,0,0,0,0,0,-1,0,0,1,0,0,0,0,0,1]}],"
           R"("materials":[{"pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":1}}],)"
           R"("meshes":[{"primitives":[{"attributes":{"POSITION":1,"NORMAL":2},"indices":0,)"
           R"("material":0}]}],"accessors":[{"bufferView":0,"componentType":5123,"count":)" +
           std::to_string(indices) +
           R"(,"type":"SCALAR"},{"bufferView":1,"componentType":5126,"count":)" + vertices +
           R"(,"type":"VEC3","min":)" + list_of(box.lower) + R"(,"max":)" + list_of(box.upper) +
           R"(},{"bufferView":2,"componentType":5126,"count":)" + vertices +
           R"(,"type":"VEC3"}],"bufferViews":[)" + view(0, 2 * indices, 34963) + "," +
           view(places, size, 34962) + "," + view(places + size, size, 34962) +
           R"(],"buffers":[{"byteLength":)" + std::to_string(places + 2 * size) + "}]}";
}

Png GlbWriter::make(const Arena<SurfaceCorner> &corners) {
    double least = INFINITY, greatest = -INFINITY;
    for (const SurfaceCorner &corner : corners) {
        least = std::fmin(least, corner.height);
        greatest = std::fmax(greatest, corner.height);
    }
    if (corners.empty()) return bytes_.take();
    height_ = std::floor(least / 2 + greatest / 2);
    const Point<3> centre = frame_.place(middle_, height_);
    Arena<PlaceInFile> places(host_);
    for (const SurfaceCorner &corner : corners) {
        const Point<3> p = turned(difference(frame_.place(corner.at, corner.height), centre));
        PlaceInFile place;
        for (int i = 0; i < 3; ++i) {
            if (!fits_float(p[i])) throw_beyond_floats(corner);
            place[i] = static_cast<float>(p[i]);
        }
        places.push_back(place);
    }
    const WeldedSurface surface = weld(host_, corners, places);
    if (!surface.triangles.empty()) write(surface);
    return bytes_.take();
}

void GlbWriter::write(const WeldedSurface &surface) {
    std::string json = description(surface);
    json.resize(padded(json.size()), ' ');
    const std::size_t indices = 6 * surface.triangles.size();
    const std::size_t binary = padded(indices) + 24 * surface.vertices.size();
    bytes_.text("glTF");
    bytes_.number(std::uint32_t{2});
    bytes_.number(static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + binary));
    bytes_.number(static_cast<std::uint32_t>(json.size()));
    bytes_.text("JSON");
    bytes_.text(json);
    bytes_.number(static_cast<std::uint32_t>(binary));
    bytes_.text(std::string_view("BIN\0", 4));
    for (const auto &triangle : surface.triangles)
        for (const std::uint32_t vertex : triangle)
            bytes_.number(static_cast<std::uint16_t>(vertex));
    for (std::size_t i = indices; i < padded(indices); ++i) bytes_.byte(0);
    for (const PlaceInFile &vertex : surface.vertices)
        for (const double x : vertex) bytes_.number(static_cast<float>(x));
    for (const Point<3> &normal : surface.normals) {
        const Point<3> up{0, 0, 1};
        const Point<3> n = normal == Point<3>{} ? up : turned(normal);
        for (const double x : n) bytes_.number(static_cast<float>(x));
    }
}

} // namespace

Png glb(const Host &host, const Arena<SurfaceCorner> &corners, const Box<2> &box,
        const TileFrame &frame) {
    return GlbWriter(host, box, frame).make(corners);
}

} // namespace abacus
