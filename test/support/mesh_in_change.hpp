// A mesh in which a test inserts points and removes vertices, over a host of its own, with the
// points that it should have.
#pragma once

#include "delaunay/insertion.hpp"
#include "delaunay/removal.hpp"
#include "keys/domain_of.hpp"
#include "support/oracle.hpp"

#include <abacus/mesh_header.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace abacus::test {

/// The bounding box of the points, as a domain.
template <int D> Domain<D> box_around(const std::vector<Point<D>> &points) {
    Point<D> lower, upper;
    lower.fill(std::numeric_limits<double>::max());
    upper.fill(std::numeric_limits<double>::lowest());
    for (const Point<D> &p : points)
        for (int i = 0; i < D; ++i) {
            lower[i] = std::min(lower[i], p[i]);
            upper[i] = std::max(upper[i], p[i]);
        }
    return {lower, upper};
}

template <int D> class MeshInChange {
public:
    MeshInChange(const Domain<D> &box, std::size_t cache_bytes, int attributes = 0)
        : mesh_(attributes), host_(mesh_.host.host()),
          cache(host_, domain_around<D>(box.lower(), box.upper()), attributes,
                {.budget = cache_bytes, .verify_links = true}),
          delaunay(host_, cache, 0, 0), insertion(delaunay), removal(delaunay) {
        mesh_.header.facts.form.has_domain = 1;
        std::copy_n(box.lower().begin(), D, mesh_.header.facts.form.lower);
        std::copy_n(box.upper().begin(), D, mesh_.header.facts.form.upper);
    }

    /// Starts the mesh with these points, in some order; false if they span no simplex.
    bool build(const std::vector<Point<D>> &points) {
        std::array<Point<D>, D + 1> first;
        Corners<D> corners;
        int n = 0;
        for (const Point<D> &p : points) {
            if (n == D + 1 || !is_independent(corners, n, p)) continue;
            first[n] = p;
            corners[n] = &first[n];
            ++n;
        }
        if (n <= D) return false;
        std::array<VertexIndex, D + 1> vertices;
        for (int i = 0; i <= D; ++i)
            vertices[i] = cache.create_vertex(first[i], next_id_++, nullptr);
        insertion.start(vertices);
        for (const Point<D> &p : points) insertion.insert(p, next_id_++, nullptr);
        return true;
    }

    /// Stores a mesh with this many vertices; returns its faults.
    std::vector<std::string> check(std::size_t vertices) {
        cache.flush();
        if (const char *fault = cache.check_invariants()) return {fault};
        mesh_.header.facts.census.vertices = vertices;
        mesh_.header.facts.census.simplices = static_cast<std::uint64_t>(delaunay.simplices());
        mesh_.header.facts.census.ghosts = static_cast<std::uint64_t>(delaunay.ghosts());
        return mesh_.check();
    }

    /// Checks the stored mesh, and compares it with CGAL's triangulation of these points.
    void verify(const std::vector<Point<D>> &points) {
        ASSERT_EQ(check(points.size()), std::vector<std::string>{});
        ASSERT_TRUE(mesh_.positions() == cgal_simplices<D>(points));
        ASSERT_EQ(mesh_.host.violations, std::vector<std::string>{});
    }

    abacus_header &header() { return mesh_.header; }
    MemoryHost &memory() { return mesh_.host; }
    const Host &host() const { return host_; }

private:
    MeshOf<D> mesh_;
    const Host host_;
    std::int64_t next_id_ = 0;

public:
    Cache<D> cache;
    Delaunay<D> delaunay;
    Insertion<D> insertion;
    Removal<D> removal;
};

/// Each point once, in lexicographic order.
template <class Points> Points distinct(Points points) {
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return points;
}

} // namespace abacus::test
