#include "tiles/welded_surface.hpp"

#include <tuple>

namespace abacus {

namespace {

/// Numbers the vertices by the first triangle that names them.
void number_anew(const Host &host, WeldedSurface &surface) {
    constexpr std::uint32_t none = UINT32_MAX;
    Arena<std::uint32_t> number(host);
    number.resize(surface.vertices.size());
    std::fill(number.begin(), number.end(), none);
    Arena<PlaceInFile> vertices(host);
    Arena<Point<3>> normals(host);
    for (auto &triangle : surface.triangles)
        for (std::uint32_t &vertex : triangle) {
            if (number[vertex] == none) {
                number[vertex] = static_cast<std::uint32_t>(vertices.size());
                vertices.push_back(surface.vertices[vertex]);
                normals.push_back(surface.normals[vertex]);
            }
            vertex = number[vertex];
        }
    surface.vertices.swap(vertices);
    surface.normals.swap(normals);
}

} // namespace

WeldedSurface weld(const Host &host, const Arena<SurfaceCorner> &corners,
                   const Arena<PlaceInFile> &places) {
    WeldedSurface surface{Arena<PlaceInFile>(host), Arena<Point<3>>(host),
                          Arena<std::array<std::uint32_t, 3>>(host)};
    Arena<std::uint32_t> order(host), vertex_of(host);
    order.resize(corners.size());
    vertex_of.resize(corners.size());
    for (std::uint32_t i = 0; i < corners.size(); ++i) order[i] = i;
    const auto key = [&](std::uint32_t i) { return std::tie(places[i], corners[i].normal); };
    host.poll();
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    host.poll();
    for (const std::uint32_t i : order) {
        if (surface.vertices.empty() || surface.vertices.back() != places[i]) {
            surface.vertices.push_back(places[i]);
            surface.normals.push_back({0, 0, 0});
        }
        for (int axis = 0; axis < 3; ++axis)
            surface.normals.back()[axis] += corners[i].normal[axis];
        vertex_of[i] = static_cast<std::uint32_t>(surface.vertices.size() - 1);
    }
    for (Point<3> &normal : surface.normals) normal = direction_of(normal);
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        std::array<std::uint32_t, 3> triangle{vertex_of[i], vertex_of[i + 1], vertex_of[i + 2]};
        if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0])
            continue;
        std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                    triangle.end());
        surface.triangles.push_back(triangle);
    }
    std::sort(surface.triangles.begin(), surface.triangles.end());
    number_anew(host, surface);
    return surface;
}

} // namespace abacus
