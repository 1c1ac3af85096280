// Rays, profiles and lines of sight behind the C interface.
#include "query/lines/profile.hpp"
#include "query/lines/sight.hpp"

#include "capi/dispatch.hpp"
#include "capi/mesh.hpp"

#include <algorithm>

namespace {

void require_finite(const abacus_sight_end &end) {
    if (!std::isfinite(end.place[0]) || !std::isfinite(end.place[1]) || !std::isfinite(end.height))
        throw abacus::Error(ABACUS_ERROR_ARGUMENT, "an end of the line of sight is not finite");
}

} // namespace

abacus_status abacus_mesh_ray(abacus_mesh *mesh, const double *origin, const double *direction,
                              abacus_ray_report report, void *context, abacus_error *error) {
    return abacus::dispatch(mesh->reader, error, [&]<int D>(abacus::Reader<D> &reader) {
        const auto line = abacus::Line<D>::towards(abacus::finite_point<D>(origin),
                                                   abacus::finite_point<D>(direction));
        if (std::all_of(direction, direction + D, [](double d) { return d == 0; }))
            throw abacus::Error(ABACUS_ERROR_ARGUMENT, "the direction of a ray is 0");
        abacus::LineScan<D>(reader, line).each([&](const abacus::LinePiece<D> &piece) {
            abacus::host::require(report(context, piece.enters.at, piece.leaves.at, &piece.simplex,
                                         mesh->labels.get<D>().of(piece.simplex)));
            return true;
        });
    });
}

abacus_status abacus_mesh_profile(abacus_mesh *mesh, uint32_t attribute,
                                  const abacus_extent *extent, const double *path, size_t corners,
                                  abacus_profile_report report, void *context,
                                  abacus_error *error) {
    return abacus::dispatch(mesh->reader, error, [&]<int D>(abacus::Reader<D> &reader) {
        abacus::Profile<D> profile(
            reader, attribute,
            [&](double distance, const abacus::Point<D> &place, double value) {
                abacus::host::require(report(context, distance, place.data(), value));
            },
            *extent);
        profile.along(corners,
                      [&](std::size_t i) { return abacus::finite_point<D>(path + i * D); });
    });
}

abacus_status abacus_mesh_look(abacus_mesh *mesh, uint32_t attribute, const abacus_extent *extent,
                               const abacus_sight_end *observer, const abacus_sight_end *target,
                               abacus_sight *sight, abacus_error *error) {
    return abacus::guard(error, [&] {
        require_finite(*observer);
        require_finite(*target);
        *sight = abacus::look(mesh->reader.get<2>(), attribute, *observer, *target, *extent);
        return ABACUS_OK;
    });
}
