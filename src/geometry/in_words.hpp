// Points as they are written in errors.
#pragma once

#include "geometry/point.hpp"

#include <charconv>
#include <string>

namespace abacus {

/// With as few digits as identify each coordinate.
template <std::size_t D> std::string in_words(const std::array<double, D> &p) {
    std::array<char, 64> digits;
    std::string words = "(";
    for (const double x : p) {
        if (words.size() > 1) words += ", ";
        words.append(digits.data(), std::to_chars(digits.begin(), digits.end(), x).ptr);
    }
    return words + ")";
}

} // namespace abacus
