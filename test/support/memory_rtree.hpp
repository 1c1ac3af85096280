// An R-tree for tests, without a tree: every search compares every box.
#pragma once

#include "host/host.hpp"

#include <abacus/goose.h>
#include <algorithm>
#include <cstdint>
#include <map>
#include <vector>

namespace abacus::test {

template <int D> class MemoryRTree {
public:
    MemoryRTree() : table_{this, search, unlink, erase, insert} {}
    MemoryRTree(const MemoryRTree &) = delete;
    MemoryRTree &operator=(const MemoryRTree &) = delete;

    const abacus_rtree *table() const { return &table_; }
    /// The finite simplices, or the ghosts.
    std::vector<abacus_simplex> simplices(bool ghosts) const {
        std::vector<abacus_simplex> result;
        for (const auto &[location, row] : rows)
            if ((row.simplex.ghost != 0) == ghosts) result.push_back(row.simplex);
        return result;
    }

    std::map<std::uint64_t, abacus_boxed_simplex> rows; ///< in the tree, by location
    std::uint64_t unlinked = 0;                         ///< out of it, and not erased yet
    std::uint64_t calls = 0;
    std::uint64_t fail_at = 0; ///< this call fails; 0 = none
    bool blind = false;        ///< searches find nothing

private:
    static MemoryRTree &enter(void *context, abacus_host_status &status) {
        MemoryRTree &tree = *static_cast<MemoryRTree *>(context);
        status = ++tree.calls == tree.fail_at ? ABACUS_HOST_FAILED : ABACUS_HOST_OK;
        return tree;
    }

    static abacus_host_status search(void *context, const double *point,
                                     const abacus_boxed_simplex **found, std::size_t *count,
                                     std::uint64_t *boxes) {
        abacus_host_status status;
        MemoryRTree &tree = enter(context, status);
        tree.found_.clear();
        for (const auto &[location, row] : tree.rows) {
            bool inside = !tree.blind;
            for (int k = 0; k < D; ++k)
                inside &= row.lower[k] <= point[k] && point[k] <= row.upper[k];
            if (inside) tree.found_.push_back(row);
        }
        *found = tree.found_.data();
        *count = tree.found_.size();
        *boxes += tree.rows.size();
        return status;
    }
    static abacus_host_status unlink(void *context, const abacus_boxed_simplex *row,
                                     std::uint64_t *boxes) {
        abacus_host_status status;
        MemoryRTree &tree = enter(context, status);
        if (status == ABACUS_HOST_FAILED) return status;
        *boxes += tree.rows.size();
        if (tree.rows.erase(row->location) == 0) return ABACUS_HOST_NONE;
        ++tree.unlinked;
        return ABACUS_HOST_OK;
    }
    static abacus_host_status erase(void *context, const abacus_boxed_simplex *) {
        abacus_host_status status;
        --enter(context, status).unlinked;
        return status;
    }
    static abacus_host_status insert(void *context, const abacus_boxed_simplex *row) {
        abacus_host_status status;
        MemoryRTree &tree = enter(context, status);
        abacus_boxed_simplex &stored = tree.rows[++tree.last_location_];
        stored = *row;
        stored.location = tree.last_location_;
        return status;
    }

    abacus_rtree table_;
    std::vector<abacus_boxed_simplex> found_;
    std::uint64_t last_location_ = 0;
};

} // namespace abacus::test
