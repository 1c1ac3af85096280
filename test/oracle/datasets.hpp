// The point sets of the acceptance test, by name.
#pragma once

#include "coordinates.hpp"

#include <cstdint>
#include <string>

namespace abacus::oracle {

/// About `size` points, the same for the same seed everywhere.
/// Throws std::invalid_argument for a name that dataset_names() doesn't give.
template <int D> Points<D> dataset(const std::string &name, std::size_t size, std::uint64_t seed);

/// One line for each data set: name, dimensions and description.
std::string dataset_names();

} // namespace abacus::oracle
