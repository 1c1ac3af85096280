// How large the regions of a mesh in the plane are: their triangles, the edges of their borders,
// and their areas.
//
// The area is summed over the border (the shoelace formula). Products are taken without rounding,
// and so is their sum (geometry/exact_sum.hpp).
#pragma once

#include "query/locate/reader.hpp"
#include "sort/record_sort.hpp"

#include <abacus/regions.h>

#include <functional>

namespace abacus {

/// Calls visit(size) for all regions that have triangles, by their numbers.
void region_sizes(Reader<2> &reader, std::size_t memory,
                  const std::function<void(const abacus_region_size &)> &visit);

} // namespace abacus
