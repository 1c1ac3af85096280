// An octree made elsewhere, leaf by leaf: a linear octree. Its leaves have to tile the domain.
#pragma once

#include "octree/leaf_scan.hpp"
#include "octree/leaf_writer.hpp"
#include "sort/record_sort.hpp"

#include <abacus/mesh_header.h>

namespace abacus {

template <int D> class OctreeLoad {
public:
    OctreeLoad(const Host &host, const abacus_facts &facts, std::size_t memory)
        : host_(host), facts_(facts), leaves_(host, 3 + facts.columns.attributes, 2, memory) {}

    /// The next row.
    void add(std::uint64_t code, std::int64_t level, const double *values);
    /// Throws Error (argument) that names a row which overlaps another or leaves a gap.
    void write(abacus_header &header);

private:
    const Host &host_;
    const abacus_facts facts_;
    RecordSort leaves_; // code, level, row, attributes
};

} // namespace abacus
