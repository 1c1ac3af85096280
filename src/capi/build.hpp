// The build behind the C interface, for the functions that take one.
#pragma once

#include "capi/dimension.hpp"
#include "capi/editable.hpp"
#include "capi/guard.hpp"
#include "change/build.hpp"
#include "delaunay/line_source.hpp"

#include <abacus/build.h>

#include <optional>

namespace abacus {

/// The lines that the host keeps.
class HostLines final : public LineSource {
public:
    HostLines(abacus_segments_at at, void *context) : at_(at), context_(context) {}

    std::span<const abacus_segment_end> at(const Point<2> &p) override {
        const abacus_segment_end *ends = nullptr;
        std::size_t count = 0;
        if (at_(context_, p.data(), &ends, &count) != ABACUS_HOST_OK) throw HostFailure{};
        return {ends, count};
    }

private:
    abacus_segments_at at_;
    void *context_;
};

} // namespace abacus

struct abacus_build {
    abacus_build(const abacus_host *table, const abacus_facts &facts, std::size_t cache_bytes)
        : stored(abacus::Host(*table)), host(*table, watch(facts)), alone(*table),
          build(host, facts, cache_bytes, watch(facts)) {
        alone.threads = 1;
        alone.tiny_intervals = 0;
    }

    /// The stored pages, if simplices have labels or markers that change with them.
    abacus::StoredPages *watch(const abacus_facts &facts) {
        return facts.census.labelled > 0 || facts.census.marked > 0 ? &stored : nullptr;
    }

    abacus::StoredPages stored;
    const abacus::Host host;
    std::optional<abacus::HostLines> lines;
    // For sorts with one thread (simplex_changes.hpp).
    abacus_host alone;
    std::optional<abacus::Host> lone_host;
    abacus::ByDimension<abacus::Build> build;
    // Destroyed before the build: what a thread has handed over is in the memory of its crew.
    std::optional<abacus::ByDimension<abacus::SimplexChanges>> changes;
};

namespace abacus {

/// Runs change(build, header), which leaves all simplices as they are, on the build of either
/// dimension.
template <class Change>
abacus_status run_change_of_values(abacus_build *build, abacus_header *header, abacus_error *error,
                                   Change change) noexcept {
    return guard(error, [&] {
        abacus_header changed = *header; // the caller's stays as it is if the change fails
        build->build.visit([&](auto &opened) { change(opened, changed); });
        *header = changed;
        return ABACUS_OK;
    });
}

/// The same for a change that may create and remove simplices.
template <class Change>
abacus_status run_change(abacus_build *build, abacus_header *header, abacus_error *error,
                         Change change) noexcept {
    return run_change_of_values(build, header, error, [&](auto &opened, abacus_header &changed) {
        require_editable(changed.facts);
        change(opened, changed);
    });
}

/// The same for a change that returns whether regions can be as they must; ABACUS_END if not.
template <class Change>
abacus_status run_sound_change(abacus_build *build, abacus_header *header, abacus_error *error,
                               Change change) noexcept {
    bool is_sound = true;
    const abacus_status status =
        run_change(build, header, error, [&](auto &opened, abacus_header &changed) {
            is_sound = change(opened, changed);
        });
    return status == ABACUS_OK && !is_sound ? ABACUS_END : status;
}

} // namespace abacus
