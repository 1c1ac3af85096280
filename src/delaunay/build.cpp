#include "delaunay/build.hpp"

#include "blocks/counters.hpp"
#include "delaunay/attribute_change.hpp"
#include "delaunay/crowding.hpp"
#include "delaunay/distinct.hpp"
#include "delaunay/intake.hpp"
#include "delaunay/outlet.hpp"
#include "delaunay/revision.hpp"
#include "host/stopwatch.hpp"
#include "keys/domain_of.hpp"
#include "mesh/page_attributes.hpp"
#include "staging/rounds.hpp"

#include <algorithm>

namespace abacus {

namespace {

constexpr std::uint64_t report_every = 4096; // points: some hundred times a second
// A mesh of so many vertices is keyed anew whatever comes; a larger one only for points that
// are this share of it.
constexpr std::uint64_t rekeyed_at_once = 1 << 16, rekeyed_by_share = 64;

} // namespace

template <int D>
Build<D>::Core::Core(const Host &host, const abacus_facts &facts, std::size_t cache_bytes,
                     AttributePages<D> *attributes)
    : cache(host, domain_of<D>(facts.form), page_attributes(facts.columns),
            CacheOptions{.budget = cache_bytes}),
      mesh(host, cache, static_cast<std::int64_t>(facts.census.simplices),
           static_cast<std::int64_t>(facts.census.ghosts)),
      insertion(mesh), removal(mesh, attributes) {}

template <int D>
Build<D>::Build(const Host &host, const abacus_facts &facts, std::size_t cache_bytes,
                StoredPages *stored)
    : host_(host), attributes_(facts.columns.attributes), cache_bytes_(cache_bytes),
      stored_(stored), domain_(domain_of<D>(facts.form)),
      repeated_(std::in_place, host_, domain_, facts.columns.attributes),
      gathered_(host_, record_words(D, facts.columns.attributes)) {
    if (facts.columns.apart != 0) apart_.emplace(host_, domain_, facts.columns.attributes);
    make_core(facts, cache_bytes_);
}

template <int D> void Build<D>::make_core(const abacus_facts &facts, std::size_t cache_bytes) {
    core_.emplace(host_, facts, cache_bytes, apart_ ? &*apart_ : nullptr);
    if (changes_ != nullptr) core_->mesh.log = &changes_->log();
}

template <int D> void Build<D>::log_to(SimplexChanges<D> &changes) {
    changes_ = &changes;
    core_->mesh.log = &changes.log();
}

template <int D> VertexIndex Build<D>::create(const std::uint64_t *record) {
    const Point<D> p = record_point<D>(record);
    if (apart_) apart_->put(p, domain_.code(p), record_attributes<D>(record));
    return core_->cache.create_vertex(p, record_id(record), record_attributes<D>(record));
}

template <int D> void Build<D>::start(const std::array<VertexIndex, D + 1> &vertices) {
    core_->insertion.start(vertices);
    facts_->census.vertices = D + 1;
}

template <int D> void Build<D>::add(const std::uint64_t *records, std::size_t n) {
    const std::size_t stride = record_words(D, attributes_);
    const bool is_shared = gathers();
    with_codes(records, n, stride,
               [&](const std::uint64_t *some, const std::uint64_t *codes, std::size_t count) {
                   if (apart_) store_attributes(some, codes, count);
                   if (!is_shared) return insert_some(some, codes, count);
                   for (std::size_t i = 0; i < count; ++i)
                       gather_one(some + i * stride, stride, codes[i]);
               });
}

template <int D>
void Build<D>::gather(const std::uint64_t *records, std::size_t n, std::size_t stride) {
    with_codes(records, n, stride,
               [&](const std::uint64_t *some, const std::uint64_t *codes, std::size_t count) {
                   for (std::size_t i = 0; i < count; ++i)
                       gather_one(some + i * stride, stride, codes[i]);
               });
}

// Each code is a chain of table look-ups. In a loop of their own many of these run at once.
template <int D>
template <class Take>
void Build<D>::with_codes(const std::uint64_t *records, std::size_t n, std::size_t stride,
                          Take take) const {
    std::array<std::uint64_t, most_at_once> codes;
    while (n > 0) {
        const std::size_t some = std::min(n, codes.size());
        for (std::size_t i = 0; i < some; ++i)
            codes[i] = domain_.code(record_point<D>(records + i * stride));
        take(records, codes.data(), some);
        records += some * stride;
        n -= some;
    }
}

/// Of points that will be vertices, unless they meet one.
template <int D>
void Build<D>::store_attributes(const std::uint64_t *records, const std::uint64_t *codes,
                                std::size_t n) {
    for (std::size_t i = 0; i < n; ++i, records += record_words(D, attributes_)) {
        const Point<D> p = record_point<D>(records);
        if (on_duplicate_ == ABACUS_REPLACE)
            apart_->put(p, codes[i], record_attributes<D>(records));
        else
            apart_->put_new(p, codes[i], record_attributes<D>(records));
    }
}

/// Not so many that they may be of several rounds.
template <int D>
void Build<D>::insert_some(const std::uint64_t *records, const std::uint64_t *codes,
                           std::size_t n) {
    const std::size_t stride = record_words(D, attributes_);
    core_->cache.expect_last_pass(
        !Rounds<D>::is_promoted(record_point<D>(records + (n - 1) * stride)));
    for (std::size_t i = 0; i < n; ++i, records += stride) {
        if (core_->insertion.insert(record_point<D>(records), codes[i], record_id(records),
                                    record_attributes<D>(records))) {
            ++facts_->census.vertices;
            if (counts_crowded_) count_crowded();
        } else {
            add_duplicate(records);
        }
    }
}

template <int D> void Build<D>::add_duplicate(const std::uint64_t *record) {
    const Point<D> p = record_point<D>(record);
    switch (on_duplicate_) {
    case ABACUS_KEEP:
        repeated_->add(facts_->census.serials++, record);
        ++facts_->census.duplicates;
        return;
    case ABACUS_REPLACE:
        if (facts_->census.duplicates > 0) forget_repeated(p);
        // Attributes that are apart have been stored when the point came.
        core_->removal.rename(p, record_id(record), record_attributes<D>(record));
        return;
    case ABACUS_REFUSE:
        throw_duplicate(record_id(record));
    }
}

template <int D> void Build<D>::insert_waiting(std::uint64_t limit) {
    if (!has_waiting()) return;
    const std::uint64_t from = facts_->census.inserted;
    std::uint64_t to =
        limit == 0 ? facts_->census.staged : std::min(facts_->census.staged, from + limit);
    FirstSimplex<D> first;
    if (!has_simplices()) {
        VertexReader<D> reader(host_, attributes_, from, facts_->census.staged);
        while (!first.is_complete() && reader.advance())
            first.offer(reader.point(), reader.sequence());
        if (!first.is_complete()) return;
        to = std::max(to, first.number(D) + 1); // its points are in the mesh from the start
        std::array<VertexIndex, D + 1> vertices;
        for (int i = 0; i <= D; ++i) {
            VertexReader<D> corner(host_, attributes_, first.number(i), first.number(i) + 1);
            if (!corner.advance()) throw_corrupted("A vertex page is missing.");
            vertices[i] = create(corner.record());
        }
        start(vertices);
    }
    VertexReader<D> reader(host_, attributes_, from, to, true);
    begin_to_gather(to - from, record_words(D, attributes_));
    report(ABACUS_PHASE_INSERTING, 0, to - from);
    while (reader.advance()) {
        const std::uint64_t read = reader.sequence() - from;
        if (read % 256 == 0) host_.poll();
        if (read % report_every == 0)
            report(ABACUS_PHASE_INSERTING, read - gathered_.size(), to - from);
        if (!first.contains(reader.sequence())) add(reader.record(), 1);
    }
    change_gathered();
    facts_->census.inserted = to;
}

template <int D>
template <class Change>
void Build<D>::change(abacus_header &header, Change change) {
    core_->cache.counters = {};
    core_->cache.expect_last_pass(false);
    facts_ = &header.facts;
    std::uint64_t time = 0;
    {
        const Stopwatch stopwatch(time);
        const std::uint64_t done = change();
        report(ABACUS_PHASE_FLUSHING, done, done);
        core_->cache.flush();
        repeated_->flush();
        repeated_->forget(); // before the next change others may write the table of its pages anew
        if (apart_) {
            apart_->flush();
            apart_->forget();
            core_->cache.counters += apart_->take_counters();
        }
        if (stored_ != nullptr && !holds_) sweep_labels();
    }
    facts_->census.simplices = static_cast<std::uint64_t>(core_->mesh.simplices());
    facts_->census.ghosts = static_cast<std::uint64_t>(core_->mesh.ghosts());
    core_->cache.counters.total_ns = time;
    header.counters += core_->cache.counters;
}

template <int D> void Build<D>::settle(abacus_header &header) {
    holds_ = false;
    change(header, [] { return std::uint64_t{0}; });
}

template <int D> void Build<D>::run(std::uint64_t limit, abacus_header &header) {
    change(header, [&] {
        const std::uint64_t before = facts_->census.inserted;
        insert_waiting(limit);
        return facts_->census.inserted - before;
    });
}

/// Points whose attributes will be read must have as many.
template <int D> void Build<D>::check_attributes(const Stage<D> &stage, std::size_t attributes) {
    if (!stage.has_attributes(static_cast<unsigned>(attributes)))
        throw Error(ABACUS_ERROR_ARGUMENT, "the points do not have the attributes of the mesh", {},
                    {});
}

template <int D> void Build<D>::take_in(Stage<D> &stage) {
    Intake intake(*this, stage.points());
    stage.emit(intake, *facts_);
}

template <int D> void Build<D>::take_in_distinct(Stage<D> &stage, bool refuses) {
    Stage<D> distinct(host_, *facts_, stage.memory());
    Distinct filter(*this, distinct, refuses);
    stage.emit(filter, *facts_);
    take_in(distinct);
}

template <int D>
void Build<D>::insert(Stage<D> &stage, abacus_on_duplicate on_duplicate, abacus_header &header) {
    check_attributes(stage, attributes_);
    change(header, [&] {
        const std::uint64_t points = stage.points();
        // Not for a few points: a single one would have to wait for all of a large mesh.
        const bool is_worth_it = facts_->census.vertices <= rekeyed_at_once ||
                                 facts_->census.vertices / rekeyed_by_share <= points;
        if (is_worth_it && has_outgrown_domain(points))
            change_domain(stage.spread(), stage.memory());
        insert_waiting(0);
        counts_crowded_ = has_simplices();
        if (on_duplicate == ABACUS_KEEP || has_simplices()) {
            on_duplicate_ = on_duplicate;
            take_in(stage);
            on_duplicate_ = ABACUS_KEEP;
        } else {
            take_in_distinct(stage, on_duplicate == ABACUS_REFUSE);
        }
        counts_crowded_ = false;
        insert_waiting(0); // if they had to be staged after all
        return points;
    });
}

template <int D>
std::uint64_t Build<D>::remove(Stage<D> &stage, bool exactly, abacus_header &header) {
    if (exactly) check_attributes(stage, attributes_);
    std::uint64_t taken = 0;
    change(header, [&] {
        const std::uint64_t points = stage.points();
        insert_waiting(0);
        if (has_simplices() || has_waiting()) {
            Outlet outlet(*this, stage, exactly);
            stage.emit(outlet, *facts_, true);
            taken = outlet.taken();
        }
        if (rest_) triangulate_rest();
        return points;
    });
    return taken;
}

template <int D>
std::uint64_t Build<D>::update(Stage<D> &stage, std::span<const std::uint32_t> which, bool exactly,
                               abacus_header &header, abacus_named_place &missing) {
    check_attributes(stage, which.size() + (exactly ? attributes_ : 0));
    std::uint64_t changed = 0;
    change(header, [&] {
        const std::uint64_t points = stage.points();
        const bool come = has_waiting();
        insert_waiting(0);
        Revision revision(*this, which, exactly);
        abacus_facts ordered = *facts_; // which may have no domain, if it has no points
        stage.end(ordered);
        stage.emit(revision, ordered);
        changed = revision.changed();
        if (revision.missing()) {
            missing.id = record_id(revision.missing()->data());
            const Point<D> p = record_point<D>(revision.missing()->data());
            std::copy(p.begin(), p.end(), missing.point);
        }
        if (stored_ != nullptr && !holds_ && !come) { // with the same simplices as before
            core_->cache.flush();
            stored_->clear();
        }
        return points;
    });
    return changed;
}

template <int D>
void Build<D>::change_attributes(std::span<const std::uint32_t> source, std::size_t memory,
                                 abacus_header &header) {
    const auto count = static_cast<std::uint32_t>(source.size());
    const bool was_apart = header.facts.columns.apart != 0;
    const bool will_be_apart =
        count > 0 && (was_apart || abacus_are_apart(header.facts.form.dimension, count) != 0);
    change(header, [&] {
        Attributes(*this, source, memory).change(was_apart, will_be_apart);
        facts_->columns.attributes = count;
        facts_->columns.apart = will_be_apart;
        forget_cache();
        if (stored_ != nullptr) stored_->clear(); // with the same simplices as before
        return facts_->census.vertices;
    });
}

template <int D> std::uint64_t Build<D>::clear(abacus_header &header) {
    std::uint64_t points = 0;
    change(header, [&] {
        points = facts_->census.vertices + facts_->census.duplicates +
                 (facts_->census.staged - facts_->census.inserted);
        repeated_->forget();
        erase_pages(ABACUS_STAGED_PAGES);
        erase_pages(ABACUS_REPEATED_PAGES);
        facts_->census.inserted = facts_->census.staged;
        forget_simplices();
        return points;
    });
    return points;
}

template <int D> bool Build<D>::rekey(std::size_t memory, abacus_header &header) {
    facts_ = &header.facts;
    if (!has_outgrown_domain(0) && !looks_crowded<D>(host_, *facts_)) return false;
    bool is_changed = false;
    change(header, [&] {
        const std::uint64_t points = facts_->census.vertices + facts_->census.duplicates;
        is_changed = change_domain(Spread<D>(host_), memory);
        return points;
    });
    return is_changed;
}

template <int D>
void Build<D>::report(abacus_phase phase, std::uint64_t done, std::uint64_t total) {
    const abacus_counters &counters = core_->cache.counters;
    host_.progress({phase, done, total, counters.loads, counters.stores, 0});
}

template class Build<2>;
template class Build<3>;

} // namespace abacus
