// What is behind an abacus_mesh.
#pragma once

#include "query/scan/simplex_labels.hpp"
#include "query/shares/cut.hpp"
#include "query/values/interpolation.hpp"

#include "capi/dimension.hpp"

#include <cmath>
#include <tuple>

struct abacus_mesh {
    abacus_mesh(const abacus_host *table, const abacus_facts &facts, std::size_t cache_bytes)
        : host(*table), reader(host, facts, cache_bytes), interpolation(host, facts),
          labels(host, facts) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::Reader> reader;
    abacus::ByDimension<abacus::Interpolation> interpolation;
    abacus::ByDimension<abacus::SimplexLabels> labels;
    /// The last cut into parts, if there was one, in the dimension of the mesh.
    std::tuple<std::optional<abacus::Cut<2>>, std::optional<abacus::Cut<3>>> cuts;
};

namespace abacus {

template <int D> Point<D> finite_point(const double *point) {
    Point<D> p;
    for (int i = 0; i < D; ++i) {
        if (!std::isfinite(point[i]))
            throw Error(ABACUS_ERROR_ARGUMENT, "a coordinate is not finite");
        p[i] = point[i] + 0.0; // -0.0 is +0.0
    }
    return p;
}

} // namespace abacus
