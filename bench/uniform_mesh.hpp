// Uniform points along the curve, and their mesh in the core alone: the beginning of several
// benchmarks.
#pragma once

#include "delaunay/insertion.hpp"
#include "delaunay/removal.hpp"
#include "support/memory_host.hpp"

#include <algorithm>
#include <random>
#include <vector>

namespace abacus::benchmarks {

template <int D> Domain<D> unit_domain() {
    Point<D> lower, upper;
    lower.fill(0);
    upper.fill(1);
    return {lower, upper};
}

enum Order { along_the_curve, random_order };

/// Uniform points along the curve, and half of them in the given order, by index.
template <int D> struct UniformPoints {
    std::vector<Point<D>> points;
    std::vector<std::size_t> removed;

    UniformPoints(std::size_t count, Order order) : points(count) {
        std::mt19937_64 engine(1);
        for (auto &p : points)
            for (double &x : p) x = double(engine() >> 11) * 0x1p-53;
        const Domain<D> domain = unit_domain<D>();
        std::sort(points.begin(), points.end(), [&](const Point<D> &a, const Point<D> &b) {
            return domain.code(a) < domain.code(b);
        });
        for (std::size_t i = 0; i < count; ++i)
            if (engine() % 2 == 0) removed.push_back(i);
        if (order == random_order) std::shuffle(removed.begin(), removed.end(), engine);
    }
};

/// Their mesh, in a cache of this size over a store in memory.
template <int D> struct UniformMesh {
    MemoryHost memory;
    const Host host = memory.host();
    Cache<D> cache;
    Delaunay<D> delaunay{host, cache, 0, 0};
    Insertion<D> insertion{delaunay};
    Removal<D> removal{delaunay};

    UniformMesh(const UniformPoints<D> &input, std::size_t cache_bytes)
        : cache(host, unit_domain<D>(), 0, {.budget = cache_bytes}) {
        memory.strict = false;
        const auto &points = input.points;
        std::array<VertexIndex, D + 1> first;
        for (int i = 0; i <= D; ++i) first[i] = cache.create_vertex(points[i], i, nullptr);
        insertion.start(first); // any D + 1 will do: no four random points are coplanar
        for (std::size_t i = D + 1; i < points.size(); ++i)
            insertion.insert(points[i], static_cast<std::int64_t>(i), nullptr);
        cache.counters = {};
    }
};

} // namespace abacus::benchmarks
