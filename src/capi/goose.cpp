// Goose behind the C interface.
#include "goose/goose.hpp"

#include "keys/domain_of.hpp"

#include "capi/guard.hpp"
#include "capi/stage.hpp"

#include <abacus/goose.h>

namespace {

template <int D>
void run(const abacus::Host &host, const abacus_rtree &rtree, abacus::Stage<D> &stage,
         const abacus_facts &facts, abacus_goose_figures &figures) {
    abacus_facts bounded = facts; // the domain may leave out a few points, goose none
    abacus::set_domain(bounded, stage.spread().box());
    abacus::Goose<D> goose(host, rtree, bounded, figures);
    stage.emit(goose, facts);
}

} // namespace

abacus_status abacus_goose_run(const abacus_host *host, const abacus_rtree *rtree,
                               abacus_stage *stage, const abacus_facts *facts,
                               abacus_goose_figures *figures, abacus_error *error) {
    return abacus::guard(error, [&] {
        const abacus::Host core_host(*host);
        stage->stage.visit([&](auto &points) { run(core_host, *rtree, points, *facts, *figures); });
        return ABACUS_OK;
    });
}
