// A mesh as arrays behind the C interface.
#include "query/scan/numbering.hpp"
#include "query/scan/simplex_labels.hpp"

#include "capi/dimension.hpp"
#include "capi/guard.hpp"
#include "capi/handle.hpp"

struct abacus_numbered {
    abacus_numbered(const abacus_host *table, const abacus_facts &facts, bool of_simplices,
                    std::size_t memory)
        : host(*table) {
        if (of_simplices) {
            simplices.emplace(host, facts, memory);
            labels.emplace(host, facts);
        } else
            vertices.emplace(host, facts, memory);
    }

    const abacus::Host host;
    std::optional<abacus::ByDimension<abacus::NumberedVertices>> vertices;
    std::optional<abacus::ByDimension<abacus::NumberedSimplices>> simplices;
    std::optional<abacus::ByDimension<abacus::SimplexLabels>> labels;
};

abacus_status abacus_numbered_open(const abacus_host *host, const abacus_facts *facts,
                                   int simplices, size_t memory, abacus_numbered **numbered,
                                   abacus_error *error) {
    return abacus::guard(error, [&] {
        *numbered = abacus::create_handle<abacus_numbered>(host, *facts, simplices != 0, memory);
        return ABACUS_OK;
    });
}

abacus_status abacus_numbered_next_vertex(abacus_numbered *numbered, abacus_vertex *vertex,
                                          abacus_error *error) {
    return abacus::guard(error, [&] {
        return numbered->vertices.value().visit(
            [&](auto &all) { return all.next(*vertex) ? ABACUS_OK : ABACUS_END; });
    });
}

abacus_status abacus_numbered_next_simplex(abacus_numbered *numbered, abacus_simplex *simplex,
                                           uint64_t *numbers, abacus_error *error) {
    return abacus::guard(error, [&] {
        return numbered->simplices.value().visit(
            [&](auto &all) { return all.next(*simplex, numbers) ? ABACUS_OK : ABACUS_END; });
    });
}

abacus_status abacus_numbered_labels(abacus_numbered *numbered, const abacus_simplex *simplex,
                                     const double **labels, abacus_error *error) {
    return abacus::guard(error, [&] {
        *labels = numbered->labels.value().visit([&](auto &of_all) { return of_all.of(*simplex); });
        return ABACUS_OK;
    });
}

void abacus_numbered_close(abacus_numbered *numbered) { abacus::destroy_handle(numbered); }
