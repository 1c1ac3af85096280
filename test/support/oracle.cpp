#include "support/oracle.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <random>

namespace abacus::test {

namespace {

Triangle canonical(Triangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

} // namespace

Mesh::Mesh(int attributes, std::size_t bytes) : cache_bytes(bytes) {
    header.dimension = 2;
    header.attributes = static_cast<std::uint32_t>(attributes);
    for (int i = 0; i < attributes; ++i)
        std::snprintf(header.names[i], ABACUS_NAME_BYTES, "a%d", i);
}

abacus_status Mesh::stage(const std::vector<Input> &points, std::size_t memory) {
    abacus_stage *stage = nullptr;
    abacus_status status = abacus_stage_open(host.table(), &header, memory, &stage, &error);
    if (status != ABACUS_OK) return status;
    for (const Input &input : points) {
        std::vector<std::uint64_t> record{static_cast<std::uint64_t>(input.id)};
        for (const double x : input.point) record.push_back(std::bit_cast<std::uint64_t>(x));
        for (const double x : input.attributes) record.push_back(std::bit_cast<std::uint64_t>(x));
        status = abacus_stage_add(stage, record.data(), 1, &error);
        if (status != ABACUS_OK) break;
    }
    if (status == ABACUS_OK) status = abacus_stage_finish(stage, &header, &error);
    abacus_stage_close(stage);
    return status;
}

abacus_status Mesh::build() {
    abacus_build *build = nullptr;
    abacus_status status = abacus_build_open(host.table(), &header, cache_bytes, &build, &error);
    if (status != ABACUS_OK) return status;
    status = abacus_build_run(build, 0, &header, &error);
    abacus_build_close(build);
    return status;
}

std::vector<Triangle> Mesh::triangles() {
    std::vector<Triangle> result;
    for (const abacus_simplex &s : simplices(false)) {
        Triangle t;
        for (int i = 0; i < 3; ++i) t[i] = {s.corner[i][0], s.corner[i][1]};
        result.push_back(canonical(t));
    }
    std::sort(result.begin(), result.end());
    return result;
}

std::vector<abacus_simplex> Mesh::simplices(bool ghosts) {
    std::vector<abacus_simplex> result;
    abacus_scan *scan = nullptr;
    abacus_status status = abacus_scan_open(host.table(), &header, ghosts, &scan, &error);
    abacus_simplex s;
    while (status == ABACUS_OK && (status = abacus_scan_next(scan, &s, &error)) == ABACUS_OK)
        result.push_back(s);
    EXPECT_EQ(status, ABACUS_END) << error.message << ' ' << error.detail;
    abacus_scan_close(scan);
    return result;
}

std::vector<std::string> Mesh::check() {
    std::vector<std::string> faults;
    abacus_check *check = nullptr;
    const abacus_status status =
        abacus_check_open(host.table(), &header, cache_bytes, 100, &check, &error);
    if (status != ABACUS_OK) return {std::string("status: ") + error.message};
    abacus_fault fault;
    while (abacus_check_next(check, &fault) == ABACUS_OK)
        faults.push_back(std::string(fault.kind) + ": " + fault.message);
    abacus_check_close(check);
    return faults;
}

abacus_status Mesh::locate(const Point<2> &p, abacus_simplex &simplex) {
    abacus_mesh *mesh = nullptr;
    abacus_status status = abacus_mesh_open(host.table(), &header, cache_bytes, &mesh, &error);
    if (status != ABACUS_OK) return status;
    status = abacus_mesh_locate(mesh, p.data(), &simplex, &error);
    abacus_mesh_close(mesh);
    return status;
}

OpenMesh::OpenMesh(Mesh &mesh, std::size_t cache_bytes) {
    EXPECT_EQ(abacus_mesh_open(mesh.host.table(), &mesh.header, cache_bytes, &handle_, &error),
              ABACUS_OK);
}

abacus_counters OpenMesh::counters() const {
    abacus_counters counters;
    abacus_mesh_counters(handle_, &counters);
    return counters;
}

std::vector<Point<2>> unit_square_points(int n, unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Point<2>> points(n);
    for (auto &p : points) p = {unit(random), unit(random)};
    return points;
}

std::vector<Input> number(const std::vector<Point<2>> &points) {
    std::vector<Input> inputs;
    for (const Point<2> &p : points)
        inputs.push_back({static_cast<std::int64_t>(inputs.size()), p});
    return inputs;
}

std::vector<Triangle> cgal_triangles(const std::vector<Point<2>> &points) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    std::vector<Kernel::Point_2> input;
    for (const Point<2> &p : points) input.emplace_back(p[0], p[1]);
    const CGAL::Delaunay_triangulation_2<Kernel> mesh(input.begin(), input.end());
    std::vector<Triangle> result;
    if (mesh.dimension() < 2) return result;
    for (auto face = mesh.finite_faces_begin(); face != mesh.finite_faces_end(); ++face) {
        Triangle t;
        for (int i = 0; i < 3; ++i) {
            const auto &p = face->vertex(i)->point();
            t[i] = {p.x(), p.y()};
        }
        result.push_back(canonical(t));
    }
    std::sort(result.begin(), result.end());
    return result;
}

} // namespace abacus::test
