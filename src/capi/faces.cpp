// Vertices and edges of a window behind the C interface.
#include "query/scan/face_scan.hpp"

#include "capi/dimension.hpp"
#include "capi/guard.hpp"
#include "capi/handle.hpp"

#include <abacus/windows.h>
#include <algorithm>
#include <utility>

struct abacus_faces {
    abacus_faces(const abacus_host *table, const abacus_facts &facts, const abacus_window &window,
                 int corners, const abacus_extent &extent, std::size_t cache_bytes)
        : host(*table), faces(host, facts, window, corners, extent, cache_bytes) {}

    abacus_faces(const abacus_host *table, const abacus_facts &facts, const abacus_window &window,
                 const abacus_range &range, std::size_t cache_bytes)
        : host(*table), faces(host, facts, window, range, cache_bytes) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::FaceScan> faces;
    double attributes[ABACUS_MAX_ATTRIBUTES]; // of the vertex returned last
};

abacus_status abacus_faces_open(const abacus_host *host, const abacus_facts *facts,
                                const abacus_window *window, int edges, const abacus_extent *extent,
                                std::size_t cache_bytes, abacus_faces **faces,
                                abacus_error *error) {
    return abacus::guard(error, [&] {
        *faces = abacus::create_handle<abacus_faces>(host, *facts, *window, edges != 0 ? 2 : 1,
                                                     *extent, cache_bytes);
        return ABACUS_OK;
    });
}

abacus_status abacus_faces_open_range(const abacus_host *host, const abacus_facts *facts,
                                      const abacus_window *window, const abacus_range *range,
                                      std::size_t cache_bytes, abacus_faces **faces,
                                      abacus_error *error) {
    return abacus::guard(error, [&] {
        *faces = abacus::create_handle<abacus_faces>(host, *facts, *window, *range, cache_bytes);
        return ABACUS_OK;
    });
}

abacus_status abacus_faces_next_vertex(abacus_faces *faces, abacus_vertex *vertex,
                                       abacus_error *error) {
    return abacus::guard(error, [&] {
        return faces->faces.visit([&](auto &scan) {
            if (!scan.advance()) return ABACUS_END;
            const auto &page = scan.page();
            const int v = scan.vertex(0);
            *vertex = {};
            vertex->id = vertex->vertex = page.id(v);
            std::copy(page.point(v).begin(), page.point(v).end(), vertex->point);
            scan.vertex_values().all(page, v, faces->attributes);
            vertex->attributes = faces->attributes;
            return ABACUS_OK;
        });
    });
}

abacus_status abacus_faces_next_edge(abacus_faces *faces, abacus_edge *edge, double *ends,
                                     abacus_error *error) {
    return abacus::guard(error, [&] {
        return faces->faces.visit([&]<int D>(abacus::FaceScan<D> &scan) {
            if (!scan.advance()) return ABACUS_END;
            const auto &page = scan.page();
            int a = scan.vertex(0), b = scan.vertex(1);
            if (page.id(b) < page.id(a)) std::swap(a, b);
            edge->id[0] = page.id(a);
            edge->id[1] = page.id(b);
            edge->length = abacus::distance<D>(page.point(a), page.point(b));
            if (ends != nullptr) {
                ends = std::copy(page.point(a).begin(), page.point(a).end(), ends);
                std::copy(page.point(b).begin(), page.point(b).end(), ends);
            }
            return ABACUS_OK;
        });
    });
}

int abacus_faces_is_fixed(const abacus_faces *faces) {
    return faces->faces.visit([]<int D>(const abacus::FaceScan<D> &scan) -> int {
        if constexpr (D == 2)
            return scan.is_fixed();
        else
            return 0;
    });
}

uint64_t abacus_faces_pages(const abacus_faces *faces) {
    return faces->faces.visit([](const auto &scan) { return scan.pages_read(); });
}

void abacus_faces_close(abacus_faces *faces) { abacus::destroy_handle(faces); }
