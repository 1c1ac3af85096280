// The whole way through the C interface, over an in-memory host: points in,
// triangulation out, and the same from CGAL (GPL, so in test programs only).
#pragma once

#include "geometry/point.hpp"
#include "support/memory_host.hpp"

#include <abacus/abacus.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace abacus::test {

struct Input {
    std::int64_t id;
    Point<2> point;
    std::vector<double> attributes{};
};

/// Corners of a triangle, the lexicographically least first, counterclockwise.
using Triangle = std::array<Point<2>, 3>;

struct Mesh {
    explicit Mesh(int attributes = 0, std::size_t cache_bytes = std::size_t(64) << 20);

    /// Each returns the status and keeps the error.
    abacus_status stage(const std::vector<Input> &points, std::size_t memory = 16 << 20);
    abacus_status build();
    std::vector<Triangle> triangles();
    /// "kind: message" of each fault.
    std::vector<std::string> check();
    abacus_status locate(const Point<2> &p, abacus_simplex &simplex);

    MemoryHost host;
    abacus_header header{};
    abacus_error error{};
    std::size_t cache_bytes;
};

std::vector<Input> number(const std::vector<Point<2>> &points);
/// CGAL's Delaunay triangles of the points, sorted.
std::vector<Triangle> cgal_triangles(const std::vector<Point<2>> &points);

} // namespace abacus::test
