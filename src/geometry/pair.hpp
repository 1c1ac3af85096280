// Two doubles in one register. Each operation works on both and rounds each as if it
// were alone. So a determinant takes half the instructions and has the same bound on
// its error.
#pragma once

#include "geometry/point.hpp"

#include <cstring>

namespace abacus {

using Pair = double __attribute__((vector_size(16)));

inline Pair pair(double first, double second) { return Pair{first, second}; }
/// The point, in two dimensions.
inline Pair pair(const Point<2> &p) {
    Pair result;
    std::memcpy(&result, p.data(), sizeof result);
    return result;
}
inline Pair swapped(Pair a) { return __builtin_shufflevector(a, a, 1, 0); }
inline Pair firsts(Pair a, Pair b) { return __builtin_shufflevector(a, b, 0, 2); }
inline Pair seconds(Pair a, Pair b) { return __builtin_shufflevector(a, b, 1, 3); }

} // namespace abacus
