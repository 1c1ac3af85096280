// How well a mesh's domain fits, behind the C interface.
#include "delaunay/crowding.hpp"
#include "keys/domain_of.hpp"

#include "capi/guard.hpp"

#include <abacus/check.h>

abacus_status abacus_domain_fits(const abacus_host *host, const abacus_header *header, int *fits,
                                 abacus_error *error) {
    return abacus::guard(error, [&] {
        const abacus::Host core_host(*host);
        const std::uint64_t waiting = header->staged - header->inserted;
        const std::uint64_t points = header->vertices + header->duplicates + waiting;
        *fits = !abacus::has_outgrown_domain(header->outside, points) &&
                !(header->dimension == 2 ? abacus::looks_crowded<2>(core_host, *header)
                                         : abacus::looks_crowded<3>(core_host, *header));
        return ABACUS_OK;
    });
}
