// What the tests of changes by several threads share.
#pragma once

#include "support/oracle.hpp"
#include "support/running_threads.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace abacus::test {

inline constexpr std::size_t little = 300 << 10, ample = 64 << 20;

template <class Dimension> class ThreadsTest : public testing::Test {
protected:
    static constexpr int D = Dimension::value;
    using Points = std::vector<Point<D>>;

    Points uniform(int n) {
        std::uniform_real_distribution<double> unit(0, 1);
        Points points(n);
        for (Point<D> &p : points)
            for (double &x : p) x = unit(random);
        return points;
    }
    std::vector<InputOf<D>> with_ids(const Points &points) {
        std::vector<InputOf<D>> inputs;
        for (const Point<D> &p : points)
            inputs.push_back(
                {next_id++, p, {std::uniform_real_distribution<double>(0, 1)(random)}});
        return inputs;
    }
    /// Its simplices by ids, and the corners of each simplex: with one thread and with several.
    static std::vector<std::vector<std::int64_t>> ids(MeshOf<D> &mesh) {
        std::vector<std::vector<std::int64_t>> result;
        for (const abacus_simplex &s : mesh.simplices(false)) {
            result.emplace_back(s.id, s.id + D + 1);
            std::sort(result.back().begin(), result.back().end());
        }
        std::sort(result.begin(), result.end());
        return result;
    }
    std::mt19937_64 random{17};
    std::int64_t next_id = 0;
};

} // namespace abacus::test
