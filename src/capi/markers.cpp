// Markers of facets behind the C interface.
#include "labels/marking.hpp"
#include "query/scan/marked_facets.hpp"

#include "capi/dispatch.hpp"
#include "capi/handle.hpp"
#include "capi/named_by_reader.hpp"

#include <abacus/labels.h>
#include <cmath>

struct abacus_marking {
    abacus_marking(const abacus_host *table, const abacus_facts &facts, std::size_t memory,
                   std::size_t cache_bytes)
        : host(*table), cache_bytes(cache_bytes), marking(host, facts, memory) {}

    const abacus::Host host;
    const std::size_t cache_bytes;
    abacus::ByDimension<abacus::Marking> marking;
};

struct abacus_facets {
    abacus_facets(const abacus_host *table, const abacus_facts &facts, std::optional<double> marker,
                  std::size_t memory, std::size_t cache_bytes)
        : host(*table), facets(host, facts, marker, memory, cache_bytes) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::MarkedFacets> facets;
};

abacus_status abacus_marking_open(const abacus_host *host, const abacus_facts *facts, size_t memory,
                                  size_t cache_bytes, abacus_marking **marking,
                                  abacus_error *error) {
    return abacus::guard(error, [&] {
        *marking = abacus::create_handle<abacus_marking>(host, *facts, memory, cache_bytes);
        return ABACUS_OK;
    });
}

abacus_status abacus_marking_add(abacus_marking *marking, const uint64_t *rows, size_t count,
                                 abacus_error *error) {
    return abacus::dispatch(marking->marking, error,
                            [&](auto &opened) { opened.add(rows, count); });
}

abacus_status abacus_marking_end(abacus_marking *marking, abacus_header *header,
                                 abacus_error *error) {
    return abacus::set_by_reader(marking->host, marking->marking, marking->cache_bytes, *header,
                                 error);
}

void abacus_marking_close(abacus_marking *marking) { abacus::destroy_handle(marking); }

abacus_status abacus_facets_open(const abacus_host *host, const abacus_facts *facts, double marker,
                                 size_t memory, size_t cache_bytes, abacus_facets **facets,
                                 abacus_error *error) {
    return abacus::guard(error, [&] {
        const auto wanted = std::isnan(marker) ? std::nullopt : std::optional(marker);
        *facets = abacus::create_handle<abacus_facets>(host, *facts, wanted, memory, cache_bytes);
        return ABACUS_OK;
    });
}

abacus_status abacus_facets_next(abacus_facets *facets, abacus_facet *facet, abacus_error *error) {
    return abacus::guard(error, [&] {
        return facets->facets.visit([&](auto &opened) { return opened.next(*facet); }) ? ABACUS_OK
                                                                                       : ABACUS_END;
    });
}

void abacus_facets_close(abacus_facets *facets) { abacus::destroy_handle(facets); }
