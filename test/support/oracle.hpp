// The whole way through the C interface, over an in-memory host: points in,
// triangulation out, and the same from CGAL (GPL, so in test programs only).
#pragma once

#include "geometry/point.hpp"
#include "support/memory_host.hpp"

#include <abacus/abacus.h>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace abacus::test {

template <int D> struct InputOf {
    InputOf() = default;
    InputOf(std::int64_t id, const Point<D> &point, const std::vector<double> &attributes = {})
        : id(id), point(point), attributes(attributes) {}

    std::int64_t id = 0;
    Point<D> point{};
    std::vector<double> attributes;
};
using Input = InputOf<2>;

/// The places of a simplex's corners, in the same order for each simplex: positively oriented, the
/// lexicographically least first, in 3D the second least next.
template <int D> using Positions = std::array<Point<D>, D + 1>;

/// A mesh of D dimensions over a host of its own.
template <int D> struct MeshOf {
    explicit MeshOf(int attributes = 0, std::size_t cache_bytes = std::size_t(64) << 20);

    /// Each returns the status and keeps the error.
    abacus_status stage(const std::vector<InputOf<D>> &points, std::size_t memory = 16 << 20);
    abacus_status build();
    /// Without vertex pages in between.
    abacus_status insert(const std::vector<InputOf<D>> &points, std::size_t memory = 16 << 20,
                         abacus_on_duplicate on_duplicate = ABACUS_KEEP);
    /// `deleted` gets the number of points that there were.
    abacus_status remove(const std::vector<InputOf<D>> &points, std::uint64_t &deleted,
                         std::size_t memory = 16 << 20, bool exactly = false);
    /// Loads a triangulation. Simplices are named by the ids of their vertices, and have as many
    /// labels as the header; facets are ids and a marker each.
    abacus_status load(const std::vector<InputOf<D>> &vertices,
                       const std::vector<std::array<std::int64_t, D + 1>> &simplices,
                       std::size_t memory = 16 << 20, bool reorient = true,
                       bool retriangulate = false,
                       const std::vector<std::vector<double>> &labels = {},
                       const std::vector<std::uint64_t> &facets = {});
    abacus_delaunay loaded_as = ABACUS_DELAUNAY; ///< as load() found
    bool split_nodes = false;                    ///< load() keeps vertices at one place apart
    /// The places of all simplices, sorted.
    std::vector<Positions<D>> positions();
    /// The simplices from a scan; fails the test if it does not end well.
    std::vector<abacus_simplex> simplices(bool ghosts);
    /// "kind: message" of each fault.
    std::vector<std::string> check();
    abacus_status locate(const Point<D> &p, abacus_simplex &simplex);

    /// Calls use() with a stage of the points, or a build of the mesh.
    abacus_status with_stage(const std::vector<InputOf<D>> &points, std::size_t memory,
                             const std::function<abacus_status(abacus_stage *)> &use,
                             bool with_attributes = true);
    abacus_status with_build(const std::function<abacus_status(abacus_build *)> &use);

    MemoryHost host;
    abacus_header header{};
    abacus_error error{};
    std::size_t cache_bytes;
};
using Mesh = MeshOf<2>;

/// A mesh open for reading. Its functions return the status and keep the error.
template <int D> class OpenMeshOf {
public:
    OpenMeshOf(MeshOf<D> &mesh, std::size_t cache_bytes);
    OpenMeshOf(const OpenMeshOf &) = delete;
    OpenMeshOf &operator=(const OpenMeshOf &) = delete;
    ~OpenMeshOf() { abacus_mesh_close(handle_); }

    abacus_status locate(const Point<D> &p, abacus_simplex &simplex) {
        return abacus_mesh_locate(handle_, p.data(), &simplex, &error);
    }
    abacus_status walk(const abacus_simplex &from, int facet, abacus_simplex &simplex) {
        return abacus_mesh_walk(handle_, from.code, from.id, facet, &simplex, &error);
    }
    abacus_status interpolate(const abacus_interpolation &how, const Point<D> &p, double *values) {
        return abacus_mesh_interpolate(handle_, &how, p.data(), values, &error);
    }
    abacus_status weigh(const abacus_interpolation &how, const Point<D> &p,
                        const abacus_weight *&weights, std::size_t &count) {
        return abacus_mesh_weigh(handle_, &how, p.data(), &weights, &count, &error);
    }
    abacus_status gradient(const abacus_interpolation &how, const Point<D> &p, double *gradient) {
        return abacus_mesh_gradient(handle_, &how, p.data(), gradient, nullptr, &error);
    }
    abacus_counters counters() const;

    abacus_error error{};

private:
    abacus_mesh *handle_ = nullptr;
};
using OpenMesh = OpenMeshOf<2>;

/// n points of the unit square, drawn with the seed.
std::vector<Point<2>> unit_square_points(int n, unsigned seed);
/// Points with the ids 0, 1, 2, ...
template <int D> std::vector<InputOf<D>> number(const std::vector<Point<D>> &points);
inline std::vector<Input> number(const std::vector<Point<2>> &points) { return number<2>(points); }
/// The places of finite simplices, sorted.
template <int D>
std::vector<Positions<D>> positions_of(const std::vector<abacus_simplex> &simplices);
/// The places of CGAL's Delaunay simplices of the points, sorted.
template <int D> std::vector<Positions<D>> cgal_simplices(const std::vector<Point<D>> &points);

} // namespace abacus::test
