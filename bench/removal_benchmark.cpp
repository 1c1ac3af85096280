// Removal of half the points of a uniform mesh, along the curve or in random order: the core over
// an in-memory store, and CGAL's remove() of the same points in the same order. CGAL gets the
// vertices; the core has to find them.
#include "uniform_mesh.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <benchmark/benchmark.h>

#include <optional>
#include <stdexcept>
#include <vector>

namespace {

using namespace abacus;
using namespace abacus::benchmarks;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

template <int D> struct Cgal;
template <> struct Cgal<2> {
    using Mesh = CGAL::Delaunay_triangulation_2<Kernel>;
    static Kernel::Point_2 point(const Point<2> &p) { return {p[0], p[1]}; }
    static Mesh::Face_handle cell(Mesh::Vertex_handle v) { return v->face(); }
};
template <> struct Cgal<3> {
    using Mesh = CGAL::Delaunay_triangulation_3<Kernel>;
    static Kernel::Point_3 point(const Point<3> &p) { return {p[0], p[1], p[2]}; }
    static Mesh::Cell_handle cell(Mesh::Vertex_handle v) { return v->cell(); }
};

/// Arguments: points, order, cache in MB.
template <int D> void Remove(benchmark::State &state) {
    const UniformPoints<D> input(std::size_t(state.range(0)), Order(state.range(1)));
    for (auto _ : state) {
        state.PauseTiming();
        std::optional<UniformMesh<D>> mesh;
        mesh.emplace(input, std::size_t(state.range(2)) << 20);
        state.ResumeTiming();
        for (const std::size_t i : input.removed)
            if (mesh->removal.remove(input.points[i]) != Removed::removed)
                throw std::runtime_error("a vertex is not found");
        state.PauseTiming();
        const auto &counters = mesh->cache.counters;
        state.counters["created/point"] = double(counters.created) / double(counters.removals);
        state.counters["steps/point"] = double(counters.steps) / double(counters.removals);
        state.counters["walks/point"] = double(counters.walks) / double(counters.removals);
        state.counters["loads"] = double(counters.loads);
        mesh.reset();
        state.ResumeTiming();
    }
    state.SetItemsProcessed(state.iterations() * std::int64_t(input.removed.size()));
}

/// Arguments: points, order.
template <int D> void CgalRemove(benchmark::State &state) {
    const UniformPoints<D> input(std::size_t(state.range(0)), Order(state.range(1)));
    for (auto _ : state) {
        state.PauseTiming();
        std::optional<typename Cgal<D>::Mesh> mesh;
        mesh.emplace();
        std::vector<typename Cgal<D>::Mesh::Vertex_handle> vertices;
        for (const auto &p : input.points)
            vertices.push_back(
                vertices.empty() ? mesh->insert(Cgal<D>::point(p))
                                 : mesh->insert(Cgal<D>::point(p), Cgal<D>::cell(vertices.back())));
        state.ResumeTiming();
        for (const std::size_t i : input.removed) mesh->remove(vertices[i]);
        state.PauseTiming();
        mesh.reset();
        state.ResumeTiming();
    }
    state.SetItemsProcessed(state.iterations() * std::int64_t(input.removed.size()));
}

BENCHMARK(Remove<2>)
    ->Args({1'000'000, along_the_curve, 1024})
    ->Args({1'000'000, along_the_curve, 8})
    ->Args({1'000'000, random_order, 1024})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(CgalRemove<2>)
    ->Args({1'000'000, along_the_curve})
    ->Args({1'000'000, random_order})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(Remove<3>)
    ->Args({200'000, along_the_curve, 2048})
    ->Args({200'000, along_the_curve, 4})
    ->Args({200'000, random_order, 2048})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(CgalRemove<3>)
    ->Args({200'000, along_the_curve})
    ->Args({200'000, random_order})
    ->Unit(benchmark::kMillisecond);

} // namespace
