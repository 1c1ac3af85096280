// How many simplices fit into a page.
//
// A block is split by the number of its simplices, a page is full by its bytes. What a simplex
// takes depends on ids, attributes, coordinates, so on the mesh, but also on the place in it:
// where a coordinate comes near to 0 its numbers have many exponents, and the page next to one
// of 760 tetrahedra may hold 610. So each page that is made or loaded tells how many like its
// own would fill it, and a block keeps that as its capacity; blocks of which nothing is known
// get the mean of the pages of late.
#pragma once

#include "mesh/page_format.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace abacus {

template <int D> class PageCapacity {
public:
    explicit PageCapacity(int attributes) : mean_(room / most_bytes(attributes)) {}

    /// Simplices that fit into a page, as far as is known.
    std::uint16_t usual() const { return in_a_block(mean_); }

    /// Learns from a page; one not yet stored tells as much. Returns how many simplices fit into a
    /// page like it.
    std::uint16_t learn(std::uint32_t simplices, std::size_t page_bytes) {
        if (simplices == 0) return usual();
        const double bytes = std::max<double>(page_bytes, overhead + simplices) - overhead;
        const double share = bytes / room;
        const double fit = simplices * std::pow(share, -1 / growth);
        // Quickly from the first pages, then slowly; a crumb hardly counts.
        known_ = std::min(known_ + share, most_known);
        mean_ += (fit - mean_) * std::min(share / known_, 1.0);
        return in_a_block(fit);
    }

private:
    /// Bytes of a page that are not those of its simplices.
    static constexpr double overhead = sizeof(PageHeader) + checksum_bytes + 40;
    static constexpr double room = ABACUS_PAGE_BYTES - overhead;
    /// Of what would fit: pages differ, and one that turns out too large has to be split.
    static constexpr double margin = 0.97;
    /// The fewer simplices, the more of them lie on the border, where they take more bytes. So a
    /// page's bytes grow with this power of its simplices: of pages with 100 to 770 of them, in
    /// meshes of uniform points that came and went.
    static constexpr double growth = D == 2 ? 0.93 : 0.78;
    static constexpr double most_known = 8; // pages

    /// What a simplex takes when words are stored whole. In a mesh of good shape there are 0.58
    /// vertices a triangle, 0.36 a tetrahedron.
    static double most_bytes(int attributes) {
        const double vertex = 8.0 * (1 + D + attributes);
        return D == 2 ? 0.58 * vertex + 0.19 * 8 + 3 : 0.36 * vertex + 0.9 * 8 + 4;
    }
    static std::uint16_t in_a_block(double fit) {
        return static_cast<std::uint16_t>(std::clamp<double>(margin * fit, 8, block_slots<D>));
    }

    double mean_;
    double known_ = 0; // pages that the mean is of: nothing yet, but a guess
};

} // namespace abacus
