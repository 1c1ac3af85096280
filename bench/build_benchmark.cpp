// The core from end to end over an in-memory store: staging, building with caches of
// several sizes, locating. scripts/bench.sh measures what PostgreSQL adds.
#include "support/memory_host.hpp"

#include <abacus/build.h>
#include <abacus/locate.h>
#include <benchmark/benchmark.h>

#include <array>
#include <bit>
#include <random>
#include <stdexcept>
#include <vector>

namespace {

using namespace abacus;

constexpr std::size_t sort_bytes = std::size_t{64} << 20;

void require(abacus_status status, const abacus_error &error) {
    if (status != ABACUS_OK) throw std::runtime_error(error.message);
}

template <int D> abacus_header empty_header() {
    abacus_header header{};
    header.facts.form.dimension = D;
    return header;
}

double unit(std::mt19937_64 &engine) { return double(engine() >> 11) * 0x1p-53; }

/// Rows (id, x, y[, z]) as abacus_stage_add() takes them.
template <int D> std::vector<std::uint64_t> uniform_rows(std::size_t count) {
    std::mt19937_64 engine(1);
    std::vector<std::uint64_t> rows;
    rows.reserve((1 + D) * count);
    for (std::size_t i = 0; i < count; ++i) {
        rows.push_back(i);
        for (int axis = 0; axis < D; ++axis)
            rows.push_back(std::bit_cast<std::uint64_t>(unit(engine)));
    }
    return rows;
}

void stage(MemoryHost &host, abacus_header &header, const std::vector<std::uint64_t> &rows) {
    abacus_stage *handle = nullptr;
    abacus_error error{};
    require(abacus_stage_open(host.table(), &header.facts, sort_bytes, &handle, &error), error);
    require(abacus_stage_add(handle, rows.data(), rows.size() / (1 + header.facts.form.dimension),
                             &error),
            error);
    require(abacus_stage_finish(handle, &header.facts, &error), error);
    abacus_stage_close(handle);
}

void build(MemoryHost &host, abacus_header &header, std::size_t cache_bytes) {
    abacus_build *handle = nullptr;
    abacus_error error{};
    require(abacus_build_open(host.table(), &header.facts, cache_bytes, &handle, &error), error);
    require(abacus_build_run(handle, 0, &header, &error), error);
    abacus_build_close(handle);
}

/// Argument: points.
template <int D> void Stage(benchmark::State &state) {
    const auto rows = uniform_rows<D>(std::size_t(state.range(0)));
    for (auto _ : state) {
        MemoryHost host;
        host.strict = false;
        abacus_header header = empty_header<D>();
        stage(host, header, rows);
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}

/// Arguments: points, cache in MB.
template <int D> void Build(benchmark::State &state) {
    const auto rows = uniform_rows<D>(std::size_t(state.range(0)));
    abacus_header header;
    std::size_t page_bytes = 0, page_count = 0;
    for (auto _ : state) {
        state.PauseTiming();
        {
            MemoryHost host;
            host.strict = false;
            header = empty_header<D>();
            stage(host, header, rows);
            state.ResumeTiming();
            build(host, header, std::size_t(state.range(1)) << 20);
            state.PauseTiming();
            page_bytes = 0;
            for (const auto &[key, page] : host.pages) page_bytes += page.size;
            page_count = host.pages.size();
        }
        state.ResumeTiming();
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
    const auto &counters = header.counters;
    state.counters["bytes/simplex"] = double(page_bytes) / double(header.facts.census.simplices);
    state.counters["fill"] = double(page_bytes) / double(page_count) / ABACUS_PAGE_BYTES;
    state.counters["loads"] = double(counters.loads);
    state.counters["stores"] = double(counters.stores);
    state.counters["page_us"] =
        1e-3 * double(counters.translation_ns) / double(counters.loads + counters.stores);
    state.counters["hit_ratio"] = 1 - double(counters.misses) / double(counters.steps);
}

/// Arguments: points, cache in MB. Random places, one by one.
template <int D> void Locate(benchmark::State &state) {
    MemoryHost host;
    host.strict = false;
    abacus_header header = empty_header<D>();
    stage(host, header, uniform_rows<D>(std::size_t(state.range(0))));
    build(host, header, std::size_t{64} << 20);
    abacus_mesh *mesh = nullptr;
    abacus_error error{};
    require(abacus_mesh_open(host.table(), &header.facts, std::size_t(state.range(1)) << 20, &mesh,
                             &error),
            error);
    std::mt19937_64 engine(2);
    const auto locate = [&] {
        std::array<double, D> point;
        for (double &x : point) x = unit(engine);
        abacus_simplex simplex;
        const abacus_status status = abacus_mesh_locate(mesh, point.data(), &simplex, &error);
        if (status != ABACUS_OK && status != ABACUS_END) require(status, error);
    };
    for (int i = 0; i < 100'000; ++i) locate(); // fills the cache
    for (auto _ : state) locate();
    abacus_mesh_close(mesh);
    state.SetItemsProcessed(state.iterations());
}

BENCHMARK(Stage<2>)->Arg(1'000'000)->Unit(benchmark::kMillisecond);
BENCHMARK(Stage<3>)->Arg(1'000'000)->Unit(benchmark::kMillisecond);
BENCHMARK(Build<2>)
    ->Args({1'000'000, 1})
    ->Args({1'000'000, 8})
    ->Args({1'000'000, 64})
    ->Args({1'000'000, 1024})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(Build<3>)
    ->Args({1'000'000, 16})
    ->Args({1'000'000, 128})
    ->Args({1'000'000, 1024})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(Locate<2>)->Args({1'000'000, 8})->Args({1'000'000, 256});
BENCHMARK(Locate<3>)->Args({200'000, 8})->Args({200'000, 256});

} // namespace
