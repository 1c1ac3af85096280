// Thinning behind the C interface.
#include "thin/thinning.hpp"

#include "capi/dispatch.hpp"
#include "capi/editable.hpp"
#include "capi/handle.hpp"
#include "capi/stage.hpp"

struct abacus_thinning {
    abacus_thinning(const abacus_host *table, const abacus_facts &facts,
                    const abacus_thin_options &options)
        : host(*table), thinning(host, facts, options) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::Thinning> thinning;
};

abacus_status abacus_thin_open(const abacus_host *host, const abacus_facts *facts,
                               const abacus_thin_options *options, abacus_thinning **thinning,
                               abacus_error *error) {
    return abacus::guard(error, [&] {
        if (options->attribute >= facts->columns.attributes)
            throw abacus::Error(ABACUS_ERROR_ARGUMENT, "the mesh has no such attribute");
        *thinning = abacus::create_handle<abacus_thinning>(host, *facts, *options);
        return ABACUS_OK;
    });
}

abacus_status abacus_thin_find(abacus_thinning *thinning, abacus_thin_step step,
                               const abacus_host *source, const abacus_facts *source_facts,
                               const abacus_facts *facts, abacus_stage *stage, uint64_t *added,
                               abacus_error *error) {
    return abacus::guard(error, [&] {
        abacus::require_editable(*facts);
        const abacus::Host source_host(*source);
        thinning->thinning.visit([&]<int D>(abacus::Thinning<D> &opened) {
            *added = opened.find(step, source_host, *source_facts, *facts, stage->stage.get<D>());
        });
        return ABACUS_OK;
    });
}

abacus_status abacus_thin_inserted(abacus_thinning *thinning, const abacus_facts *facts,
                                   abacus_error *error) {
    return abacus::dispatch(thinning->thinning, error,
                            [&](auto &opened) { opened.inserted(*facts); });
}

abacus_status abacus_thin_greatest(abacus_thinning *thinning, const abacus_host *source,
                                   const abacus_facts *source_facts, const abacus_facts *facts,
                                   double *greatest, uint64_t *without_value, abacus_error *error) {
    return abacus::guard(error, [&] {
        const abacus::Host source_host(*source);
        thinning->thinning.visit([&](auto &opened) {
            const auto found = opened.greatest(source_host, *source_facts, *facts);
            *greatest = found.error;
            *without_value = found.without_value;
        });
        return ABACUS_OK;
    });
}

abacus_status abacus_thin_keep(abacus_thinning *thinning, const int64_t *ids, size_t count,
                               abacus_error *error) {
    return abacus::dispatch(thinning->thinning, error,
                            [&](auto &opened) { opened.set_kept(ids, count); });
}

uint64_t abacus_thin_unknown_ids(const abacus_thinning *thinning) {
    return thinning->thinning.visit([](const auto &opened) { return opened.unknown_ids(); });
}

void abacus_thin_close(abacus_thinning *thinning) { abacus::destroy_handle(thinning); }
