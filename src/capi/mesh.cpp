// Locating and walking behind the C interface.
#include "query/reader.hpp"

#include "capi/dimension.hpp"
#include "capi/guard.hpp"
#include "capi/handle.hpp"

#include <abacus/read.h>
#include <cmath>

struct abacus_mesh {
    abacus_mesh(const abacus_host *table, const abacus_header &header, std::size_t cache_bytes)
        : host(*table), reader(host, header, cache_bytes) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::Reader> reader;
};

abacus_status abacus_mesh_open(const abacus_host *host, const abacus_header *header,
                               size_t cache_bytes, abacus_mesh **mesh, abacus_error *error) {
    return abacus::guard(error, [&] {
        *mesh = abacus::create_handle<abacus_mesh>(host, *header, cache_bytes);
        return ABACUS_OK;
    });
}

void abacus_mesh_close(abacus_mesh *mesh) { abacus::destroy_handle(mesh); }

abacus_status abacus_mesh_locate(abacus_mesh *mesh, const double *point, abacus_simplex *simplex,
                                 abacus_error *error) {
    return abacus::guard(error, [&] {
        return mesh->reader.visit([&]<int D>(abacus::Reader<D> &reader) {
            abacus::Point<D> p;
            for (int i = 0; i < D; ++i) {
                if (!std::isfinite(point[i]))
                    throw abacus::Error(ABACUS_ERROR_ARGUMENT, "a coordinate is not finite");
                p[i] = point[i] + 0.0; // -0.0 is +0.0
            }
            return reader.locate(p, *simplex) ? ABACUS_OK : ABACUS_END;
        });
    });
}

abacus_status abacus_mesh_walk(abacus_mesh *mesh, uint64_t code, const int64_t *ids, int facet,
                               abacus_simplex *simplex, abacus_error *error) {
    return abacus::guard(error, [&] {
        return mesh->reader.visit([&](auto &reader) {
            return reader.walk(code, ids, facet, *simplex) ? ABACUS_OK : ABACUS_END;
        });
    });
}

void abacus_mesh_counters(const abacus_mesh *mesh, abacus_counters *counters) {
    const_cast<abacus_mesh *>(mesh)->reader.visit(
        [&](auto &reader) { *counters = reader.cache().counters; });
}
