// An octree that is read, and its places and leaves as the C interface has them.
#pragma once

#include "octree/octree_reader.hpp"

#include "capi/dimension.hpp"

#include <abacus/octree.h>

struct abacus_octree {
    abacus_octree(const abacus_host *table, const abacus_facts &facts, std::size_t cache_bytes)
        : host(*table), reader(host, facts, cache_bytes) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::OctreeReader> reader;
};

namespace abacus {

template <int D> Point<D> place_of(const double *coordinates) {
    Point<D> place;
    std::copy_n(coordinates, D, place.begin());
    return place;
}

template <int D>
void describe(const Grid<D> &grid, const Octant<D> &leaf, const double *values,
              abacus_octant &octant) {
    octant.code = leaf.code;
    octant.level = leaf.level;
    const Box<D> box = grid.box(leaf);
    std::copy_n(box.lower.begin(), D, octant.lower);
    std::copy_n(box.upper.begin(), D, octant.upper);
    octant.values = values;
}

template <int D> void describe(OctreeReader<D> &reader, Handle h, abacus_octant &octant) {
    describe<D>(reader.grid(), reader.cache().octant(h), reader.cache().values(h), octant);
}

} // namespace abacus
