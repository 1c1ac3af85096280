#include "query/levels/contour_levels.hpp"

#include "host/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace abacus {

std::int64_t ContourLevels::rank(double value) const {
    if (how_.fixed_count == 0) return multiple_below(value);
    return std::upper_bound(how_.fixed, how_.fixed + how_.fixed_count, value) - how_.fixed - 1;
}

void ContourLevels::include(const ContourRanks &ranks) {
    all_.least = std::min(all_.least, ranks.least);
    all_.greatest = std::max(all_.greatest, ranks.greatest);
    if (all_.greatest - all_.least > most)
        throw Error(ABACUS_ERROR_ARGUMENT, "more than a thousand million levels are asked for",
                    "The least and the greatest value of the mesh are that many times "
                    "level_interval apart.",
                    "Give a greater level_interval, or fixed_levels.");
}

std::int64_t ContourLevels::multiple_below(double value) const {
    const double quotient = std::floor((value - how_.base) / how_.interval);
    if (std::abs(quotient) < 0x1p52) {
        // Rounding may have led to the level before or after.
        const auto near = static_cast<std::int64_t>(quotient);
        for (std::int64_t rank = near + 1; rank >= near - 1; --rank)
            if (level(rank) <= value && value < level(rank + 1)) return rank;
    }
    throw Error(ABACUS_ERROR_ARGUMENT, "level_interval is too small for the values of the mesh",
                "Levels there are closer to one another than numbers of double precision.",
                "Give a greater level_interval, or fixed_levels.");
}

double ContourLevels::level(std::int64_t number) const {
    if (how_.fixed_count == 0) return how_.base + static_cast<double>(number) * how_.interval;
    return number < 0 ? -std::numeric_limits<double>::infinity() : how_.fixed[number];
}

} // namespace abacus
