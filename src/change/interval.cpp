#include "change/interval.hpp"

#include "blocks/counters.hpp"
#include "constrain/fixing.hpp"
#include "constrain/segments.hpp"
#include "keys/domain_of.hpp"
#include "mesh/page_attributes.hpp"
#include "points/record.hpp"
#include "points/repeated_points.hpp"

#include <utility>

namespace abacus {

namespace {
constexpr std::size_t poll_every = 256;     // points
constexpr std::uint64_t told_effort = 1024; // of removals, after which a thread reports it
} // namespace

template <int D> AttributePages<D> *Interval<D>::attributes_apart() {
    if (facts_.columns.apart == 0) return nullptr;
    return &apart_.emplace(host_, cache_.domain(), facts_.columns.attributes);
}

template <int D>
Interval<D>::Interval(const Host &host, const abacus_facts &facts, std::uint64_t first,
                      std::uint64_t last, std::size_t cache_bytes, SimplexChanges<D> *changes)
    : host_(host), facts_(facts),
      cache_(host, domain_of<D>(facts.form), page_attributes(facts.columns),
             CacheOptions{.budget = cache_bytes}),
      mesh_(host, cache_, static_cast<std::int64_t>(facts.census.simplices),
            static_cast<std::int64_t>(facts.census.ghosts)),
      insertion_(mesh_), removal_(mesh_, attributes_apart()) {
    mesh_.is_constrained = facts.standing == ABACUS_CONSTRAINED;
    cache_.keep_within(first, last);
    if (changes != nullptr) mesh_.log = &log_.emplace(*changes, host).log();
}

namespace {

/// Outside of searches, sound pages lead to no other interval.
template <class Change> void within(Change change) {
    try {
        change();
    } catch (const Foreign &) {
        throw_corrupted("A simplex lies in a page that does not own its key.");
    }
}

} // namespace

template <int D>
template <class Change>
void Interval<D>::each(std::size_t from, std::size_t to, std::atomic<std::uint64_t> &done,
                       Change change) {
    std::size_t reported = from;
    within([&] {
        for (std::size_t i = from; i < to; i = change(i)) {
            if (i - reported < poll_every) continue;
            host_.poll();
            done.fetch_add(i - reported, std::memory_order_relaxed);
            reported = i;
        }
    });
    done.fetch_add(to - reported, std::memory_order_relaxed);
}

template <int D> void Interval<D>::finish(Results &results) {
    within([&] { cache_.flush(); });
    if (log_) log_->finish();
    results.simplices += mesh_.simplices() - static_cast<std::int64_t>(facts_.census.simplices);
    results.ghosts += mesh_.ghosts() - static_cast<std::int64_t>(facts_.census.ghosts);
    results.counters += cache_.counters;
    if (apart_) results.counters += apart_->take_counters();
}

template <int D>
void Interval<D>::insert(const Batch &batch, std::size_t from, std::size_t to, bool counts_crowded,
                         std::atomic<std::uint64_t> &done, Results &results) {
    cache_.expect_last_pass(true);
    std::size_t put_off = to; // the last point put off
    each(from, to, done, [&](std::size_t i) {
        if (batch.is_done(i)) return i + 1;
        const std::uint64_t *const record = batch.record(i);
        const Point<D> p = record_point<D>(record);
        Inserted inserted = Inserted::put_off;
        // Equal points have the same code, and other points of a run may lie between them.
        if (put_off == to || batch.code(put_off) != batch.code(i))
            inserted = insertion_.insert_within(p, batch.code(i), record_id(record),
                                                record_attributes<D>(record));
        switch (inserted) {
        case Inserted::as_vertex:
            ++results.vertices;
            if (counts_crowded) results.crowded += mesh_.is_crowded();
            break;
        case Inserted::is_vertex:
            results.left.push_back(i);
            break;
        case Inserted::put_off:
            results.put_off.push_back(put_off = i);
            break;
        }
        return i + 1;
    });
}

template <int D>
void Interval<D>::remove(const Batch &batch, std::size_t from, std::size_t to, const Removing &how,
                         std::atomic<std::uint64_t> &done, Results &results) {
    Leaving leaving(host_, how.want_bytes, how.exactly, facts_.columns.attributes);
    RepeatedPoints<D> repeated(host_, cache_.domain(), facts_.columns.attributes);
    std::uint64_t effort = 0, dealt = 0; // not reported yet
    each(from, to, done, [&](std::size_t i) {
        std::size_t end = i;
        const Point<D> p = record_point<D>(batch.record(i));
        for (leaving.clear(); end < to && record_point<D>(batch.record(end)) == p; ++end)
            if (!leaving.is_full())
                leaving.want(record_id(batch.record(end)), record_attributes<D>(batch.record(end)));
        const auto keep = [&](Arena<std::size_t> &points) {
            for (std::size_t n = i; n < end; ++n) points.push_back(n);
            return end;
        };
        if (how.outlay.is_too_much()) return keep(results.put_off);
        if (leaving.is_full() || (facts_.census.duplicates > 0 && repeated.contains(p)))
            return keep(results.left);
        const std::optional<bool> removed = removal_.remove_within(p, leaving);
        if (!removed) return keep(results.put_off);
        results.vertices -= *removed;
        if (*removed && facts_.columns.apart != 0) results.gone.push_back(i);
        effort += removal_.take_effort();
        dealt += end - i;
        if (effort >= told_effort)
            how.outlay.add(std::exchange(effort, 0), std::exchange(dealt, 0));
        return end;
    });
    if (dealt > 0) how.outlay.add(effort, dealt);
}

template <int D>
void Interval<D>::fix(const Batch &batch, std::size_t from, std::size_t to,
                      std::atomic<std::uint64_t> &done, Results &results) {
    if constexpr (D == 2) {
        Fixing fixing(mesh_);
        each(from, to, done, [&](std::size_t i) {
            if (batch.is_done(i)) return i + 1;
            const Segment segment = record_segment(batch.record(i));
            if (!fixing.fix_within(segment.a, segment.b, segment.how)) results.put_off.push_back(i);
            return i + 1;
        });
    }
}

template class Interval<2>;
template class Interval<3>;

} // namespace abacus
