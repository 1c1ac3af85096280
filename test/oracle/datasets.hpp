// The point sets of the acceptance test, by name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace abacus::oracle {

struct Point2 {
    double x, y;
};

/// About `size` points, the same for the same seed everywhere.
/// Throws std::invalid_argument for a name that is not in dataset_names().
std::vector<Point2> dataset(const std::string &name, std::size_t size, std::uint64_t seed);

/// One line a data set: name and what it is.
std::string dataset_names();

} // namespace abacus::oracle
