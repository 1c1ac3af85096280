// The mean of values by their weights.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace abacus {

/// The mean of n values, by weights that are not negative and sum to 1. It is not less than the
/// least of the values with a weight, nor greater than the greatest, in spite of rounding. The
/// others do not count, whatever they are. NaN if one that counts is NaN.
template <class Weight, class Value>
double weighted_mean(std::size_t n, Weight weight, Value value) {
    double mean = 0, least = INFINITY, greatest = -INFINITY;
    for (std::size_t i = 0; i < n; ++i) {
        if (weight(i) == 0) continue;
        const double x = value(i);
        mean += weight(i) * x;
        least = std::min(least, x);
        greatest = std::max(greatest, x);
    }
    return std::isnan(mean) ? mean : std::clamp(mean, least, greatest);
}

} // namespace abacus
