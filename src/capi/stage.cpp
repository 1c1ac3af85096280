// Staging behind the C interface.
#include "capi/stage.hpp"

#include "capi/dispatch.hpp"
#include "capi/editable.hpp"
#include "capi/handle.hpp"

abacus_status abacus_stage_open(const abacus_host *host, const abacus_facts *facts, size_t memory,
                                abacus_stage **stage, abacus_error *error) {
    return abacus::guard(error, [&] {
        abacus::require_editable(*facts);
        *stage = abacus::create_handle<abacus_stage>(host, *facts, memory);
        return ABACUS_OK;
    });
}

abacus_status abacus_stage_add(abacus_stage *stage, const uint64_t *points, size_t count,
                               abacus_error *error) {
    return abacus::dispatch(stage->stage, error,
                            [&](auto &staging) { staging.add(points, count); });
}

abacus_status abacus_stage_end(abacus_stage *stage, abacus_facts *facts, abacus_error *error) {
    return abacus::dispatch(stage->stage, error, [&](auto &staging) { staging.end(*facts); });
}

abacus_status abacus_stage_finish(abacus_stage *stage, abacus_facts *facts, abacus_error *error) {
    return abacus::dispatch(stage->stage, error, [&](auto &staging) {
        abacus_facts changed = *facts; // the caller's stays as it is if staging fails
        staging.finish(changed);
        *facts = changed;
    });
}

void abacus_stage_close(abacus_stage *stage) { abacus::destroy_handle(stage); }
