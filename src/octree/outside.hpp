// Errors of places and levels that an octree does not have.
#pragma once

#include "geometry/point.hpp"
#include "host/error.hpp"

#include <cstdint>
#include <cstdio>
#include <string>

namespace abacus {

template <int D> [[noreturn]] void throw_outside(const Point<D> &place) {
    std::string at;
    for (const double x : place) {
        char digits[32];
        std::snprintf(digits, sizeof digits, "%.17g", x);
        at += (at.empty() ? "" : ", ") + std::string(digits);
    }
    throw Error(ABACUS_ERROR_ARGUMENT, "a place lies outside the domain of the octree",
                "It is (" + at + ").");
}

[[noreturn]] inline void throw_no_level(std::int64_t level, int finest) {
    throw Error(ABACUS_ERROR_ARGUMENT, "level must be from 0 to " + std::to_string(finest) +
                                           ", not " + std::to_string(level));
}

} // namespace abacus
