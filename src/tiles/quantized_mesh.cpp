#include "tiles/quantized_mesh.hpp"

#include "tiles/little_endian.hpp"
#include "tiles/welded_surface.hpp"

#include <limits>

namespace abacus {

namespace {

constexpr double last_step = 32767;

/// The range of the heights in floats, as the header has it.
struct HeightRange {
    float least = std::numeric_limits<float>::infinity();
    float greatest = -std::numeric_limits<float>::infinity();

    void extend(double height) {
        auto below = static_cast<float>(height), above = below;
        if (below > height) below = std::nextafter(below, -INFINITY);
        if (above < height) above = std::nextafter(above, INFINITY);
        least = std::min(least, below);
        greatest = std::max(greatest, above);
    }
};

class Quantizing {
public:
    Quantizing(const Host &host, const Box<2> &box, const TileFrame &frame)
        : host_(host), frame_(frame), lower_(frame.degrees(box.lower)),
          upper_(frame.degrees(box.upper)), bytes_(host) {}

    Png make(const Arena<SurfaceCorner> &corners);

private:
    PlaceInFile quantized(const SurfaceCorner &corner) const;
    static void add_least_triangle(const PlaceInFile &at, WeldedSurface &surface);
    Point<3> place_of(const PlaceInFile &vertex) const;
    void write_header(const WeldedSurface &surface);
    void write_vertices(const WeldedSurface &surface);
    void write_triangles(const WeldedSurface &surface);
    void write_border(const WeldedSurface &surface, int axis, double at);
    void write_normals(const WeldedSurface &surface);

