// Octrees for tests: with an attribute on several pages, and a size that grows from a place.
#pragma once

#include "octree/octree_check.hpp"
#include "support/octree_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace abacus::test {

template <int D> void expect_sound(const StoredOctree<D> &octree) {
    const Host h = octree.host->host();
    OctreeCheck<D> check(h, octree.header, 10);
    abacus_fault fault;
    while (check.next(fault)) ADD_FAILURE() << fault.kind << ": " << fault.message;
    EXPECT_THAT(octree.host->violations, testing::IsEmpty());
}

struct SizesAsked {
    std::uint64_t asked = 0;
};

template <int D>
abacus_host_status size_near_center(void *context, std::size_t count, const double *const *centers,
                                    const double *, double *sizes) {
    static_cast<SizesAsked *>(context)->asked += count;
    for (std::size_t k = 0; k < count; ++k) {
        double square = 0;
        for (int i = 0; i < D; ++i) square += (centers[i][k] - 0.3) * (centers[i][k] - 0.3);
        sizes[k] = 0.02 + std::sqrt(square) / 3;
    }
    return ABACUS_HOST_OK;
}

/// An octree of some ten thousand leaves with an attribute, its own code, on several pages.
template <int D> struct Coded : StoredOctree<D> {
    OctreeModel<D> model;
    std::mt19937_64 random{6};

    Coded() : StoredOctree<D>(2) {
        const auto cells = random_cells<D>(random, 3000, D == 2 ? 10 : 7);
        this->split_to(cells);
        for (const auto &[cell, level] : cells) model.split_to(cell, level);
        const Host h = this->host->host();
        OctreeEdit<D> edit(h, this->header, this->memory, std::size_t{1} << 20);
        for (const auto &[code, level] : model.leaves) {
            const double values[2] = {static_cast<double>(code >> 12), level + 0.1};
            edit.set_at(code, values);
        }
        EXPECT_EQ(edit.set(this->header), model.leaves.size());
        EXPECT_GT(this->host->pages.size(), 5u);
    }
};

} // namespace abacus::test
