// Simplices as a type of data in the block cache (blocks/data_type.hpp).
#pragma once

#include "blocks/data_type.hpp"
#include "blocks/page_capacity.hpp"
#include "blocks/replacement.hpp"
#include "mesh/page_format.hpp"
#include "mesh/simplex.hpp"

#include <abacus/facts.h>
#include <abacus/mesh_counters.h>

namespace abacus {

/// The vertices that came with a block's page: where they lie, so that they can be asked for.
struct VertexRun {
    VertexIndex first;
    std::uint16_t count; ///< their numbers are mostly in a row, so long
};

template <int D> struct SimplexBlocks {
    using Record = Simplex<D>;
    using Note = VertexRun;
    using Counters = abacus_counters;
    static constexpr std::uint32_t slots = block_slots<D>;
    static constexpr std::uint64_t handles_end = 1u << 29; // a link has 29 bits for the handle
    static constexpr abacus_page_kind page_kind = ABACUS_SIMPLEX_PAGES;
    static constexpr const char *a_record = "A simplex", *records = "simplices", *whole = "mesh";
};
static_assert(BlockDescription<SimplexBlocks<2>> && BlockDescription<SimplexBlocks<3>>);

/// What pages of simplices with so many attributes are like.
template <int D> constexpr PageShape simplex_pages(int attributes) {
    constexpr double overhead = sizeof(PageHeader) + checksum_bytes + 40;
    // Of pages with 100 to 770 simplices, in meshes of uniform points that came and went.
    constexpr double growth = D == 2 ? 0.93 : 0.78;
    // What a simplex takes when words are stored whole. In a mesh of good shape there are 0.58
    // vertices a triangle, 0.36 a tetrahedron.
    const double vertex = 8.0 * (1 + D + attributes);
    const double simplex = D == 2 ? 0.58 * vertex + 0.19 * 8 + 3 : 0.36 * vertex + 0.9 * 8 + 4;
    return {.overhead = overhead,
            .room = ABACUS_PAGE_BYTES - overhead,
            .record_bytes = simplex,
            .inverse_growth = -1 / growth,
            .slots = block_slots<D>};
}

/// What the last pass along the curve is given for itself. In the plane more room gains nothing
/// over a stored mesh.
template <int D> constexpr Replacement::LastPassRoom last_pass_room() {
    constexpr std::size_t mb = std::size_t{1} << 20;
    if (D == 2) return {.after_others = 16 * mb, .alone = 16 * mb};
    return {.after_others = 48 * mb, .alone = 96 * mb};
}

} // namespace abacus