    const Host &host_;
    const TileFrame &frame_;
    const Point<2> lower_, upper_; // in degrees
    HeightRange heights_;
    LittleEndian bytes_;
};

/// From 0 to 32767; `ends`: the bits of the borders on which it is 0, or 32767.
double step_of(double share, int borders, TileBorder lower, TileBorder upper) {
    if ((borders & lower) != 0) return 0;
    if ((borders & upper) != 0) return last_step;
    return std::clamp(std::nearbyint(share * last_step), 1.0, last_step - 1);
}

PlaceInFile Quantizing::quantized(const SurfaceCorner &corner) const {
    const Point<2> at = frame_.degrees(corner.at);
    const auto share = [&](int axis) {
        return (at[axis] - lower_[axis]) / (upper_[axis] - lower_[axis]);
    };
    const double least = heights_.least, range = heights_.greatest - least;
    return {step_of(share(0), corner.borders, west_border, east_border),
            step_of(share(1), corner.borders, south_border, north_border),
            range > 0 ? std::nearbyint((corner.height - least) / range * last_step) : 0};
}

/// For a mesh that is smaller than a step, as readers take no tile without a triangle. It touches
/// no border.
void Quantizing::add_least_triangle(const PlaceInFile &at, WeldedSurface &surface) {
    const PlaceInFile corner{std::clamp(at[0], 1.0, last_step - 2),
                             std::clamp(at[1], 1.0, last_step - 2), at[2]};
    surface.vertices.push_back(corner);
    surface.vertices.push_back({corner[0] + 1, corner[1], corner[2]});
    surface.vertices.push_back({corner[0], corner[1] + 1, corner[2]});
    surface.normals.resize(3);
    std::fill(surface.normals.begin(), surface.normals.end(), Point<3>{});
    surface.triangles.push_back({0, 1, 2});
}

/// Where a reader puts it.
Point<3> Quantizing::place_of(const PlaceInFile &vertex) const {
    const auto degrees = [&](int axis) {
        return std::lerp(lower_[axis], upper_[axis], vertex[axis] / last_step);
    };
    return TileFrame::on_globe({degrees(0), degrees(1)},
                               std::lerp(heights_.least, heights_.greatest, vertex[2] / last_step));
}

Png Quantizing::make(const Arena<SurfaceCorner> &corners) {
    if (corners.empty()) return bytes_.take();
    for (const SurfaceCorner &corner : corners) {
        if (!fits_float(corner.height)) throw_beyond_floats(corner);
        heights_.extend(corner.height);
    }
    Arena<PlaceInFile> places(host_);
    for (const SurfaceCorner &corner : corners) places.push_back(quantized(corner));
    WeldedSurface surface = weld(host_, corners, places);
    if (surface.triangles.empty())
        add_least_triangle(*std::min_element(places.begin(), places.end()), surface);
    write_header(surface);
    write_vertices(surface);
    write_triangles(surface);
    write_border(surface, 0, 0);
    write_border(surface, 1, 0);
    write_border(surface, 0, last_step);
    write_border(surface, 1, last_step);
    write_normals(surface);
    return bytes_.take();
}

/// As in "Horizon culling 2" by K. Ring (2013): how far out, in units of the ellipsoid, a point in
/// a direction must be to be seen from wherever p is. Negative or infinite if there is no such.
double distance_seen_with(const Point<3> &p, const Point<3> &direction) {
    const double length = std::sqrt(dot(p, p)), from = std::fmax(length, 1);
    const Point<3> towards = direction_of(p), normal = cross(towards, direction);
    const double cosine = dot(towards, direction), sine = std::sqrt(dot(normal, normal));
    const double horizon_cosine = 1 / from;
    const double horizon_sine = std::sqrt(from * from - 1) * horizon_cosine;
    return 1 / (cosine * horizon_cosine - sine * horizon_sine);
}

/// Centre, heights, a sphere around all vertices, and a point that is below the horizon only where
/// all of them are.
void Quantizing::write_header(const WeldedSurface &surface) {
    Box<3> box;
    for (const PlaceInFile &vertex : surface.vertices) box.extend(place_of(vertex));
    Point<3> middle;
    for (int i = 0; i < 3; ++i) middle[i] = box.lower[i] / 2 + box.upper[i] / 2;
    const auto scaled = [](const Point<3> &p) {
        return Point<3>{p[0] / equator_radius, p[1] / equator_radius, p[2] / pole_radius};
    };
    const Point<3> direction = direction_of(scaled(middle));
    double radius = 0, distance = 1;
    for (const PlaceInFile &vertex : surface.vertices) {
        const Point<3> place = place_of(vertex), out = difference(place, middle);
        radius = std::fmax(radius, std::sqrt(dot(out, out)));
        const double seen = distance_seen_with(scaled(place), direction);
        // Of a tile around half of the globe there is no such point: comparisons with NaN never
        // say that it is hidden.
        distance = seen > 0 && std::isfinite(seen) && !std::isnan(distance)
                       ? std::fmax(distance, seen)
                       : NAN;
    }
    const Point<2> centre{lower_[0] / 2 + upper_[0] / 2, lower_[1] / 2 + upper_[1] / 2};
    const double height = double{heights_.least} / 2 + double{heights_.greatest} / 2;
    for (const double x : TileFrame::on_globe(centre, height)) bytes_.number(x);
    bytes_.number(heights_.least);
    bytes_.number(heights_.greatest);
    for (const double x : middle) bytes_.number(x);
    bytes_.number(std::nextafter(radius, INFINITY));
    for (const double x : direction) bytes_.number(x * distance);
}

void Quantizing::write_vertices(const WeldedSurface &surface) {
    bytes_.number(static_cast<std::uint32_t>(surface.vertices.size()));
    for (int axis = 0; axis < 3; ++axis) {
        std::int32_t last = 0;
        for (const PlaceInFile &vertex : surface.vertices) {
            const auto here = static_cast<std::int32_t>(vertex[axis]);
            const std::int32_t change = here - std::exchange(last, here);
            bytes_.number(static_cast<std::uint16_t>((change * 2) ^ (change >> 31)));
        }
    }
}

/// Each vertex as a distance from the greatest number so far.
void Quantizing::write_triangles(const WeldedSurface &surface) {
    bytes_.number(static_cast<std::uint32_t>(surface.triangles.size()));
    std::uint32_t next = 0;
    for (const auto &triangle : surface.triangles)
        for (const std::uint32_t vertex : triangle) {
            bytes_.number(static_cast<std::uint16_t>(next - vertex));
            if (vertex == next) ++next;
        }
}

/// The vertices with `at` on an axis, in the order of the other one.
void Quantizing::write_border(const WeldedSurface &surface, int axis, double at) {
    Arena<std::uint32_t> border(host_);
    for (std::uint32_t i = 0; i < surface.vertices.size(); ++i)
        if (surface.vertices[i][axis] == at) border.push_back(i);
    std::sort(border.begin(), border.end(), [&](std::uint32_t a, std::uint32_t b) {
        const auto key = [&](std::uint32_t i) {
            return std::pair(surface.vertices[i][1 - axis], surface.vertices[i][2]);
        };
        return key(a) < key(b);
    });
    bytes_.number(static_cast<std::uint32_t>(border.size()));
    for (const std::uint32_t vertex : border) bytes_.number(static_cast<std::uint16_t>(vertex));
}

/// Each in two bytes: on an octahedron whose lower half is folded out.
void Quantizing::write_normals(const WeldedSurface &surface) {
    constexpr std::uint8_t octvertexnormals = 1;
    bytes_.byte(octvertexnormals);
    bytes_.number(static_cast<std::uint32_t>(2 * surface.normals.size()));
    for (const Point<3> &normal : surface.normals) {
        const double sum = std::fabs(normal[0]) + std::fabs(normal[1]) + std::fabs(normal[2]);
        double x = sum > 0 ? normal[0] / sum : 0, y = sum > 0 ? normal[1] / sum : 0;
        if (normal[2] < 0) {
            const double folded = (1 - std::fabs(y)) * (x < 0 ? -1 : 1);
            y = (1 - std::fabs(x)) * (y < 0 ? -1 : 1);
            x = folded;
        }
        for (const double v : {x, y})
            bytes_.byte(static_cast<std::uint8_t>(std::nearbyint((v / 2 + 0.5) * 255)));
    }
}

} // namespace

Png quantized_mesh(const Host &host, const Arena<SurfaceCorner> &corners, const Box<2> &box,
                   const TileFrame &frame) {
    return Quantizing(host, box, frame).make(corners);
}

} // namespace abacus
