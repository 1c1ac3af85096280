// Which of two simplices that contain a place is the answer.
#pragma once

#include "query/pages/describe.hpp"
#include "query/pages/extent.hpp"

namespace abacus {

/// Whether `a` is: one that does not count is not.
template <int D>
bool is_preferred(const abacus_simplex &a, const abacus_simplex &b, const abacus_extent &extent) {
    const bool has_a = is_in<D>(extent, a), has_b = is_in<D>(extent, b);
    return has_a != has_b ? has_a : comes_before<D>(a, b);
}

} // namespace abacus
