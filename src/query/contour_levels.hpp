// The levels of contours, as numbers in ascending order.
#pragma once

#include <abacus/contours.h>

#include <cstdint>

namespace abacus {

class ContourLevels {
public:
    explicit ContourLevels(const abacus_contouring &contouring) : how_(contouring) {}

    /// The number of the greatest level that is not above a finite value: one less than the first
    /// if there is none. Throws if levels cannot be told apart there, and if there are more of them
    /// between the values so far than anybody waits for.
    std::int64_t rank(double value);
    /// Of a number that is a rank; -infinity below all levels.
    double level(std::int64_t number) const;

private:
    static constexpr std::int64_t most = 1'000'000'000;

    std::int64_t multiple_below(double value) const;

    const abacus_contouring how_;
    bool has_rank_ = false;
    std::int64_t least_ = 0, greatest_ = 0; // ranks so far
};

} // namespace abacus
