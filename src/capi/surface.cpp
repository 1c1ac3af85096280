// Surfaces through a mesh behind the C interface.
#include "query/levels/isosurface.hpp"
#include "query/lines/plane_section.hpp"
#include "query/scan/simplex_labels.hpp"

#include "capi/guard.hpp"
#include "capi/handle.hpp"

#include <abacus/surface.h>

namespace {

void require_space(const abacus_facts &facts) {
    if (facts.form.dimension != 3)
        throw abacus::Error(ABACUS_ERROR_ARGUMENT, "the mesh has the wrong dimension");
}

} // namespace

abacus_status abacus_isosurface(const abacus_host *host, const abacus_facts *facts,
                                const abacus_isosurface_query *query, size_t memory,
                                abacus_surface_report report, void *context, abacus_error *error) {
    return abacus::guard(error, [&] {
        require_space(*facts);
        const abacus::Host wrapped(*host);
        abacus::Isosurface surface(wrapped, *facts, *query, memory);
        surface.each([&](const abacus_surface_triangle &triangle) {
            abacus::host::require(report(context, &triangle));
        });
        return ABACUS_OK;
    });
}

struct abacus_sections {
    abacus_sections(const abacus_host *table, const abacus_facts &facts,
                    const abacus_section_query &query)
        : host(*table), section(host, facts, query), labels(host, facts) {}

    const abacus::Host host;
    abacus::PlaneSection section;
    abacus::SimplexLabels<3> labels;
};

abacus_status abacus_sections_open(const abacus_host *host, const abacus_facts *facts,
                                   const abacus_section_query *query, abacus_sections **sections,
                                   abacus_error *error) {
    return abacus::guard(error, [&] {
        require_space(*facts);
        *sections = abacus::create_handle<abacus_sections>(host, *facts, *query);
        return ABACUS_OK;
    });
}

abacus_status abacus_sections_next(abacus_sections *sections, abacus_polygon *polygon,
                                   abacus_error *error) {
    return abacus::guard(error,
                         [&] { return sections->section.next(*polygon) ? ABACUS_OK : ABACUS_END; });
}

abacus_status abacus_sections_labels(abacus_sections *sections, const double **labels,
                                     abacus_error *error) {
    return abacus::guard(error, [&] {
        const abacus::PlaneSection &section = sections->section;
        *labels = sections->labels.of_page(section.page(), section.simplex());
        return ABACUS_OK;
    });
}

void abacus_sections_close(abacus_sections *sections) { abacus::destroy_handle(sections); }
