// Regions behind the C interface.
#include "capi/build.hpp"
#include "capi/dispatch.hpp"
#include "capi/handle.hpp"
#include "capi/in_plane.hpp"
#include "capi/mesh.hpp"
#include "capi/segments.hpp"
#include "query/check/region_check.hpp"
#include "query/scan/region_sizes.hpp"

#include <abacus/regions.h>

struct abacus_region_parts {
    abacus_region_parts(const abacus_host *table, const abacus_facts &facts, std::size_t memory)
        : host(*table), parts(host, memory) {
        if (facts.form.dimension != 2)
            throw abacus::Error(ABACUS_ERROR_ARGUMENT, "regions need a mesh of dimension 2");
    }

    const abacus::Host host;
    abacus::RegionParts parts;
};

static_assert(ABACUS_MAX_REGIONS < abacus::most_regions);

abacus_status abacus_region_parts_open(const abacus_host *host, const abacus_facts *facts,
                                       size_t memory, abacus_region_parts **parts,
                                       abacus_error *error) {
    return abacus::guard(error, [&] {
        *parts = abacus::create_handle<abacus_region_parts>(host, *facts, memory);
        return ABACUS_OK;
    });
}

abacus_status abacus_region_parts_outline(abacus_region_parts *parts, uint32_t region,
                                          const double ends[2][2], abacus_error *error) {
    return abacus::guard(error, [&] {
        parts->parts.add_outline(region, {ends[0][0], ends[0][1]}, {ends[1][0], ends[1][1]});
        return ABACUS_OK;
    });
}

abacus_status abacus_region_parts_seed(abacus_region_parts *parts, uint32_t region,
                                       const double place[2], abacus_error *error) {
    return abacus::guard(error, [&] {
        parts->parts.add_seed(region, {place[0], place[1]});
        return ABACUS_OK;
    });
}

void abacus_region_parts_close(abacus_region_parts *parts) { abacus::destroy_handle(parts); }

abacus_status abacus_build_fill_regions(abacus_build *build, abacus_region_parts *parts,
                                        abacus_header *header, abacus_region_box_report report,
                                        void *context, abacus_region_fault *fault,
                                        abacus_error *error) {
    const auto pass_on = [&](abacus::RegionNumber region, const abacus::Box<2> &box) {
        abacus::host::require(report(context, region, box.lower.data(), box.upper.data()));
    };
    return abacus::run_sound_change(
        build, header, error, [&](auto &opened, abacus_header &changed) {
            return opened.fill_regions(parts->parts, pass_on, *fault, changed);
        });
}

abacus_status abacus_build_cut_regions(abacus_build *build, abacus_segments *segments,
                                       abacus_region_parts *parts, abacus_header *header,
                                       abacus_region_fault *fault, abacus_error *error) {
    return abacus::run_sound_change(
        build, header, error, [&](auto &opened, abacus_header &changed) {
            return opened.cut_regions(segments->segments, parts->parts, *fault, changed);
        });
}

abacus_status abacus_build_clear_regions(abacus_build *build, abacus_region_parts *parts,
                                         abacus_header *header, abacus_error *error) {
    return abacus::run_change(build, header, error, [&](auto &opened, abacus_header &changed) {
        opened.clear_regions(parts->parts, changed);
    });
}

abacus_status abacus_build_regions_along(abacus_build *build, abacus_segments *segments,
                                         abacus_region_report report, void *context,
                                         abacus_error *error) {
    using namespace abacus;
    return in_plane(build->build, "regions", error, [&](Build<2> &opened) {
        opened.regions_along(segments->segments,
                             [&](RegionNumber region) { host::require(report(context, region)); });
        return ABACUS_OK;
    });
}

abacus_status abacus_region_sizes(abacus_mesh *mesh, size_t memory,
                                  abacus_region_size_report report, void *context,
                                  abacus_error *error) {
    using namespace abacus;
    return in_plane(mesh->reader, "regions", error, [&](Reader<2> &reader) {
        region_sizes(reader, memory, [&](const abacus_region_size &size) {
            host::require(report(context, &size));
        });
        return ABACUS_OK;
    });
}

abacus_status abacus_region_check(abacus_mesh *mesh, abacus_region_parts *parts, size_t memory,
                                  uint32_t *region, abacus_error *error) {
    using namespace abacus;
    return in_plane(mesh->reader, "regions", error, [&](Reader<2> &reader) {
        *region = RegionCheck(reader, memory).find_wrong(parts->parts);
        parts->parts.close();
        return ABACUS_OK;
    });
}
