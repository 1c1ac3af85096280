#include "delaunay/build.hpp"

#include "cache/domain_of.hpp"
#include "cache/stopwatch.hpp"
#include "delaunay/intake.hpp"

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
      insertion_(host_, cache_, static_cast<std::int64_t>(header.simplices),
                 static_cast<std::int64_t>(header.ghosts)),
      repeated_(host_, cache_.domain(), header.attributes) {}

template <int D> VertexIndex Build<D>::create(const std::uint64_t *record) {
    return cache_.create_vertex(record_point<D>(record), record_id(record),
                                record_attributes<D>(record));
}

template <int D> void Build<D>::start(const std::array<VertexIndex, D + 1> &vertices) {
    insertion_.start(vertices);
    header_->vertices = D + 1;
}

template <int D> void Build<D>::add(const std::uint64_t *record) {
    if (insertion_.insert(record_point<D>(record), record_id(record),
                          record_attributes<D>(record))) {
        ++header_->vertices;
    } else {
        repeated_.add(header_->serials++, record);
        ++header_->duplicates;
    }
}

template <int D> void Build<D>::insert_waiting(std::uint64_t limit) {
    if (!has_waiting()) return;
    const std::uint64_t from = header_->inserted;
    std::uint64_t to = limit == 0 ? header_->staged : std::min(header_->staged, from + limit);
    FirstSimplex<D> first;
    if (!has_simplices()) {
        VertexReader<D> reader(host_, attributes_, from, header_->staged);
        while (!first.is_complete() && reader.advance())
            first.offer(reader.point(), reader.sequence());
        if (!first.is_complete()) return;
        to = std::max(to, first.number(D) + 1); // its points are in the mesh from the start
        std::array<VertexIndex, D + 1> vertices;
        for (int i = 0; i <= D; ++i) {
            VertexReader<D> corner(host_, attributes_, first.number(i), first.number(i) + 1);
            corner.advance();
            vertices[i] = create(corner.record());
        }
        start(vertices);
    }
    VertexReader<D> reader(host_, attributes_, from, to, true);
    report(ABACUS_PHASE_INSERTING, 0, to - from);
    while (reader.advance()) {
        const std::uint64_t done = reader.sequence() - from;
        if (done % 256 == 0) host_.poll();
        if (done % report_every == 0) report(ABACUS_PHASE_INSERTING, done, to - from);
        if (!first.contains(reader.sequence())) add(reader.record());
    }
    header_->inserted = to;
}

template <int D>
template <class Change>
void Build<D>::change(abacus_header &header, Change change) {
    cache_.counters = {};
    header_ = &header;
    {
        const Stopwatch stopwatch(cache_.counters.total_ns);
        const std::uint64_t done = change();
        report(ABACUS_PHASE_FLUSHING, done, done);
        cache_.flush();
        repeated_.flush();
    }
    header.simplices = static_cast<std::uint64_t>(insertion_.simplices());
    header.ghosts = static_cast<std::uint64_t>(insertion_.ghosts());
    add_counters(header.counters, cache_.counters);
}

template <int D> void Build<D>::run(std::uint64_t limit, abacus_header &header) {
    change(header, [&] {
        const std::uint64_t before = header.inserted;
        insert_waiting(limit);
        return header.inserted - before;
    });
}

template <int D> void Build<D>::insert(Stage<D> &stage, abacus_header &header) {
    change(header, [&] {
        const std::uint64_t points = stage.points();
        insert_waiting(0);
        Intake intake(*this);
        stage.emit(intake, header);
        insert_waiting(0); // if they had to be staged after all
        return points;
    });
}

template <int D>
void Build<D>::report(abacus_phase phase, std::uint64_t done, std::uint64_t total) {
    host_.progress({phase, done, total, cache_.counters.loads, cache_.counters.stores});
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
