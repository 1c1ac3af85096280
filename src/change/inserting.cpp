#include "change/inserting.hpp"

#include "change/distinct.hpp"
#include "change/intake.hpp"
#include "points/vertex_reader.hpp"
#include "staging/rounds.hpp"

#include <algorithm>

namespace abacus {

namespace {
constexpr std::uint64_t report_every = 4096; // points: some hundred times a second
} // namespace

template <int D> void Inserting<D>::begin(std::uint64_t points) {
    gathering_.begin(*this, points, work_.record_size());
}

template <int D> void Inserting<D>::start(const std::array<const std::uint64_t *, D + 1> &records) {
    std::array<VertexIndex, D + 1> vertices;
    for (int i = 0; i <= D; ++i) vertices[i] = work_.create(records[i]);
    work_.start(vertices);
}

template <int D> void Inserting<D>::add(const std::uint64_t *records, std::size_t n) {
    work_.with_codes(records, n, work_.record_size(),
                     [&](const std::uint64_t *some, const std::uint64_t *codes, std::size_t count) {
                         add(some, codes, count);
                     });
}

template <int D>
void Inserting<D>::add(const std::uint64_t *records, const std::uint64_t *codes, std::size_t n) {
    const std::size_t stride = work_.record_size();
    if (work_.apart) store_attributes(records, codes, n);
    if (gathering_.gathers()) return gathering_.gather(records, stride, codes, n);
    for (std::size_t some; n > 0; records += some * stride, codes += some, n -= some) {
        some = std::min(n, Workspace<D>::most_at_once);
        take(records, codes, some);
    }
}

/// Of points that will be vertices, unless they meet one.
template <int D>
void Inserting<D>::store_attributes(const std::uint64_t *records, const std::uint64_t *codes,
                                    std::size_t n) {
    for (std::size_t i = 0; i < n; ++i, records += work_.record_size()) {
        const Point<D> p = record_point<D>(records);
        if (on_duplicate_ == ABACUS_REPLACE)
            work_.apart->put(p, codes[i], record_attributes<D>(records));
        else
            work_.apart->put_new(p, codes[i], record_attributes<D>(records));
    }
}

/// Not so many that they may be of several rounds.
template <int D>
void Inserting<D>::take(const std::uint64_t *records, const std::uint64_t *codes, std::size_t n) {
    const std::size_t stride = work_.record_size();
    typename Workspace<D>::Core &core = *work_.core;
    core.cache.expect_last_pass(
        !Rounds<D>::is_promoted(record_point<D>(records + (n - 1) * stride)));
    for (std::size_t i = 0; i < n; ++i, records += stride) {
        if (core.insertion.insert(record_point<D>(records), codes[i], record_id(records),
                                  record_attributes<D>(records))) {
            ++work_.facts->census.vertices;
            if (counts_crowded_) count_crowded();
        } else {
            add_duplicate(records);
        }
    }
}

template <int D> void Inserting<D>::add_duplicate(const std::uint64_t *record) {
    abacus_census &census = work_.facts->census;
    const Point<D> p = record_point<D>(record);
    switch (on_duplicate_) {
    case ABACUS_KEEP:
        work_.repeated->add(census.serials++, record);
        ++census.duplicates;
        return;
    case ABACUS_REPLACE:
        if (census.duplicates > 0) work_.forget_repeated(p);
        // Attributes that are apart have been stored when the point came.
        work_.core->removal.rename(p, record_id(record), record_attributes<D>(record));
        return;
    case ABACUS_REFUSE:
        throw_duplicate(record_id(record));
    }
}

template <int D> bool Inserting<D>::start_waiting(FirstSimplex<D> &first) {
    const abacus_census &census = work_.facts->census;
    VertexReader<D> reader(work_.host, work_.attributes, census.inserted, census.staged);
    while (!first.is_complete() && reader.advance()) first.offer(reader.point(), reader.sequence());
    if (!first.is_complete()) return false;
    std::array<AnyRecord<D>, D + 1> corners;
    std::array<const std::uint64_t *, D + 1> records;
    for (int i = 0; i <= D; ++i) {
        VertexReader<D> corner(work_.host, work_.attributes, first.number(i), first.number(i) + 1);
        if (!corner.advance()) throw_corrupted("A vertex page is missing.");
        std::copy_n(corner.record(), work_.record_size(), corners[i].data());
        records[i] = corners[i].data();
    }
    start(records);
    return true;
}

template <int D> void Inserting<D>::insert_waiting(std::uint64_t limit) {
    if (!work_.has_waiting()) return;
    abacus_census &census = work_.facts->census;
    const std::uint64_t from = census.inserted;
    std::uint64_t to = limit == 0 ? census.staged : std::min(census.staged, from + limit);
    FirstSimplex<D> first;
    if (!work_.has_simplices()) {
        if (!start_waiting(first)) return;
        to = std::max(to, first.number(D) + 1); // its points are in the mesh from the start
    }
    VertexReader<D> reader(work_.host, work_.attributes, from, to, true);
    begin(to - from);
    work_.report(ABACUS_PHASE_INSERTING, 0, to - from);
    while (reader.advance()) {
        const std::uint64_t read = reader.sequence() - from;
        if (read % 256 == 0) work_.host.poll();
        if (read % report_every == 0)
            work_.report(ABACUS_PHASE_INSERTING, read - held_back(), to - from);
        if (!first.contains(reader.sequence())) add(reader.record(), 1);
    }
    finish();
    census.inserted = to;
}

template <int D> void Inserting<D>::insert_stage(Stage<D> &stage) {
    Intake<D> intake(*this, stage.points());
    stage.emit(intake, *work_.facts);
}

template <int D> void Inserting<D>::insert_distinct(Stage<D> &stage, bool refuses) {
    Stage<D> distinct(work_.host, *work_.facts, stage.memory());
    Distinct<D> filter(work_, distinct, refuses);
    stage.emit(filter, *work_.facts);
    insert_stage(distinct);
}

template <int D> void Inserting<D>::insert(Stage<D> &stage, abacus_on_duplicate on_duplicate) {
    counts_crowded_ = work_.has_simplices();
    if (on_duplicate == ABACUS_KEEP || work_.has_simplices()) {
        on_duplicate_ = on_duplicate;
        insert_stage(stage);
        on_duplicate_ = ABACUS_KEEP;
    } else {
        insert_distinct(stage, on_duplicate == ABACUS_REFUSE);
    }
    counts_crowded_ = false;
}

template class Inserting<2>;
template class Inserting<3>;

} // namespace abacus
