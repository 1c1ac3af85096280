// An attribute as a raster behind the C interface.
#include "query/places/value_raster.hpp"

#include "capi/dimension.hpp"
#include "capi/guard.hpp"
#include "capi/handle.hpp"

struct abacus_raster_scan {
    abacus_raster_scan(const abacus_host *table, const abacus_facts &facts,
                       const abacus_raster &raster, const abacus_interpolation &how,
                       std::size_t memory, std::size_t cache_bytes)
        : host(*table), rows(host, facts, raster, how, memory, cache_bytes) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::ValueRaster> rows;
};

abacus_status abacus_raster_open(const abacus_host *host, const abacus_facts *facts,
                                 const abacus_raster *raster,
                                 const abacus_interpolation *interpolation, size_t memory,
                                 size_t cache_bytes, abacus_raster_scan **scan,
                                 abacus_error *error) {
    return abacus::guard(error, [&] {
        *scan = abacus::create_handle<abacus_raster_scan>(host, *facts, *raster, *interpolation,
                                                          memory, cache_bytes);
        return ABACUS_OK;
    });
}

abacus_status abacus_raster_next(abacus_raster_scan *scan, const double **values,
                                 abacus_error *error) {
    return abacus::guard(error, [&] {
        *values = scan->rows.visit([](auto &rows) { return rows.next(); });
        return *values == nullptr ? ABACUS_END : ABACUS_OK;
    });
}

void abacus_raster_close(abacus_raster_scan *scan) { abacus::destroy_handle(scan); }
