// Leaves of an octree along the curve: all of them, page by page past any cache, or those that meet
// a window, a box or a ball, of which only the pages that have some are read.
#pragma once

#include "octree/ball_cells.hpp"
#include "octree/leaf_scan.hpp"
#include "octree/octree_reader.hpp"

#include <optional>

namespace abacus {

template <int D> class OctreeScan {
public:
    OctreeScan(const Host &host, const abacus_facts &facts) : grid_(facts.form) {
        all_.emplace(host, facts);
    }
    OctreeScan(const Host &host, const abacus_facts &facts, const Box<D> &box,
               std::size_t cache_bytes)
        : grid_(facts.form) {
        reader_.emplace(host, facts, cache_bytes);
        if (!grid_.find(box, box_)) at_ = domain_cells<D>;
    }
    OctreeScan(const Host &host, const abacus_facts &facts, const Ball<D> &ball,
               std::size_t cache_bytes)
        : grid_(facts.form) {
        reader_.emplace(host, facts, cache_bytes);
        ball_.emplace(grid_, ball);
    }

    const Grid<D> &grid() const { return grid_; }

    /// The next leaf, and its attributes, valid until the one after is asked for; false after the
    /// last.
    bool next(Octant<D> &leaf, const double *&values) {
        return all_ ? next_of_all(leaf, values) : next_in_window(leaf, values);
    }

private:
    bool next_of_all(Octant<D> &leaf, const double *&values) {
        if (!all_->next()) return false;
        leaf = all_->leaf();
        values = all_->values();
        return true;
    }
    bool next_in_window(Octant<D> &leaf, const double *&values) {
        if (at_ == domain_cells<D>) return false;
        const Handle h = ball_ ? reader_->next_in(*ball_, at_) : reader_->next_in(box_, at_);
        at_ = domain_cells<D>;
        if (h == no_handle) return false;
        leaf = reader_->cache().octant(h);
        values = reader_->cache().values(h);
        at_ = leaf.end();
        return true;
    }

    Grid<D> grid_;
    std::optional<LeafScan<D>> all_;
    std::optional<OctreeReader<D>> reader_; // in place of all
    CellBox<D> box_{};
    std::optional<BallCells<D>> ball_; // in place of the box
    std::uint64_t at_ = 0;
};

} // namespace abacus
