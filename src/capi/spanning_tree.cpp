// The minimum spanning tree behind the C interface.
#include "query/shapes/spanning_tree.hpp"

#include "capi/guard.hpp"

#include <abacus/shapes.h>

abacus_status abacus_spanning_tree(const abacus_host *table, const abacus_facts *facts,
                                   std::size_t memory, std::size_t cache_bytes,
                                   abacus_edge_report report, void *context, abacus_error *error) {
    return abacus::guard(error, [&] {
        const abacus::Host host(*table);
        const auto pass_on = [&](const std::int64_t *ids, double length) {
            const abacus_edge edge{{ids[0], ids[1]}, length};
            abacus::host::require(report(context, &edge));
        };
        if (facts->form.dimension == 2)
            abacus::SpanningTree<2>(host, *facts, memory, cache_bytes, pass_on);
        else
            abacus::SpanningTree<3>(host, *facts, memory, cache_bytes, pass_on);
        return ABACUS_OK;
    });
}
