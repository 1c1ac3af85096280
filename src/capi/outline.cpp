// Hulls and closer outlines behind the C interface.
#include "query/shapes/outline.hpp"

#include "geometry/predicates.hpp"

#include "capi/dimension.hpp"
#include "capi/guard.hpp"

abacus_status abacus_outline(const abacus_host *table, const abacus_facts *facts,
                             const abacus_outline_kind *kind, std::size_t memory,
                             std::size_t cache_bytes, abacus_outline_report report, void *context,
                             abacus_error *error) {
    return abacus::guard(error, [&] {
        const abacus::Host host(*table);
        abacus::ByDimension<abacus::Outline> outline(host, *facts, *kind, memory, cache_bytes);
        outline.visit([&](auto &rings) {
            abacus_outline_row row;
            while (rings.next(row)) abacus::host::require(report(context, &row));
            rings.close();
        });
        return ABACUS_OK;
    });
}

abacus_status abacus_orientation(const double *a, const double *b, const double *c, int *side,
                                 abacus_error *error) {
    return abacus::guard(error, [&] {
        const auto point = [](const double *from) { return abacus::Point<2>{from[0], from[1]}; };
        *side = abacus::orientation(point(a), point(b), point(c));
        return ABACUS_OK;
    });
}
