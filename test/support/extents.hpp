// Extents of questions.
#pragma once

#include <abacus/extent.h>

namespace abacus::test {

/// Simplices without a longer edge.
inline abacus_extent up_to(double max_edge) {
    abacus_extent extent{};
    extent.max_edge = max_edge;
    return extent;
}

} // namespace abacus::test
