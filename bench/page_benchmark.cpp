// Between pages and memory, one step at a time: checking a page and making its columns readable
// (Decode), making a block with its links from a page (Load) and a page from a block (Store),
// dropping blocks (Evict; changed ones are stored first), splitting a full block (Split); and
// inserting points with a cache so large that none of these is needed (Insert). All with a store in
// memory. Items are pages, blocks or points.
#include "uniform_mesh.hpp"

#include <benchmark/benchmark.h>

#include <chrono>
#include <memory>
#include <optional>

namespace {

using namespace abacus;
using namespace abacus::benchmarks;

constexpr std::size_t ample = std::size_t{4} << 30, little = std::size_t{1} << 20;
template <int D> constexpr std::size_t point_count = D == 2 ? 200'000 : 50'000;

/// A mesh of uniform points whose pages are all stored.
template <int D> struct StoredMesh : UniformMesh<D> {
    StoredMesh() : UniformMesh<D>(UniformPoints<D>(point_count<D>, along_the_curve), ample) {
        this->cache.flush();
    }
    std::unique_ptr<Cache<D>> open(std::size_t budget) const {
        return std::make_unique<Cache<D>>(this->host, unit_domain<D>(), 0,
                                          CacheOptions{.budget = budget});
    }
};

/// Calls each(handle of one of its simplices) for every block, which is loaded if necessary.
template <int D, class Each> void for_each_block(Cache<D> &cache, Each each) {
    for (Key key = first_key; !(key == end_key);) {
        Handle one = no_handle;
        key = cache.visit(key, [&](Handle h) { one = h; });
        each(one);
    }
}

class Seconds {
public:
    template <class Work> void add(Work work) {
        const auto start = std::chrono::steady_clock::now();
        work();
        sum_ += std::chrono::steady_clock::now() - start;
    }
    /// The same if work() returns true; otherwise its time does not count.
    template <class Work> void add_if(Work work) {
        const auto start = std::chrono::steady_clock::now();
        if (work()) sum_ += std::chrono::steady_clock::now() - start;
    }
    double sum() const { return sum_.count(); }

private:
    std::chrono::duration<double> sum_{0};
};

template <int D> void Decode(benchmark::State &state) {
    StoredMesh<D> mesh;
    const auto view = std::make_unique<PageView<D>>();
    for (auto _ : state)
        for (auto &[key, page] : mesh.memory.pages) view->read(page.bytes(), page.size, 0);
    state.SetItemsProcessed(state.iterations() * std::int64_t(mesh.memory.pages.size()));
}

template <int D> void Load(benchmark::State &state) {
    const StoredMesh<D> mesh;
    for (auto _ : state) {
        const auto cache = mesh.open(ample);
        Seconds seconds;
        seconds.add([&] { for_each_block(*cache, [](Handle) {}); });
        state.SetIterationTime(seconds.sum());
    }
    state.SetItemsProcessed(state.iterations() * std::int64_t(mesh.memory.pages.size()));
}

template <int D> void Store(benchmark::State &state) {
    const StoredMesh<D> mesh;
    for (auto _ : state) {
        const auto cache = mesh.open(ample);
        for_each_block(*cache, [&](Handle h) { cache->mark_dirty(h); });
        Seconds seconds;
        seconds.add([&] { cache->flush(); });
        state.SetIterationTime(seconds.sum());
    }
    state.SetItemsProcessed(state.iterations() * std::int64_t(mesh.memory.pages.size()));
}

/// Argument: whether the blocks have changed.
template <int D> void Evict(benchmark::State &state) {
    const StoredMesh<D> mesh;
    std::uint64_t evicted = 0;
    for (auto _ : state) {
        const auto cache = mesh.open(little);
        Seconds seconds;
        for_each_block(*cache, [&](Handle h) {
            if (state.range(0) != 0) cache->mark_dirty(h);
            cache->settle(0);
            seconds.add([&] { cache->trim(); });
        });
        evicted += cache->counters.evictions;
        state.SetIterationTime(seconds.sum());
    }
    state.SetItemsProcessed(std::int64_t(evicted));
}

/// Fills a block with simplices at random places. They come in pairs that are neighbours across all
/// facets, since a split needs links to follow. Times the ends of the operations that split.
template <int D> void Split(benchmark::State &state) {
    const UniformPoints<D> input(point_count<D>, random_order);
    MemoryHost memory;
    memory.strict = false;
    const Host host = memory.host();
    std::uint64_t splits = 0;
    for (auto _ : state) {
        Cache<D> cache(host, unit_domain<D>(), 0, {.budget = ample});
        cache.create_first_block();
        Seconds seconds;
        for (std::size_t i = 0; i + D < input.removed.size(); i += D + 1) {
            std::array<VertexIndex, D + 1> vertices;
            for (int k = 0; k <= D; ++k)
                vertices[k] = cache.create_vertex(input.points[input.removed[i + k]],
                                                  std::int64_t(i) + k, nullptr);
            const Handle a = cache.create(vertices), b = cache.create(vertices);
            for (int f = 0; f <= D; ++f) cache.connect(make_link(a, f), make_link(b, f));
            seconds.add_if([&] { return cache.settle(0); });
        }
        splits += cache.counters.splits;
        state.SetIterationTime(seconds.sum());
    }
    state.SetItemsProcessed(std::int64_t(splits));
}

/// Argument: the order.
template <int D> void Insert(benchmark::State &state) {
    UniformPoints<D> input(point_count<D>, along_the_curve);
    if (state.range(0) == random_order)
        std::shuffle(input.points.begin(), input.points.end(), std::mt19937_64(2));
    std::optional<UniformMesh<D>> mesh;
    for (auto _ : state) {
        Seconds seconds;
        seconds.add([&] { mesh.emplace(input, ample); });
        state.SetIterationTime(seconds.sum());
        mesh.reset();
    }
    state.SetItemsProcessed(state.iterations() * std::int64_t(input.points.size()));
}

BENCHMARK(Decode<2>)->Unit(benchmark::kMillisecond);
BENCHMARK(Decode<3>)->Unit(benchmark::kMillisecond);
BENCHMARK(Load<2>)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(Load<3>)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(Store<2>)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(Store<3>)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(Evict<2>)->Arg(0)->Arg(1)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(Evict<3>)->Arg(0)->Arg(1)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(Split<2>)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(Split<3>)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(Insert<2>)
    ->Arg(along_the_curve)
    ->Arg(random_order)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(Insert<3>)
    ->Arg(along_the_curve)
    ->Arg(random_order)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

} // namespace
