// Building behind the C interface.
#include "delaunay/build.hpp"

#include "capi/dimension.hpp"
#include "capi/editable.hpp"
#include "capi/guard.hpp"
#include "capi/handle.hpp"
#include "capi/stage.hpp"

#include <abacus/change.h>

struct abacus_build {
    abacus_build(const abacus_host *table, const abacus_header &header, std::size_t cache_bytes)
        : stored(abacus::Host(*table)), host(*table, watch(header)),
          build(host, header, cache_bytes, watch(header)) {}

    /// Where something may go with a simplex.
    abacus::StoredPages *watch(const abacus_header &header) {
        return header.labelled > 0 || header.marked > 0 ? &stored : nullptr;
    }

    abacus::StoredPages stored;
    const abacus::Host host;
    abacus::ByDimension<abacus::Build> build;
};

abacus_status abacus_build_open(const abacus_host *host, const abacus_header *header,
                                size_t cache_bytes, abacus_build **build, abacus_error *error) {
    return abacus::guard(error, [&] {
        abacus::require_editable(*header);
        *build = abacus::create_handle<abacus_build>(host, *header, cache_bytes);
        return ABACUS_OK;
    });
}

namespace {

/// Runs change(build, header) on the build of whatever dimension.
template <class Change>
abacus_status run(abacus_build *build, abacus_header *header, abacus_error *error,
                  Change change) noexcept {
    return abacus::guard(error, [&] {
        abacus_header changed = *header; // the caller's stays as it is if the change fails
        build->build.visit([&](auto &opened) { change(opened, changed); });
        *header = changed;
        return ABACUS_OK;
    });
}

template <int D> abacus::Stage<D> &stage_for(const abacus::Build<D> &, abacus_stage *stage) {
    return stage->stage.get<D>();
}

} // namespace

abacus_status abacus_build_run(abacus_build *build, uint64_t limit, abacus_header *header,
                               abacus_error *error) {
    return run(build, header, error,
               [&](auto &opened, abacus_header &changed) { opened.run(limit, changed); });
}

abacus_status abacus_build_insert(abacus_build *build, abacus_stage *stage,
                                  abacus_on_duplicate on_duplicate, abacus_header *header,
                                  abacus_error *error) {
    return run(build, header, error, [&](auto &opened, abacus_header &changed) {
        opened.insert(stage_for(opened, stage), on_duplicate, changed);
    });
}

abacus_status abacus_build_delete(abacus_build *build, abacus_stage *stage, int exactly,
                                  abacus_header *header, uint64_t *deleted, abacus_error *error) {
    return run(build, header, error, [&](auto &opened, abacus_header &changed) {
        *deleted = opened.remove(stage_for(opened, stage), exactly != 0, changed);
    });
}

abacus_status abacus_build_update(abacus_build *build, abacus_stage *stage,
                                  const uint32_t *attributes, size_t count, abacus_header *header,
                                  uint64_t *updated, abacus_named_place *missing,
                                  abacus_error *error) {
    return run(build, header, error, [&](auto &opened, abacus_header &changed) {
        *updated = opened.update(stage_for(opened, stage), {attributes, count}, changed, *missing);
    });
}

abacus_status abacus_build_clear(abacus_build *build, abacus_header *header, uint64_t *deleted,
                                 abacus_error *error) {
    return run(build, header, error,
               [&](auto &opened, abacus_header &changed) { *deleted = opened.clear(changed); });
}

abacus_status abacus_build_rekey(abacus_build *build, size_t memory, abacus_header *header,
                                 int *done, abacus_error *error) {
    return run(build, header, error, [&](auto &opened, abacus_header &changed) {
        *done = opened.rekey(memory, changed);
    });
}

void abacus_build_close(abacus_build *build) { abacus::destroy_handle(build); }
