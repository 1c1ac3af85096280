// Staging behind the C interface.
#include "capi/stage.hpp"

#include "capi/dispatch.hpp"
#include "capi/editable.hpp"
#include "capi/handle.hpp"

abacus_status abacus_stage_open(const abacus_host *host, const abacus_header *header, size_t memory,
                                abacus_stage **stage, abacus_error *error) {
    return abacus::guard(error, [&] {
        abacus::require_editable(*header);
        *stage = abacus::create_handle<abacus_stage>(host, *header, memory);
        return ABACUS_OK;
    });
}

abacus_status abacus_stage_add(abacus_stage *stage, const uint64_t *points, size_t count,
                               abacus_error *error) {
    return abacus::dispatch(stage->stage, error,
                            [&](auto &staging) { staging.add(points, count); });
}

abacus_status abacus_stage_end(abacus_stage *stage, abacus_header *header, abacus_error *error) {
    return abacus::dispatch(stage->stage, error, [&](auto &staging) { staging.end(*header); });
}

abacus_status abacus_stage_finish(abacus_stage *stage, abacus_header *header, abacus_error *error) {
    return abacus::dispatch(stage->stage, error, [&](auto &staging) {
        abacus_header changed = *header; // the caller's stays as it is if staging fails
        staging.finish(changed);
        *header = changed;
    });
}

void abacus_stage_close(abacus_stage *stage) { abacus::destroy_handle(stage); }
