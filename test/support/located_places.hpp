// Many places located by one call.
#pragma once

#include "support/oracle.hpp"

#include <abacus/locate.h>
#include <cstring>
#include <optional>

namespace abacus::test {

struct LocatedPlace {
    std::int64_t id;
    std::optional<abacus_simplex> simplex; ///< none outside
};

inline abacus_host_status keep_place(void *context, std::int64_t id, const abacus_simplex *simplex,
                                     const double *) {
    auto &located = *static_cast<std::vector<LocatedPlace> *>(context);
    located.push_back({id, simplex == nullptr ? std::nullopt : std::optional(*simplex)});
    return ABACUS_HOST_OK;
}

/// Passes the places to report(context, ...), or keeps them in `located`.
template <int D>
abacus_status locate_places(MeshOf<D> &mesh, const std::vector<InputOf<D>> &places,
                            std::vector<LocatedPlace> &located, std::size_t memory = 16 << 20,
                            abacus_place_report report = keep_place) {
    std::vector<std::uint64_t> records;
    for (const InputOf<D> &place : places) {
        records.push_back(std::bit_cast<std::uint64_t>(place.id));
        for (const double x : place.point) records.push_back(std::bit_cast<std::uint64_t>(x));
    }
    abacus_places *handle = nullptr;
    abacus_status status = abacus_places_open(mesh.host.table(), &mesh.header.facts, memory,
                                              mesh.cache_bytes, &handle, &mesh.error);
    if (status != ABACUS_OK) return status;
    status = abacus_places_add(handle, records.data(), places.size(), &mesh.error);
    if (status == ABACUS_OK) status = abacus_places_locate(handle, report, &located, &mesh.error);
    abacus_places_close(handle);
    return status;
}

} // namespace abacus::test
