#pragma once

#include "geometry/locational_code.hpp"

#include <abacus/abacus.h>

#include <algorithm>

namespace abacus {

/// The domain of a mesh, from its header.
template <int D> Domain<D> domain_of(const abacus_header &header) {
    Point<D> lower, upper;
    std::copy_n(header.lower, D, lower.begin());
    std::copy_n(header.upper, D, upper.begin());
    return {lower, upper};
}

} // namespace abacus
