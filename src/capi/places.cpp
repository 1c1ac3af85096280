// Many places behind the C interface.
#include "query/places.hpp"
#include "query/interpolation.hpp"

#include "capi/dispatch.hpp"
#include "capi/handle.hpp"
#include "capi/nearest.hpp"

#include <abacus/interpolate.h>

struct abacus_places {
    abacus_places(const abacus_host *table, const abacus_header &header, std::size_t memory,
                  std::size_t cache_bytes)
        : host(*table), places(host, header, memory, cache_bytes) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::Places> places;
};

abacus_status abacus_places_open(const abacus_host *host, const abacus_header *header,
                                 size_t memory, size_t cache_bytes, abacus_places **places,
                                 abacus_error *error) {
    return abacus::guard(error, [&] {
        *places = abacus::create_handle<abacus_places>(host, *header, memory, cache_bytes);
        return ABACUS_OK;
    });
}

abacus_status abacus_places_add(abacus_places *places, const uint64_t *records, size_t count,
                                abacus_error *error) {
    return abacus::dispatch(places->places, error, [&](auto &all) { all.add(records, count); });
}

abacus_status abacus_places_locate(abacus_places *places, abacus_place_report report, void *context,
                                   abacus_error *error) {
    return abacus::dispatch(places->places, error, [&](auto &all) {
        abacus_simplex simplex{};
        all.each([&](auto &reader, std::int64_t id, const auto &place) {
            const bool is_inside = reader.locate(place, simplex);
            abacus::host::require(report(context, id, is_inside ? &simplex : nullptr));
        });
    });
}

abacus_status abacus_places_interpolate(abacus_places *places,
                                        const abacus_interpolation *interpolation,
                                        abacus_values_report report, void *context,
                                        abacus_error *error) {
    return abacus::dispatch(places->places, error, [&]<int D>(abacus::Places<D> &all) {
        abacus::Interpolation<D> found(places->host);
        std::array<double, ABACUS_MAX_ATTRIBUTES> values;
        all.each([&](auto &reader, std::int64_t id, const auto &place) {
            const bool is_inside = found.values(reader, *interpolation, place, values.data());
            abacus::host::require(report(context, id, is_inside ? values.data() : nullptr));
        });
    });
}

abacus_status abacus_places_weigh(abacus_places *places, const abacus_interpolation *interpolation,
                                  abacus_weights_report report, void *context,
                                  abacus_error *error) {
    return abacus::dispatch(places->places, error, [&]<int D>(abacus::Places<D> &all) {
        abacus::Interpolation<D> found(places->host);
        all.each([&](auto &reader, std::int64_t id, const auto &place) {
            const bool is_inside = found.weigh(reader, *interpolation, place);
            abacus::host::require(report(context, id, found.weights().data(),
                                         is_inside ? found.weights().size() : 0));
        });
    });
}

abacus_status abacus_places_nearest(abacus_places *places, uint64_t k, abacus_nearest_report report,
                                    void *context, abacus_error *error) {
    return abacus::dispatch(places->places, error, [&]<int D>(abacus::Places<D> &all) {
        all.each([&](abacus::Reader<D> &reader, std::int64_t id, const abacus::Point<D> &place) {
            abacus::report_nearest<D>(reader, id, place, k, report, context);
        });
    });
}

void abacus_places_close(abacus_places *places) { abacus::destroy_handle(places); }
