// How well a mesh's domain fits, behind the C interface.
#include "change/crowding.hpp"
#include "keys/domain_of.hpp"

#include "capi/guard.hpp"

#include <abacus/check.h>

abacus_status abacus_domain_fits(const abacus_host *host, const abacus_facts *facts, int *fits,
                                 abacus_error *error) {
    return abacus::guard(error, [&] {
        const abacus::Host core_host(*host);
        const std::uint64_t waiting = facts->census.staged - facts->census.inserted;
        const std::uint64_t points = facts->census.vertices + facts->census.duplicates + waiting;
        *fits = !abacus::has_outgrown_domain(facts->census.outside, points) &&
                !(facts->form.dimension == 2 ? abacus::looks_crowded<2>(core_host, *facts)
                                             : abacus::looks_crowded<3>(core_host, *facts));
        return ABACUS_OK;
    });
}
