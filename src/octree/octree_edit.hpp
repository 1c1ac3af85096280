// Changes of single leaves, in place: attributes set, leaves merged. They are sorted along the
// curve first, so each page is loaded once, and the order in which they come does not matter.
#pragma once

#include "octree/grid.hpp"
#include "octree/octree_cache.hpp"
#include "sort/record_sort.hpp"

#include <abacus/mesh_header.h>

namespace abacus {

template <int D> class OctreeEdit {
public:
    OctreeEdit(const Host &host, const abacus_facts &facts, std::size_t memory,
               std::size_t cache_bytes)
        : host_(host), pacer_(host), attributes_(facts.columns.attributes), grid_(facts.form),
          cache_(host, facts, cache_bytes), changes_(host, 3 + attributes_, 3, memory) {}

    std::size_t attributes() const { return attributes_; }
    /// The octant of a level that has a place shall be a leaf, unless it lies in one.
    void merge_at(const Point<D> &place, std::int64_t level);
    /// The leaf that has a cell gets these attributes; of several for one leaf, the last.
    void set_at(std::uint64_t cell, const double *values);

    /// Each does its edits, and brings the header up to date. Returns how many leaves were
    /// merged, or set.
    std::uint64_t merge(abacus_header &header);
    std::uint64_t set(abacus_header &header);

private:
    void reached(std::uint64_t done);
    void finish(abacus_header &header);

    const Host &host_;
    Pacer pacer_;
    std::size_t attributes_;
    Grid<D> grid_;
    OctreeCache<D> cache_;
    RecordSort changes_; // code, level, number, attributes
};

} // namespace abacus
