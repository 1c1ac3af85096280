// The nearest vertices as the C interface reports them.
#pragma once

#include "query/locate/nearest.hpp"

#include <abacus/locate.h>

namespace abacus {

template <int D>
void report_vertex(std::int64_t place, std::uint64_t rank, const std::uint64_t *record,
                   double distance, abacus_nearest_report report, void *context) {
    const Point<D> at = record_point<D>(record);
    abacus_vertex vertex{};
    vertex.id = vertex.vertex = record_id(record);
    std::copy(at.begin(), at.end(), vertex.point);
    vertex.attributes = record_attributes<D>(record);
    host::require(report(context, place, rank, &vertex, distance));
}

} // namespace abacus
