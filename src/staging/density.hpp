// Whether a mesh can stand in for the first rounds of an insertion (rounds.hpp).
//
// These are there so that a point comes into a mesh of some of its neighbours-to-be, drawn
// at random. A mesh that has a good many vertices wherever the new points are does that as
// well. Then all points are one round: each page is loaded once, changed, and stored once,
// and no sparse round cuts full pages before the points come that fill the halves.
#pragma once

#include "geometry/point.hpp"
#include "host/arena.hpp"

#include <cstdint>

namespace abacus {

/// Whether nearly all points of a sample, given by their codes, which are sorted here, come
/// to pages that have at least so many vertices for each of them.
bool is_dense(const Host &host, Arena<std::uint64_t> &codes, double vertices_each);

} // namespace abacus
