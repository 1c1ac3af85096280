// A mesh far larger than the cache of a reader, and places to be located in it.
#pragma once

#include "support/oracle.hpp"

#include <gtest/gtest.h>

#include <random>

namespace abacus::test {

using Random = std::mt19937_64;
inline constexpr std::size_t ample = 256 << 20;

template <int D> Point<D> unit_point(Random &random) {
    Point<D> p;
    for (double &x : p) x = std::uniform_real_distribution<double>(0, 1)(random);
    return p;
}

/// A mesh far larger than the cache of the reader whose answers are compared.
template <int D> struct Large : MeshOf<D> {
    explicit Large(int points, int attributes = 0) : MeshOf<D>(attributes, ample) {
        std::vector<InputOf<D>> input;
        for (int i = 0; i < points; ++i) {
            Point<D> p = unit_point<D>(random);
            if (i % 3 == 0) p[0] = p[0] * p[0] * p[0] * p[0]; // here and there denser
            if (i % 5 == 0) p[D - 1] = i % 64 / 64.0;         // and on a grid
            points_.push_back(p);
            input.push_back({i, p, std::vector<double>(static_cast<std::size_t>(attributes), 0.5)});
        }
        EXPECT_EQ(this->insert(input), ABACUS_OK) << this->error.detail;
    }
    std::size_t tenth() const { return this->host.pages.size() * ABACUS_PAGE_BYTES / 10; }
    /// A place inside, at a vertex, halfway to another one, or outside.
    Point<D> place(int round) {
        const auto &a = points_[random() % points_.size()], &b = points_[random() % points_.size()];
        Point<D> p = unit_point<D>(random);
        for (int i = 0; i < D; ++i) {
            if (round % 10 == 7) p[i] = a[i];
            if (round % 10 == 8) p[i] = a[i] + (b[i] - a[i]) / 2;
            if (round % 10 == 9) p[i] = 1.2 * p[i] - 0.1;
        }
        return p;
    }

    Random random{7};
    std::vector<Point<D>> points_;
};

} // namespace abacus::test
