// Octrees for tests: on several pages, or fine in a few places; and a size that grows from a place.
#pragma once

#include "octree/octree_check.hpp"
#include "support/octree_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace abacus::test {

using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;

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

/// Fine at a corner and in some places. One attribute is a function of the code; another one is
/// missing in some leaves.
template <int D> class AskedOctree : public StoredOctree<D> {
public:
    explicit AskedOctree(std::uint64_t seed) : StoredOctree<D>(2) {
        std::mt19937_64 random(seed);
        auto cells = random_cells<D>(random, 25, D == 2 ? 7 : 5);
        cells.push_back({domain_cells<D> / 2 - 1, 9});
        this->split_to(cells);
        fill();
    }
    /// Gives the leaves their attributes.
    void fill() {
        const Host h = this->host->host();
        OctreeEdit<D> edit(h, this->header, this->memory, this->memory);
        for (const Octant<D> &leaf : this->list()) {
            const double values[] = {first(leaf), second(leaf)};
            edit.set_at(leaf.code, values);
        }
        edit.set(this->header);
    }
    static double first(const Octant<D> &leaf) {
        return std::ldexp(static_cast<double>(leaf.code * 0x9e3779b97f4a7c15u >> 12), -40);
    }
    static double second(const Octant<D> &leaf) {
        return (leaf.code * 0x9e3779b97f4a7c15u >> 60) == 0 ? NAN : 7;
    }
};

/// Places anywhere, on lines of the grid, and beyond the domain.
template <int D> Point<D> random_place(std::mt19937_64 &random) {
    Point<D> p;
    for (double &x : p) switch (random() % 4) {
        case 0:
            x = std::ldexp(static_cast<double>(random() % 33), -5);
            break;
        case 1:
            x = std::ldexp(static_cast<double>(random() % 5), -2);
            break;
        case 2:
            x = std::ldexp(static_cast<double>(random() % 1000), -9) - 0.5;
            break;
        default:
            x = std::ldexp(static_cast<double>(random() % 100000), -17);
        }
    return p;
}

} // namespace abacus::test
