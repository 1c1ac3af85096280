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
    /// What a scan gives; fails the test if it does not end well.
    std::vector<abacus_simplex> simplices(bool ghosts);
    /// "kind: message" of each fault.
    std::vector<std::string> check();
    abacus_status locate(const Point<2> &p, abacus_simplex &simplex);

    MemoryHost host;
    abacus_header header{};
    abacus_error error{};
    std::size_t cache_bytes;
};

/// A mesh open for reading. Its functions return the status and keep the error.
class OpenMesh {
public:
    OpenMesh(Mesh &mesh, std::size_t cache_bytes);
    OpenMesh(const OpenMesh &) = delete;
    OpenMesh &operator=(const OpenMesh &) = delete;
    ~OpenMesh() { abacus_mesh_close(handle_); }

    abacus_status locate(const Point<2> &p, abacus_simplex &simplex) {
        return abacus_mesh_locate(handle_, p.data(), &simplex, &error);
    }
    abacus_status walk(const abacus_simplex &from, int facet, abacus_simplex &simplex) {
        return abacus_mesh_walk(handle_, from.code, from.id, facet, &simplex, &error);
    }
    abacus_counters counters() const;

    abacus_error error{};

private:
    abacus_mesh *handle_ = nullptr;
};

/// n points of the unit square, drawn from the seed.
std::vector<Point<2>> unit_square_points(int n, unsigned seed);
std::vector<Input> number(const std::vector<Point<2>> &points);
/// CGAL's Delaunay triangles of the points, sorted.
std::vector<Triangle> cgal_triangles(const std::vector<Point<2>> &points);

} // namespace abacus::test
