#include "change/build.hpp"

#include "blocks/counters.hpp"
#include "change/attribute_change.hpp"
#include "change/crowding.hpp"
#include "change/listed_revision.hpp"
#include "change/revision.hpp"
#include "host/stopwatch.hpp"

namespace abacus {

namespace {
// A mesh of so many vertices is keyed anew whatever comes; a larger one only for points that
// are this share of it: otherwise a single one would have to wait for all of a large mesh.
constexpr std::uint64_t rekeyed_at_once = 1 << 16, rekeyed_by_share = 64;

bool is_worth_rekeying(std::uint64_t vertices, std::uint64_t coming) {
    return vertices <= rekeyed_at_once || vertices / rekeyed_by_share <= coming;
}
} // namespace

template <int D>
template <class Change>
void Build<D>::change(abacus_header &header, Change change) {
    work_.counters() = {};
    work_.core->cache.expect_last_pass(false);
    work_.facts = &header.facts;
    std::uint64_t time = 0;
    try {
        const Stopwatch stopwatch(time);
        const std::uint64_t done = change();
        work_.report(ABACUS_PHASE_FLUSHING, done, done);
        work_.flush();
        labels_.follow();
    } catch (...) {
        gathering_.stop();
        throw;
    }
    header.facts.census.simplices = static_cast<std::uint64_t>(work_.core->mesh.simplices());
    header.facts.census.ghosts = static_cast<std::uint64_t>(work_.core->mesh.ghosts());
    work_.counters().total_ns = time;
    header.counters += work_.counters();
}

template <int D>
template <class Change>
bool Build<D>::sound_change(abacus_header &header, Change change_it) {
    bool is_sound = true;
    change(header, [&] {
        is_sound = change_it();
        return std::uint64_t{0};
    });
    return is_sound;
}

template <int D> void Build<D>::settle(abacus_header &header) {
    labels_.settle();
    change(header, [] { return std::uint64_t{0}; });
}

template <int D> void Build<D>::run(std::uint64_t limit, abacus_header &header) {
    change(header, [&] {
        const std::uint64_t before = header.facts.census.inserted;
        inserting_.insert_waiting(limit);
        return header.facts.census.inserted - before;
    });
}

/// Points whose attributes will be read must have as many.
template <int D>
void Build<D>::check_attributes(const Stage<D> &stage, std::size_t attributes) const {
    if (!stage.has_attributes(static_cast<unsigned>(attributes)))
        throw Error(ABACUS_ERROR_ARGUMENT, "the points do not have the attributes of the mesh", {},
                    {});
}

template <int D>
void Build<D>::insert(Stage<D> &stage, abacus_on_duplicate on_duplicate, abacus_header &header) {
    check_attributes(stage, work_.attributes);
    change(header, [&] {
        const std::uint64_t points = stage.points();
        if (is_worth_rekeying(header.facts.census.vertices, points) &&
            rekeying_.has_outgrown_domain(points))
            rekeying_.change_domain(stage.spread(), stage.memory());
        inserting_.insert_waiting(0);
        inserting_.insert(stage, on_duplicate);
        inserting_.insert_waiting(0); // if they had to be staged after all
        return points;
    });
}

template <int D>
std::uint64_t Build<D>::remove(Stage<D> &stage, bool exactly, abacus_header &header) {
    if (exactly) check_attributes(stage, work_.attributes);
    std::uint64_t taken = 0;
    change(header, [&] {
        const std::uint64_t points = stage.points();
        inserting_.insert_waiting(0);
        taken = deleting_.remove(stage, exactly);
        return points;
    });
    return taken;
}

template <int D>
std::uint64_t Build<D>::update(Stage<D> &stage, std::span<const std::uint32_t> which, bool exactly,
                               abacus_header &header, abacus_named_place &missing) {
    check_attributes(stage, which.size() + (exactly ? work_.attributes : 0));
    std::uint64_t changed = 0;
    change(header, [&] {
        const std::uint64_t points = stage.points();
        const bool keeps = !work_.has_waiting() && labels_.follows_all();
        inserting_.insert_waiting(0);
        const auto revise = [&](auto revision) {
            abacus_facts ordered = header.facts; // which may have no domain, if it has no points
            stage.end(ordered);
            stage.emit(revision, ordered);
            changed = revision.changed();
            if (!revision.missing()) return;
            missing.id = record_id(revision.missing()->data());
            const Point<D> p = record_point<D>(revision.missing()->data());
            std::copy(p.begin(), p.end(), missing.point);
        };
        if (work_.lists_vertices())
            revise(ListedRevision<D>(work_, which));
        else
            revise(Revision<D>(work_, which, exactly));
        if (keeps) {
            work_.core->cache.flush();
            labels_.keep_all();
        }
        return points;
    });
    return changed;
}

template <int D>
void Build<D>::change_attributes(std::span<const std::uint32_t> source, std::size_t memory,
                                 abacus_header &header) {
    const auto count = static_cast<std::uint32_t>(source.size());
    abacus_columns &columns = header.facts.columns;
    const bool was_apart = columns.apart != 0;
    const bool will_be_apart = // apart they are found by place, which split nodes share
        count > 0 && header.facts.census.split == 0 &&
        (was_apart || abacus_are_apart(header.facts.form.dimension, count) != 0);
    change(header, [&] {
        AttributeChange<D>(work_, source, memory).change(was_apart, will_be_apart);
        columns.attributes = count;
        columns.apart = will_be_apart;
        work_.forget_cache();
        labels_.keep_all();
        return header.facts.census.vertices;
    });
}

template <int D> std::uint64_t Build<D>::clear(abacus_header &header) {
    std::uint64_t points = 0;
    change(header, [&] {
        points = deleting_.clear();
        return points;
    });
    return points;
}

template <int D> void Build<D>::fix(Segments &segments, abacus_header &header) {
    change(header, [&] {
        inserting_.insert_waiting(0);
        header.facts.standing = ABACUS_CONSTRAINED;
        header.facts.census.lines_wait = 0;
        return constraining_.fix(segments);
    });
}

template <int D>
bool Build<D>::unfix(Segments &segments, abacus_region_fault &fault, abacus_header &header) {
    return sound_change(header, [&] {
        inserting_.insert_waiting(0);
        return constraining_.unfix(segments, fault);
    });
}

template <int D> void Build<D>::restore(Segments &edges, abacus_header &header) {
    change(header, [&] { return constraining_.restore(edges); });
}

template <int D>
bool Build<D>::fill_regions(RegionParts &parts, const Regions::Report &report,
                            abacus_region_fault &fault, abacus_header &header) {
    return sound_change(header, [&] { return constraining_.fill_regions(parts, report, fault); });
}

template <int D> void Build<D>::clear_regions(RegionParts &parts, abacus_header &header) {
    change(header, [&] {
        constraining_.clear_regions(parts);
        return std::uint64_t{0};
    });
}

template <int D>
bool Build<D>::cut_regions(Segments &segments, RegionParts &parts, abacus_region_fault &fault,
                           abacus_header &header) {
    return sound_change(header, [&] { return constraining_.cut_regions(segments, parts, fault); });
}

template <int D> bool Build<D>::rekey(std::size_t memory, abacus_header &header) {
    work_.facts = &header.facts;
    if (!rekeying_.has_outgrown_domain(0) && !looks_crowded<D>(work_.host, header.facts))
        return false;
    bool is_changed = false;
    change(header, [&] {
        const abacus_census &census = header.facts.census;
        const std::uint64_t points = census.vertices + census.duplicates;
        is_changed = rekeying_.change_domain(Spread<D>(work_.host), memory);
        return points;
    });
    return is_changed;
}

template class Build<2>;
template class Build<3>;

} // namespace abacus
