// Coordinates as they are stored: finite, and zero without a sign.
#pragma once

#include "host/host.hpp"

#include <cstdint>
#include <string>

namespace abacus {

[[noreturn]] inline void throw_not_finite(std::uint64_t id, int axis) {
    throw Error(ABACUS_ERROR_ARGUMENT,
                "point " + std::to_string(static_cast<std::int64_t>(id)) +
                    " has a coordinate that is not a finite number",
                std::string("The coordinate is ") + "xyz"[axis] + ".",
                "Leave such points out in the source query.");
}

/// Makes the coordinates of a record canonical; throws an Error (argument) if they are not
/// finite.
template <int D> void make_canonical(std::uint64_t *record) {
    constexpr std::uint64_t exponent = 0x7ffull << 52, minus_zero = 1ull << 63;
    for (int axis = 0; axis < D; ++axis) {
        std::uint64_t &coordinate = record[1 + axis];
        if ((coordinate & exponent) == exponent) [[unlikely]]
            throw_not_finite(record[0], axis);
        if (coordinate == minus_zero) coordinate = 0;
    }
}

} // namespace abacus
