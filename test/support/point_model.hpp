// The points that a mesh should have after insertions and deletions, listed by place.
#pragma once

#include "support/oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <vector>

namespace abacus::test {

template <int D> class PointModel {
public:
    void insert(const std::vector<InputOf<D>> &points) {
        for (const InputOf<D> &p : points) places_[p.point].push_back(p);
        waiting_ = false;
    }
    /// Each point replaces all points at its place.
    void replace(const std::vector<InputOf<D>> &points) {
        for (const InputOf<D> &p : points) places_[p.point] = {p};
        waiting_ = false;
    }
    /// Whether each point has a place of its own.
    bool are_apart(const std::vector<InputOf<D>> &points) const {
        std::set<Point<D>> here;
        return std::all_of(points.begin(), points.end(), [&](const InputOf<D> &p) {
            return !places_.contains(p.point) && here.insert(p.point).second;
        });
    }
    void stage(const std::vector<InputOf<D>> &points) {
        insert(points);
        waiting_ = true;
    }
    /// If there are several points at a place, the one with the id goes, or else the first. Returns
    /// how many there were.
    std::uint64_t remove(const std::vector<InputOf<D>> &points) {
        std::uint64_t removed = 0;
        waiting_ = false;
        for (const InputOf<D> &p : points) {
            const auto place = places_.find(p.point);
            if (place == places_.end()) continue;
            auto &here = place->second;
            auto at = std::find_if(here.begin(), here.end(),
                                   [&](const InputOf<D> &other) { return other.id == p.id; });
            here.erase(at == here.end() ? here.begin() : at);
            if (here.empty()) places_.erase(place);
            ++removed;
        }
        return removed;
    }
    /// If there are several points at a place, the one with the id gets the attributes `which`, or
    /// else the first. Returns how many there were.
    std::uint64_t update(const std::vector<InputOf<D>> &points,
                         const std::vector<std::uint32_t> &which) {
        std::uint64_t updated = 0;
        waiting_ = false;
        for (const InputOf<D> &p : points) {
            const auto place = places_.find(p.point);
            if (place == places_.end()) continue;
            auto &here = place->second;
            auto at = std::find_if(here.begin(), here.end(),
                                   [&](const InputOf<D> &other) { return other.id == p.id; });
            if (at == here.end()) at = here.begin();
            for (std::size_t i = 0; i < which.size(); ++i)
                at->attributes[which[i]] = p.attributes[i];
            ++updated;
        }
        return updated;
    }
    /// Gives all points other attributes, in the way of abacus_build_change_attributes().
    void change_attributes(const std::vector<std::uint32_t> &source) {
        for (auto &[place, here] : places_)
            for (InputOf<D> &p : here) {
                std::vector<double> values;
                for (const std::uint32_t i : source)
                    values.push_back(i == ABACUS_NO_ATTRIBUTE
                                         ? std::numeric_limits<double>::quiet_NaN()
                                         : p.attributes[i]);
                p.attributes = values;
            }
    }
    std::vector<InputOf<D>> points() const {
        std::vector<InputOf<D>> all;
        for (const auto &[place, here] : places_) all.insert(all.end(), here.begin(), here.end());
        return all;
    }

    /// Compares simplices, ids and attributes, and runs the check.
    void expect(MeshOf<D> &mesh) const {
        if (!waiting_) {
            std::vector<Point<D>> distinct;
            for (const auto &[place, here] : places_) distinct.push_back(place);
            ASSERT_TRUE(mesh.positions() == cgal_simplices<D>(distinct));
        }
        ASSERT_EQ(mesh.check(), std::vector<std::string>{});
        expect_points(mesh);
        ASSERT_EQ(mesh.host.violations, std::vector<std::string>{});
        ASSERT_EQ(mesh.host.bytes, 0u);
    }

private:
    void expect_points(MeshOf<D> &mesh) const {
        abacus_vertex_scan *scan = nullptr;
        ASSERT_EQ(abacus_vertex_scan_open(mesh.host.table(), &mesh.header.facts, mesh.cache_bytes,
                                          &scan, &mesh.error),
                  ABACUS_OK);
        std::map<Point<D>, std::vector<std::int64_t>> seen;
        abacus_vertex v;
        while (abacus_vertex_scan_next(scan, &v, &mesh.error) == ABACUS_OK) {
            Point<D> p;
            std::copy_n(v.point, D, p.begin());
            const auto place = places_.find(p);
            ASSERT_NE(place, places_.end()) << "a point too many: " << v.id;
            if (!v.waits) {
                EXPECT_EQ(v.vertex, place->second.front().id);
            }
            const auto given =
                std::find_if(place->second.begin(), place->second.end(),
                             [&](const InputOf<D> &input) { return input.id == v.id; });
            ASSERT_NE(given, place->second.end()) << "a point with another id: " << v.id;
            ASSERT_TRUE(std::equal(
                given->attributes.begin(), given->attributes.end(), v.attributes,
                [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }));
            seen[p].push_back(v.id);
        }
        abacus_vertex_scan_close(scan);
        ASSERT_EQ(seen.size(), places_.size());
        for (const auto &[place, here] : places_) ASSERT_EQ(seen.at(place).size(), here.size());
    }

    bool waiting_ = false; // some points wait: there are not yet simplices of all
    std::map<Point<D>, std::vector<InputOf<D>>> places_; // in the order in which they came
};

} // namespace abacus::test
