// Areas and volumes behind the C interface.
#include "query/volume/volume.hpp"

#include "query/volume/comparison.hpp"

#include "capi/guard.hpp"

namespace {

void require_box(const abacus_surface &surface, const abacus_facts &facts) {
    if (surface.window.kind == ABACUS_BALL_WINDOW)
        throw abacus::Error(ABACUS_ERROR_ARGUMENT, "the window must be a box");
    if (surface.attribute >= facts.columns.attributes)
        throw abacus::Error(ABACUS_ERROR_ARGUMENT, "the mesh has no such attribute");
}

void require_plane(const abacus_facts &facts, const abacus_facts &other) {
    if (facts.form.dimension != 2 || other.form.dimension != 2)
        throw abacus::Error(ABACUS_ERROR_ARGUMENT, "both meshes must have dimension 2");
}

void require_same_dimension(const abacus_facts &facts, const abacus_facts &other) {
    if (facts.form.dimension != other.form.dimension)
        throw abacus::Error(ABACUS_ERROR_ARGUMENT, "both meshes must have the same dimension");
}

void require_attribute(const abacus_facts &other, std::uint32_t attribute) {
    if (attribute >= other.columns.attributes)
        throw abacus::Error(ABACUS_ERROR_ARGUMENT, "the other mesh has no such attribute");
}

} // namespace

abacus_status abacus_volume_above(const abacus_host *host, const abacus_facts *facts,
                                  const abacus_surface *surface, double base, abacus_volume *volume,
                                  abacus_error *error) {
    return abacus::guard(error, [&] {
        require_box(*surface, *facts);
        const abacus::Host wrapped(*host);
        *volume = facts->form.dimension == 2
                      ? abacus::volume_above<2>(wrapped, *facts, *surface, base)
                      : abacus::volume_above<3>(wrapped, *facts, *surface, base);
        return ABACUS_OK;
    });
}

abacus_status abacus_volume_between(const abacus_host *host, const abacus_facts *facts,
                                    const abacus_surface *surface, const abacus_host *other_host,
                                    const abacus_facts *other, uint32_t other_attribute,
                                    size_t cache_bytes, abacus_volume *volume,
                                    abacus_error *error) {
    return abacus::guard(error, [&] {
        require_plane(*facts, *other);
        require_box(*surface, *facts);
        require_attribute(*other, other_attribute);
        const abacus::Host first(*host), second(*other_host);
        *volume = abacus::volume_between(first, *facts, *surface,
                                         {second, *other, other_attribute, cache_bytes});
        return ABACUS_OK;
    });
}

abacus_status abacus_compare(const abacus_host *host, const abacus_facts *facts,
                             const abacus_surface *surface, const abacus_host *other_host,
                             const abacus_facts *other, uint32_t other_attribute,
                             size_t cache_bytes, abacus_comparison *comparison,
                             abacus_error *error) {
    return abacus::guard(error, [&] {
        require_same_dimension(*facts, *other);
        require_box(*surface, *facts);
        require_attribute(*other, other_attribute);
        const abacus::Host first(*host), second(*other_host);
        const abacus::OtherMesh against{second, *other, other_attribute, cache_bytes};
        *comparison = facts->form.dimension == 2
                          ? abacus::compare<2>(first, *facts, *surface, against)
                          : abacus::compare<3>(first, *facts, *surface, against);
        return ABACUS_OK;
    });
}
