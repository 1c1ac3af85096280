// Leaves of a stored octree: at a place, in a region, beside a leaf.
#pragma once

#include "octree/grid.hpp"
#include "octree/octree_cache.hpp"

namespace abacus {

template <int D> class OctreeReader {
public:
    OctreeReader(const Host &host, const abacus_facts &facts, std::size_t cache_bytes)
        : grid_(facts.form), cache_(host, facts, cache_bytes) {}

    const Grid<D> &grid() const { return grid_; }
    OctreeCache<D> &cache() { return cache_; }
    const OctreeCache<D> &cache() const { return cache_; }

    /// The leaf that has a place, or no_handle outside the domain. Handles die with the next call.
    Handle locate(const Point<D> &place) {
        Cell<D> cell;
        return grid_.find(place, cell) ? find(morton<D>(cell)) : no_handle;
    }
    Handle find(std::uint64_t cell) { return cache_.find(cell); }
    /// The first leaf along the curve that ends behind a cell and has one of the region, a CellBox
    /// or a BallCells; or no_handle.
    template <class Region> Handle next_in(const Region &region, std::uint64_t from) {
        const std::uint64_t cell = region.next(from);
        return cell == domain_cells<D> ? no_handle : find(cell);
    }
    /// Calls visit(axis, side, handle) for the leaves that share a piece of a face with the leaf
    /// that has a cell: below it on each axis, then above.
    template <class Visit> void neighbours(std::uint64_t cell, Visit visit) {
        const Octant<D> leaf = cache_.octant(find(cell));
        for (int axis = 0; axis < D; ++axis)
            for (int side = -1; side <= 1; side += 2) {
                Direction<D> way{};
                way[axis] = side;
                const auto beyond = leaf.neighbour(way);
                if (!beyond) continue;
                CellBox<D> layer{beyond->cell(), beyond->cell()};
                const auto length = static_cast<std::uint32_t>(leaf.edge() - 1);
                for (int i = 0; i < D; ++i)
                    if (i != axis)
                        layer.greatest[i] += length;
                    else if (side < 0)
                        layer.least[i] = layer.greatest[i] += length;
                for (std::uint64_t from = beyond->code;;) {
                    const Handle h = next_in(layer, from);
                    if (h == no_handle) break;
                    from = cache_.octant(h).end();
                    cache_.poll();
                    visit(axis, side, h);
                }
            }
    }

private:
    Grid<D> grid_;
    OctreeCache<D> cache_;
};

} // namespace abacus
