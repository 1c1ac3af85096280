// Whole-mesh sequences behind the C interface.
#include "query/pages/simplex_scan.hpp"
#include "query/scan/vertex_scan.hpp"

#include "capi/dimension.hpp"
#include "capi/guard.hpp"
#include "capi/handle.hpp"

#include <abacus/scan.h>

struct abacus_scan {
    abacus_scan(const abacus_host *table, const abacus_facts &facts, bool ghosts)
        : host(*table), simplices(host, facts, ghosts) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::SimplexScan> simplices;
};

struct abacus_vertex_scan {
    abacus_vertex_scan(const abacus_host *table, const abacus_facts &facts, std::size_t cache_bytes)
        : host(*table), vertices(host, facts, cache_bytes) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::VertexScan> vertices;
};

abacus_status abacus_scan_open(const abacus_host *host, const abacus_facts *facts, int ghosts,
                               abacus_scan **scan, abacus_error *error) {
    return abacus::guard(error, [&] {
        *scan = abacus::create_handle<abacus_scan>(host, *facts, ghosts != 0);
        return ABACUS_OK;
    });
}

abacus_status abacus_scan_next(abacus_scan *scan, abacus_simplex *simplex, abacus_error *error) {
    return abacus::guard(error, [&] {
        return scan->simplices.visit(
            [&](auto &simplices) { return simplices.next(*simplex) ? ABACUS_OK : ABACUS_END; });
    });
}

void abacus_scan_close(abacus_scan *scan) { abacus::destroy_handle(scan); }

abacus_status abacus_vertex_scan_open(const abacus_host *host, const abacus_facts *facts,
                                      size_t cache_bytes, abacus_vertex_scan **scan,
                                      abacus_error *error) {
    return abacus::guard(error, [&] {
        *scan = abacus::create_handle<abacus_vertex_scan>(host, *facts, cache_bytes);
        return ABACUS_OK;
    });
}

abacus_status abacus_vertex_scan_next(abacus_vertex_scan *scan, abacus_vertex *vertex,
                                      abacus_error *error) {
    return abacus::guard(error, [&] {
        return scan->vertices.visit(
            [&](auto &vertices) { return vertices.next(*vertex) ? ABACUS_OK : ABACUS_END; });
    });
}

void abacus_vertex_scan_close(abacus_vertex_scan *scan) { abacus::destroy_handle(scan); }
