// Polygons behind the C interface.
#include "query/pages/area.hpp"

#include "capi/guard.hpp"
#include "capi/handle.hpp"

#include <cmath>

abacus_status abacus_area_open(const abacus_host *host, const double *points, const size_t *sizes,
                               size_t rings, abacus_area **polygon, abacus_error *error) {
    return abacus::guard(error, [&] {
        size_t count = 0;
        for (size_t ring = 0; ring < rings; ++ring) count += 2 * sizes[ring];
        if (!std::all_of(points, points + count, [](double x) { return std::isfinite(x); }))
            throw abacus::Error(ABACUS_ERROR_ARGUMENT, "a coordinate of the polygon is not finite");
        *polygon = abacus::create_handle<abacus_area>(host, points, sizes, rings);
        return ABACUS_OK;
    });
}

void abacus_area_close(abacus_area *polygon) { abacus::destroy_handle(polygon); }

int32_t abacus_area_box(const abacus_area *polygon, double *lower, double *upper) {
    const abacus::Box<2> &box = polygon->polygon.box();
    if (box.upper[0] < box.lower[0]) return 0;
    std::copy_n(box.lower.begin(), 2, lower);
    std::copy_n(box.upper.begin(), 2, upper);
    return 1;
}
