// The places of simplices on the curve, all different: the order in which parts take them.
//
// A page owns a stretch of keys, and holds its simplices in an order of its own. Simplices with one
// key, such as those around their common greatest vertex, are ordered by their corners. So the
// order depends on the mesh alone, not on how it is cut into pages.
#pragma once

#include "attributes/attribute_key.hpp"
#include "query/pages/page_simplex.hpp"

namespace abacus {

template <int D> struct CurvePlace {
    Key key;
    Owner<D, D + 1> corners;

    bool operator<(const CurvePlace &other) const {
        return key < other.key || (key == other.key && corners < other.corners);
    }
};

/// The place of a finite simplex of a page.
template <int D>
CurvePlace<D> place_of(const PageView<D> &page, int simplex, const Domain<D> &domain) {
    CurvePlace<D> place;
    std::array<std::uint64_t, D + 1> codes;
    for (int i = 0; i <= D; ++i) {
        place.corners[i] = page.point(page.corner(simplex, i));
        codes[i] = domain.code(place.corners[i]);
    }
    place.key.code = *std::max_element(codes.begin(), codes.end());
    place.key.part = Domain<D>::part(corners_of(page, simplex), codes, D + 1);
    std::sort(place.corners.begin(), place.corners.end(), lexicographically_less<D>);
    return place;
}

} // namespace abacus
