// Crossings of segments behind the C interface.
#include "segments/crossings.hpp"

#include "capi/guard.hpp"
#include "capi/handle.hpp"

#include <abacus/crossings.h>

#include <cmath>

struct abacus_crossings {
    abacus_crossings(const abacus_host *table, std::size_t memory)
        : host(*table), crossings(host, memory) {}

    const abacus::Host host;
    abacus::Crossings crossings;
};

namespace {

abacus::Point<2> finite_place(double x, double y) {
    if (!std::isfinite(x) || !std::isfinite(y))
        throw abacus::Error(ABACUS_ERROR_ARGUMENT, "a coordinate is not finite");
    return {x + 0.0, y + 0.0}; // -0.0 is +0.0
}

} // namespace

abacus_status abacus_crossings_open(const abacus_host *host, size_t memory,
                                    abacus_crossings **crossings, abacus_error *error) {
    return abacus::guard(error, [&] {
        *crossings = abacus::create_handle<abacus_crossings>(host, memory);
        return ABACUS_OK;
    });
}

abacus_status abacus_crossings_add(abacus_crossings *crossings, const abacus_line_segment *segments,
                                   size_t count, abacus_error *error) {
    return abacus::guard(error, [&] {
        for (size_t i = 0; i < count; ++i) {
            const abacus_line_segment &s = segments[i];
            crossings->crossings.add(
                {s.line, s.position, finite_place(s.a[0], s.a[1]), finite_place(s.b[0], s.b[1])});
        }
        return ABACUS_OK;
    });
}

abacus_status abacus_crossings_add_corners(abacus_crossings *crossings, const uint64_t *records,
                                           size_t count, abacus_error *error) {
    return abacus::guard(error, [&] {
        for (const uint64_t *record = records; record != records + 5 * count; record += 5)
            crossings->crossings.add_corner(
                static_cast<std::int64_t>(record[0]), static_cast<std::int64_t>(record[1]),
                finite_place(std::bit_cast<double>(record[2]), std::bit_cast<double>(record[3])),
                static_cast<std::int64_t>(record[4]));
        return ABACUS_OK;
    });
}

abacus_status abacus_crossings_count(abacus_crossings *crossings, uint64_t *count,
                                     abacus_error *error) {
    return abacus::guard(error, [&] {
        *count = crossings->crossings.count();
        return ABACUS_OK;
    });
}

abacus_status abacus_crossings_next(abacus_crossings *crossings, abacus_crossing *crossing,
                                    abacus_error *error) {
    return abacus::guard(error, [&] {
        abacus::Crossings::Crossing next;
        if (!crossings->crossings.next(next)) {
            crossings->crossings.close();
            return ABACUS_END;
        }
        *crossing = {{next.first.line, next.second.line},
                     {next.first.position, next.second.position},
                     {next.at.place[0], next.at.place[1]},
                     next.at.is_exact};
        return ABACUS_OK;
    });
}

void abacus_crossings_close(abacus_crossings *crossings) { abacus::destroy_handle(crossings); }
