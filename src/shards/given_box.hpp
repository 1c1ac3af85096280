// A box as it comes through the C interface.
#pragma once

#include "geometry/box.hpp"

#include <abacus/shards.h>

#include <algorithm>

namespace abacus {

template <int D> Box<D> given_box(const abacus_box &given) {
    Box<D> box;
    std::copy_n(given.lower, D, box.lower.begin());
    std::copy_n(given.upper, D, box.upper.begin());
    return box;
}

} // namespace abacus
