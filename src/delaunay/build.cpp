#include "delaunay/build.hpp"

#include "cache/domain_of.hpp"
#include "cache/stopwatch.hpp"

#include <algorithm>

namespace abacus {

namespace {

constexpr std::uint64_t report_every = 4096; // points: some hundred times a second

} // namespace

template <int D>
Build<D>::Build(const Host &host, const abacus_header &header, std::size_t cache_bytes)
    : host_(host), attributes_(header.attributes),
      cache_(host_, domain_of<D>(header), static_cast<int>(header.attributes),
             CacheOptions{.budget = cache_bytes}),
      mesh_(host_, cache_, static_cast<std::int64_t>(header.simplices),
            static_cast<std::int64_t>(header.ghosts)),
      insertion_(mesh_), values_(host_) {
    values_.resize(attributes_);
}

template <int D>
bool Build<D>::find_first_simplex(const abacus_header &header, Sequences &sequences) {
    std::array<Point<D>, D + 1> points;
    Corners<D> corners;
    for (int i = 0; i <= D; ++i) corners[i] = &points[i];
    int n = 0;
    VertexReader<D> reader(host_, attributes_, 0, header.points);
    while (reader.advance()) {
        const Point<D> p = reader.point();
        if (!is_independent(corners, n, p)) continue;
        points[n] = p;
        sequences[n++] = reader.sequence();
        if (n == D + 1) return true;
    }
    return false;
}

template <int D> void Build<D>::start(const Sequences &sequences) {
    std::array<VertexIndex, D + 1> vertices;
    for (int i = 0; i <= D; ++i) {
        VertexReader<D> reader(host_, attributes_, sequences[i], sequences[i] + 1);
        reader.advance();
        reader.attributes(values_.data());
        vertices[i] = cache_.create_vertex(reader.point(), reader.id(), values_.data());
    }
    insertion_.start(vertices);
}

template <int D>
void Build<D>::report(abacus_phase phase, std::uint64_t done, std::uint64_t total) {
    host_.progress({phase, done, total, cache_.counters.loads, cache_.counters.stores});
}

template <int D> void Build<D>::run(std::uint64_t limit, abacus_header &header) {
    cache_.counters = {};
    {
        const Stopwatch stopwatch(cache_.counters.total_ns);
        Sequences first;
        if (!find_first_simplex(header, first)) return;
        if (header.vertices == 0) {
            start(first);
            header.vertices = D + 1;
        }
        const std::uint64_t from = header.inserted;
        // The first simplex is in the mesh from the start: so its points are counted in.
        const std::uint64_t to =
            limit == 0 ? header.points
                       : std::min(header.points, std::max(from + limit, first[D] + 1));
        VertexReader<D> reader(host_, attributes_, from, to);
        report(ABACUS_PHASE_INSERTING, 0, to - from);
        while (reader.advance()) {
            const std::uint64_t done = reader.sequence() - from;
            if (done % 256 == 0) host_.poll();
            if (done % report_every == 0) report(ABACUS_PHASE_INSERTING, done, to - from);
            if (std::find(first.begin(), first.end(), reader.sequence()) != first.end()) continue;
            reader.attributes(values_.data());
            if (insertion_.insert(reader.point(), reader.id(), values_.data())) ++header.vertices;
            else ++header.duplicates;
        }
        report(ABACUS_PHASE_FLUSHING, to - from, to - from);
        cache_.flush();
        header.inserted = to;
    }
    header.simplices = static_cast<std::uint64_t>(mesh_.simplices());
    header.ghosts = static_cast<std::uint64_t>(mesh_.ghosts());
    add_counters(header.counters, cache_.counters);
}

void add_counters(abacus_counters &sum, const abacus_counters &more) {
    const std::uint64_t peak = std::max(sum.peak_bytes, more.peak_bytes);
    // Fields of one type without gaps.
    auto *to = reinterpret_cast<std::uint64_t *>(&sum);
    const auto *from = reinterpret_cast<const std::uint64_t *>(&more);
    for (std::size_t i = 0; i < sizeof sum / sizeof *to; ++i) to[i] += from[i];
    sum.peak_bytes = peak;
}

template class Build<2>;
template class Build<3>;

} // namespace abacus
