// Changes of a finished mesh, by the core over an in-memory store: the same number of points again
// in one change, compared with the first build; and successive changes all over it.
#include "support/memory_host.hpp"

#include <abacus/build.h>
#include <benchmark/benchmark.h>

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

/// A mesh in memory, changed by the points of a long list of uniform ones.
template <int D> class Mesh {
public:
    Mesh(std::size_t points, std::size_t cache_bytes) : cache_bytes_(cache_bytes) {
        host_.strict = false;
        header.facts.form.dimension = D;
        std::mt19937_64 engine(1);
        rows_.reserve(points * (1 + D));
        for (std::size_t i = 0; i < points; ++i) {
            rows_.push_back(i);
            for (int axis = 0; axis < D; ++axis)
                rows_.push_back(std::bit_cast<std::uint64_t>(double(engine() >> 11) * 0x1p-53));
        }
    }
    void insert(std::size_t from, std::size_t to) { change(from, to, false); }
    void remove(std::size_t from, std::size_t to) { change(from, to, true); }

    std::size_t pages() const { return host_.pages.size(); }
    /// As a share of all bytes in pages.
    double fill() const {
        std::size_t bytes = 0;
        for (const auto &[key, page] : host_.pages) bytes += page.size;
        return double(bytes) / double(pages()) / ABACUS_PAGE_BYTES;
    }

    abacus_header header{};

private:
    void change(std::size_t from, std::size_t to, bool removes) {
        abacus_stage *stage = nullptr;
        abacus_build *build = nullptr;
        abacus_error error{};
        require(abacus_stage_open(host_.table(), &header.facts, sort_bytes, &stage, &error), error);
        require(abacus_stage_add(stage, rows_.data() + from * (1 + D), to - from, &error), error);
        require(abacus_stage_end(stage, &header.facts, &error), error);
        require(abacus_build_open(host_.table(), &header.facts, cache_bytes_, &build, &error),
                error);
        header.counters = {};
        std::uint64_t deleted;
        require(removes ? abacus_build_delete(build, stage, 0, &header, &deleted, &error)
                        : abacus_build_insert(build, stage, ABACUS_KEEP, &header, &error),
                error);
        abacus_build_close(build);
        abacus_stage_close(stage);
    }

    MemoryHost host_;
    std::size_t cache_bytes_;
    std::vector<std::uint64_t> rows_;
};

template <int D> void report(benchmark::State &state, const Mesh<D> &mesh) {
    const abacus_counters &counters = mesh.header.counters;
    state.counters["pages"] = double(mesh.pages());
    state.counters["fill"] = mesh.fill();
    state.counters["loads"] = double(counters.loads);
    state.counters["stores"] = double(counters.stores);
    state.counters["created"] = double(counters.created);
}

/// Arguments: points of the mesh, points inserted, cache in MB.
template <int D> void Insert(benchmark::State &state) {
    const auto points = std::size_t(state.range(0)), more = std::size_t(state.range(1));
    for (auto _ : state) {
        state.PauseTiming();
        {
            Mesh<D> mesh(points + more, std::size_t(state.range(2)) << 20);
            if (points > 0) mesh.insert(0, points);
            state.ResumeTiming();
            mesh.insert(points, points + more);
            state.PauseTiming();
            report(state, mesh);
        }
        state.ResumeTiming();
    }
}

/// Arguments: points of the mesh, points changed at a time, cache in MB. Ten times that many are
/// deleted, and as many inserted.
template <int D> void Exchange(benchmark::State &state) {
    const auto points = std::size_t(state.range(0)), some = std::size_t(state.range(1));
    for (auto _ : state) {
        state.PauseTiming();
        {
            Mesh<D> mesh(points + 10 * some, std::size_t(state.range(2)) << 20);
            mesh.insert(0, points);
            const double fresh = double(mesh.pages());
            state.ResumeTiming();
            for (std::size_t i = 0; i < 10; ++i) {
                mesh.remove(i * some, (i + 1) * some);
                mesh.insert(points + i * some, points + (i + 1) * some);
            }
            state.PauseTiming();
            report(state, mesh);
            state.counters["to fresh"] = double(mesh.pages()) / fresh;
        }
        state.ResumeTiming();
    }
}

BENCHMARK(Insert<2>)
    ->Args({0, 1'000'000, 128})
    ->Args({1'000'000, 1'000'000, 128})
    ->Args({0, 1'000'000, 16})
    ->Args({1'000'000, 1'000'000, 16})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(Insert<3>)
    ->Args({0, 1'000'000, 128})
    ->Args({1'000'000, 1'000'000, 128})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(Exchange<2>)->Args({1'000'000, 50'000, 128})->Unit(benchmark::kMillisecond);
BENCHMARK(Exchange<3>)->Args({200'000, 10'000, 128})->Unit(benchmark::kMillisecond);

} // namespace
