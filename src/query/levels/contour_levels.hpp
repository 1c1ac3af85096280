// The levels of contours, as numbers in ascending order.
#pragma once

#include <abacus/contours.h>

#include <cstdint>

namespace abacus {

struct ContourRanks {
    std::int64_t least, greatest;
};

class ContourLevels {
public:
    explicit ContourLevels(const abacus_contouring &contouring) : how_(contouring) {}

    /// The number of the greatest level that is not above a finite value: one less than the first
    /// if there is none. Throws if levels cannot be distinguished there.
    std::int64_t rank(double value) const;
    /// Includes the ranks of contours that are needed. Throws if there are too many levels between
    /// all that have been included.
    void include(const ContourRanks &ranks);
    /// The level with this rank; -infinity below all levels.
    double level(std::int64_t number) const;

private:
    static constexpr std::int64_t most = 1'000'000'000;

    std::int64_t multiple_below(double value) const;

    const abacus_contouring how_;
    ContourRanks all_{INT64_MAX, INT64_MIN}; // included so far
};

} // namespace abacus
