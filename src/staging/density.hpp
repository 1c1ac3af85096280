// Whether a mesh can stand in for the first rounds of an insertion (rounds.hpp).
//
// The first rounds exist so that a point comes into a mesh of some of its future
// neighbours, drawn at random. A mesh that has enough vertices wherever the new points are
// serves as well. Then all points make one round. Each page is loaded once, changed, and
// stored once, and no sparse round cuts full pages before the points come that fill the
// halves.
#pragma once

#include "geometry/point.hpp"
#include "host/arena.hpp"

#include <cstdint>

namespace abacus {

/// Whether nearly all points of a sample, given by their codes, which are sorted here, come
/// to pages that have at least so many vertices for each of them.
bool is_dense(const Host &host, Arena<std::uint64_t> &codes, double vertices_each);

} // namespace abacus
