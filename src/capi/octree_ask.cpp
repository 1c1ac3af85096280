// Questions to octrees about places, behind the C interface.
#include "octree/octree_interpolation.hpp"
#include "octree/octree_nearest.hpp"
#include "octree/octree_places.hpp"

#include "capi/dispatch.hpp"
#include "capi/handle.hpp"
#include "capi/octree_handle.hpp"

#include <abacus/octree_ask.h>

struct abacus_octree_places {
    abacus_octree_places(const abacus_host *table, const abacus_facts &facts, std::size_t memory,
                         std::size_t cache_bytes)
        : host(*table), places(host, facts, memory, cache_bytes) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::OctreePlaces> places;
};

namespace abacus {
namespace {

template <int D>
void report_nearest(OctreeReader<D> &reader, OctreeNearest<D> &nearest, std::int64_t id,
                    const Point<D> &place, std::uint64_t k, abacus_octant_near report,
                    void *context) {
    nearest.find(place, k, [&](std::uint64_t rank, Handle h, double distance) {
        abacus_octant octant;
        describe<D>(reader, h, octant);
        host::require(report(context, id, rank, &octant, distance));
    });
}

} // namespace
} // namespace abacus

abacus_status abacus_octree_nearest(abacus_octree *octree, const double *place, uint64_t k,
                                    abacus_octant_near report, void *context, abacus_error *error) {
    return abacus::dispatch(octree->reader, error, [&]<int D>(abacus::OctreeReader<D> &reader) {
        abacus::OctreeNearest<D> nearest(reader);
        abacus::report_nearest<D>(reader, nearest, 0, abacus::place_of<D>(place), k, report,
                                  context);
    });
}

abacus_status abacus_octree_interpolate(abacus_octree *octree, const uint32_t *attributes,
                                        uint32_t count, const double *place, double *values,
                                        abacus_error *error) {
    return abacus::guard(error, [&] {
        return octree->reader.visit([&]<int D>(abacus::OctreeReader<D> &reader) {
            abacus::OctreeInterpolation<D> between(reader, attributes, count);
            return between.values(abacus::place_of<D>(place), values) ? ABACUS_OK : ABACUS_END;
        });
    });
}

abacus_status abacus_octree_places_open(const abacus_host *host, const abacus_facts *facts,
                                        size_t memory, size_t cache_bytes,
                                        abacus_octree_places **places, abacus_error *error) {
    return abacus::guard(error, [&] {
        *places = abacus::create_handle<abacus_octree_places>(host, *facts, memory, cache_bytes);
        return ABACUS_OK;
    });
}

abacus_status abacus_octree_places_add(abacus_octree_places *places, const uint64_t *records,
                                       size_t count, abacus_error *error) {
    return abacus::dispatch(places->places, error, [&]<int D>(abacus::OctreePlaces<D> &all) {
        for (; count > 0; --count, records += 1 + D) all.add(records);
    });
}

abacus_status abacus_octree_places_locate(abacus_octree_places *places, abacus_octant_at report,
                                          void *context, abacus_error *error) {
    return abacus::dispatch(places->places, error, [&]<int D>(abacus::OctreePlaces<D> &all) {
        all.each([&](std::int64_t id, const abacus::Point<D> &place) {
            const abacus::Handle h = all.reader().locate(place);
            abacus_octant octant;
            if (h != abacus::no_handle) abacus::describe<D>(all.reader(), h, octant);
            abacus::host::require(report(context, id, h != abacus::no_handle ? &octant : nullptr));
        });
    });
}

abacus_status abacus_octree_places_nearest(abacus_octree_places *places, uint64_t k,
                                           abacus_octant_near report, void *context,
                                           abacus_error *error) {
    return abacus::dispatch(places->places, error, [&]<int D>(abacus::OctreePlaces<D> &all) {
        abacus::OctreeNearest<D> nearest(all.reader());
        all.each([&](std::int64_t id, const abacus::Point<D> &place) {
            abacus::report_nearest<D>(all.reader(), nearest, id, place, k, report, context);
        });
    });
}

abacus_status abacus_octree_places_interpolate(abacus_octree_places *places,
                                               const uint32_t *attributes, uint32_t count,
                                               abacus_octree_values report, void *context,
                                               abacus_error *error) {
    return abacus::dispatch(places->places, error, [&]<int D>(abacus::OctreePlaces<D> &all) {
        abacus::OctreeInterpolation<D> between(all.reader(), attributes, count);
        std::array<double, ABACUS_MAX_ATTRIBUTES> values;
        all.each([&](std::int64_t id, const abacus::Point<D> &place) {
            const bool is_inside = between.values(place, values.data());
            abacus::host::require(report(context, id, is_inside ? values.data() : nullptr));
        });
    });
}

void abacus_octree_places_close(abacus_octree_places *places) { abacus::destroy_handle(places); }
