// Balance, 2 : 1: leaves that touch differ by one level at most.
//
// If an octant is split, its children are leaves or more; so what touches them must not be coarser
// than the octant itself. That is: for each of its neighbours, as large as it is and wherever one
// of its children touches it, the neighbour's parent must be split too. The least set that has this
// property is the least balanced octree. It is found from the deepest level up: what a level asks
// for belongs to the level above, so each is closed before it asks. Within a level the order does
// not matter, so requests are sorted, and memory is bounded. There are no ripples and no second
// pass.
#pragma once

#include "octree/split_octants.hpp"

namespace abacus {

/// Closes a rewound set. `across`: 1 for faces, 2 for edges too, D for corners too. In `balanced`
/// are then its members and what they ask for. Sorts in `memory` bytes.
template <int D>
void balance(const Host &host, SplitOctants<D> &octants, int across, std::size_t memory,
             SplitOctants<D> &balanced);

} // namespace abacus
