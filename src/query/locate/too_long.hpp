// Simplices with an edge longer than a limit count as outside.
#pragma once

#include "geometry/longer_edge.hpp"
#include "query/locate/reader.hpp"
#include "query/pages/describe.hpp"

namespace abacus {

template <int D> bool is_too_long(const abacus_simplex &simplex, double max_edge) {
    return max_edge != no_max_edge && has_longer_edge<D>(D + 1, max_edge, [&](int i) {
               Point<D> p;
               std::copy_n(simplex.corner[i], D, p.begin());
               return p;
           });
}

/// Whether `a` is the answer of two simplices that contain a place: one that is too long is not.
template <int D>
bool is_preferred(const abacus_simplex &a, const abacus_simplex &b, double max_edge) {
    const bool a_long = is_too_long<D>(a, max_edge), b_long = is_too_long<D>(b, max_edge);
    return a_long != b_long ? b_long : comes_before<D>(a, b);
}

} // namespace abacus
