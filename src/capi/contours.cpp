// Contours behind the C interface.
#include "query/levels/contours.hpp"

#include "capi/guard.hpp"

abacus_status abacus_contours(const abacus_host *host, const abacus_facts *facts,
                              const abacus_window *window, const abacus_contouring *contouring,
                              size_t memory, abacus_contour_report report, void *context,
                              abacus_error *error) {
    return abacus::guard(error, [&] {
        const abacus::Host table(*host);
        abacus::Contours(table, *facts, *window, *contouring, memory).each(report, context);
        return ABACUS_OK;
    });
}
