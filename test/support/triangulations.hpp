// Triangulations for loading: vertices and simplices by their ids, made from others.
#pragma once

#include "geometry/predicates.hpp"
#include "support/oracle.hpp"

#include <algorithm>
#include <map>
#include <random>

namespace abacus::test {

template <int D> using Ids = std::array<std::int64_t, D + 1>;

template <int D> struct Triangulation {
    std::vector<InputOf<D>> vertices;
    std::vector<Ids<D>> simplices;

    const Point<D> &point(std::int64_t id) const {
        return std::find_if(vertices.begin(), vertices.end(),
                            [&](const auto &v) { return v.id == id; })
            ->point;
    }
    /// Removes vertices without simplices.
    void tidy() {
        std::vector<std::int64_t> used;
        for (const Ids<D> &s : simplices) used.insert(used.end(), s.begin(), s.end());
        std::sort(used.begin(), used.end());
        std::erase_if(vertices, [&](const auto &v) {
            return !std::binary_search(used.begin(), used.end(), v.id);
        });
    }
    /// Changes the order of rows and of corners.
    void shuffle(unsigned seed) {
        std::mt19937_64 random(seed);
        std::shuffle(vertices.begin(), vertices.end(), random);
        std::shuffle(simplices.begin(), simplices.end(), random);
        for (Ids<D> &s : simplices) std::shuffle(s.begin(), s.end(), random);
    }
    /// Adds the other's simplices; moves its ids.
    void add(const Triangulation &other, std::int64_t by) {
        for (auto v : other.vertices) {
            v.id += by;
            vertices.push_back(v);
        }
        for (auto s : other.simplices) {
            for (auto &id : s) id += by;
            simplices.push_back(s);
        }
    }
};

/// CGAL's Delaunay triangulation; the ids are the points' numbers, times 3 less 7.
template <int D> Triangulation<D> delaunay(const std::vector<Point<D>> &points) {
    Triangulation<D> result;
    std::map<Point<D>, std::int64_t> ids;
    for (const Point<D> &p : points)
        if (ids.emplace(p, 3 * static_cast<std::int64_t>(ids.size()) - 7).second)
            result.vertices.push_back({ids[p], p});
    for (const Positions<D> &s : cgal_simplices<D>(points)) {
        Ids<D> simplex;
        for (int i = 0; i <= D; ++i) simplex[i] = ids[s[i]];
        result.simplices.push_back(simplex);
    }
    result.tidy();
    return result;
}

/// Only the simplices for which keep(centre) holds.
template <int D, class Keep> Triangulation<D> keeping(Triangulation<D> t, Keep keep) {
    std::map<std::int64_t, Point<D>> at;
    for (const auto &v : t.vertices) at[v.id] = v.point;
    std::erase_if(t.simplices, [&](const Ids<D> &s) {
        Point<D> centre{};
        for (const std::int64_t id : s)
            for (int i = 0; i < D; ++i) centre[i] += at[id][i] / (D + 1);
        return !keep(centre);
    });
    t.tidy();
    return t;
}

/// Flips edges at random where the two triangles make a convex quadrilateral.
inline void flip(Triangulation<2> &t, int flips, unsigned seed) {
    std::map<std::int64_t, Point<2>> at;
    for (const auto &v : t.vertices) at[v.id] = v.point;
    std::mt19937_64 random(seed);
    for (int i = 0; i < flips; ++i) {
        auto &s = t.simplices[random() % t.simplices.size()];
        const int k = static_cast<int>(random() % 3);
        const std::int64_t a = s[(k + 1) % 3], b = s[(k + 2) % 3], p = s[k];
        for (auto &n : t.simplices) {
            if (&n == &s ||
                std::count(n.begin(), n.end(), a) + std::count(n.begin(), n.end(), b) != 2)
                continue;
            const std::int64_t q =
                *std::find_if(n.begin(), n.end(), [&](auto id) { return id != a && id != b; });
            if (orientation(at[p], at[q], at[a]) * orientation(at[p], at[q], at[b]) >= 0) break;
            s = {p, q, a};
            n = {p, q, b};
            break;
        }
    }
}

/// 2-3 flips at random: two tetrahedra become three around the line between their tips.
inline void flip(Triangulation<3> &t, int flips, unsigned seed) {
    std::map<std::int64_t, Point<3>> at;
    for (const auto &v : t.vertices) at[v.id] = v.point;
    std::mt19937_64 random(seed);
    for (int i = 0; i < flips; ++i) {
        const std::size_t first = random() % t.simplices.size();
        Ids<3> s = t.simplices[first];
        std::swap(s[0], s[random() % 4]);
        for (std::size_t k = 0; k < t.simplices.size(); ++k) {
            const Ids<3> n = t.simplices[k];
            const auto has = [&](std::int64_t id) { return std::count(n.begin(), n.end(), id); };
            if (k == first || has(s[0]) || has(s[1]) + has(s[2]) + has(s[3]) != 3) continue;
            std::int64_t q = 0;
            for (const auto id : n)
                if (std::count(s.begin(), s.end(), id) == 0) q = id;
            const Point<3> &top = at[s[0]], &bottom = at[q];
            int signs[3];
            for (int j = 0; j < 3; ++j)
                signs[j] = orientation(top, bottom, at[s[1 + j]], at[s[1 + (j + 1) % 3]]);
            if (signs[0] == 0 || signs[0] != signs[1] || signs[1] != signs[2]) break;
            t.simplices[first] = {s[0], q, s[1], s[2]};
            t.simplices[k] = {s[0], q, s[2], s[3]};
            t.simplices.push_back({s[0], q, s[3], s[1]});
            break;
        }
    }
}

} // namespace abacus::test
