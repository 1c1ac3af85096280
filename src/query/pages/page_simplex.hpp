// The simplices of a stored page as the mesh and its users see them, without a cache.
#pragma once

#include "geometry/predicates.hpp"
#include "keys/locational_code.hpp"
#include "mesh/page_format.hpp"
#include "query/pages/corner_values.hpp"
#include "query/pages/describe.hpp"
#include "query/pages/vertex_values.hpp"

#include <abacus/simplex.h>

namespace abacus {

/// Corners of a finite simplex.
template <int D> Corners<D> corners_of(const PageView<D> &page, int simplex) {
    Corners<D> corners;
    for (int i = 0; i <= D; ++i) corners[i] = &page.point(page.corner(simplex, i));
    return corners;
}

/// Code of the simplex's key: the greatest of its vertices.
template <int D>
std::uint64_t code_of(const PageView<D> &page, int simplex, const Domain<D> &domain) {
    std::uint64_t greatest = 0;
    for (int i = 0; i < D + !page.is_ghost(simplex); ++i)
        greatest = std::max(greatest, domain.code(page.point(page.corner(simplex, i))));
    return greatest;
}

/// Returns which corner is returned first, second, and so on.
template <int D>
const typename EvenOrders<D>::Order &describe(const PageView<D> &page, int simplex,
                                              const Domain<D> &domain,
                                              abacus_simplex &description) {
    const bool ghost = page.is_ghost(simplex);
    DescribedCorners<D> corners;
    for (int i = 0; i < D + !ghost; ++i) {
        const int vertex = page.corner(simplex, i);
        corners.id[i] = page.id(vertex);
        corners.point[i] = &page.point(vertex);
    }
    corners.region = page.region(simplex);
    return describe(corners, code_of(page, simplex, domain), ghost, description);
}

/// With the values at its corners, if `values` is not null.
template <int D>
void describe(const PageView<D> &page, int simplex, const Domain<D> &domain,
              abacus_simplex &description, CornerValues *values,
              const VertexValues<D> &vertex_values) {
    const auto &order = describe(page, simplex, domain, description);
    for (int i = 0; values != nullptr && i < D + !page.is_ghost(simplex); ++i)
        values->set(i, [&](int attribute) {
            const int vertex = page.corner(simplex, order[i]);
            return vertex_values.value(page, vertex, description.id[i], attribute);
        });
}

} // namespace abacus
