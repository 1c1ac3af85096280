// The nearest vertices as the C interface reports them.
#pragma once

#include "query/nearest.hpp"

#include <abacus/read.h>

namespace abacus {

template <int D>
void report_nearest(Reader<D> &reader, std::int64_t place, const Point<D> &p, std::uint64_t k,
                    abacus_nearest_report report, void *context) {
    std::uint64_t rank = 0;
    Nearest<D>(reader).find(p, k, [&](const std::uint64_t *record) {
        const Point<D> at = record_point<D>(record);
        abacus_vertex vertex{};
        vertex.id = vertex.vertex = record_id(record);
        std::copy(at.begin(), at.end(), vertex.point);
        vertex.attributes = record_attributes<D>(record);
        host::require(report(context, place, ++rank, &vertex, distance<D>(p, at)));
    });
}

} // namespace abacus
