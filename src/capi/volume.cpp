// Areas and volumes behind the C interface.
#include "query/volume/volume.hpp"

#include "capi/guard.hpp"

namespace {

void require_box(const abacus_surface &surface, const abacus_header &header) {
    if (surface.window.kind == ABACUS_BALL_WINDOW)
        throw abacus::Error(ABACUS_ERROR_ARGUMENT, "the window must be a box");
    if (surface.attribute >= header.attributes)
        throw abacus::Error(ABACUS_ERROR_ARGUMENT, "the mesh has no such attribute");
}

} // namespace

abacus_status abacus_volume_above(const abacus_host *host, const abacus_header *header,
                                  const abacus_surface *surface, double base, abacus_volume *volume,
                                  abacus_error *error) {
    return abacus::guard(error, [&] {
        require_box(*surface, *header);
        const abacus::Host wrapped(*host);
        *volume = header->dimension == 2
                      ? abacus::volume_above<2>(wrapped, *header, *surface, base)
                      : abacus::volume_above<3>(wrapped, *header, *surface, base);
        return ABACUS_OK;
    });
}

abacus_status abacus_volume_between(const abacus_host *host, const abacus_header *header,
                                    const abacus_surface *surface, const abacus_host *other_host,
                                    const abacus_header *other, uint32_t other_attribute,
                                    size_t cache_bytes, abacus_volume *volume,
                                    abacus_error *error) {
    return abacus::guard(error, [&] {
        if (header->dimension != 2 || other->dimension != 2)
            throw abacus::Error(ABACUS_ERROR_ARGUMENT, "both meshes must have dimension 2");
        require_box(*surface, *header);
        if (other_attribute >= other->attributes)
            throw abacus::Error(ABACUS_ERROR_ARGUMENT, "the other mesh has no such attribute");
        const abacus::Host first(*host), second(*other_host);
        *volume = abacus::volume_between(first, *header, *surface, second, *other, other_attribute,
                                         cache_bytes);
        return ABACUS_OK;
    });
}
