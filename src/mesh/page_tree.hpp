// From a simplex to its child in the trees of a page (mesh/page_format.hpp): the one across a
// facet, with its vertices in an order of the same orientation and the point at infinity last.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

namespace abacus {

/// A facet of a simplex of a page, which is numbered by its place there.
using PageLink = std::uint16_t;
constexpr PageLink page_link(unsigned simplex, int facet) {
    return static_cast<PageLink>(simplex << 2 | static_cast<unsigned>(facet));
}
constexpr unsigned page_simplex(PageLink link) { return link >> 2; }
constexpr int page_facet(PageLink link) { return link & 3; }

/// The facet towards the parent of a child across facet `f`, unless its apex alone is at infinity.
constexpr int facet_back(int f) { return f ^ static_cast<int>(f < 2); }

/// The vertices of a simplex, four numbers in one word: in a page's reader by their places there,
/// in its writer by those in the cache. In the plane the last one is not a vertex.
inline constexpr int lanes = 4;
using Lanes = std::uint16_t __attribute__((vector_size(2 * lanes)));
using WideLanes = std::uint32_t __attribute__((vector_size(4 * lanes)));
inline constexpr std::uint16_t no_vertex = 0xffff;

/// All bits of lane `f`.
template <class Word>
inline constexpr std::array<Word, lanes> lane_masks = [] {
    constexpr std::remove_cvref_t<decltype(Word{}[0])> all = -1;
    return std::array{Word{all, 0, 0, 0}, Word{0, all, 0, 0}, Word{0, 0, all, 0},
                      Word{0, 0, 0, all}};
}();

/// Vertices of the simplex across facet `f` of `parent`, whose apex, in all lanes, is not at
/// infinity, or replaces what is. Which one it replaces no processor can foresee.
template <class Word> Word child_across(Word parent, int f, Word apex) {
    const Word corners = parent ^ ((parent ^ apex) & lane_masks<Word>[f]);
    return __builtin_shufflevector(corners, corners, 1, 0, 2, 3);
}
/// ... and where the apex is at infinity, across a facet that is not; the facet back is D.
template <int D, class Word> Word ghost_across(Word parent, int f, Word infinity) {
    parent[f] = parent[D];
    parent[D] = infinity[D];
    return parent;
}

/// The children of a simplex, by the facet across which it was reached, D + 1 of a root, and the
/// bits of its other facets: as facets of a simplex 0, and how many.
template <int D> struct Children {
    static constexpr int rows = D + 2, columns = 2 << D;

    std::array<std::array<Lanes, columns>, rows> facets{};
    std::array<std::array<std::uint8_t, columns>, rows> count{};

    constexpr Children() {
        for (int f = 0; f < rows; ++f)
            for (unsigned bits = 0; bits < columns; ++bits) {
                std::array<std::uint16_t, lanes + 1> facets{};
                std::uint8_t n = 0;
                unsigned bit = 0;
                for (int i = 0; i <= D; ++i) {
                    if (f <= D && i == facet_back(f)) continue; // the parent
                    facets[n] = static_cast<std::uint16_t>(i);
                    n = static_cast<std::uint8_t>(n + (bits >> bit++ & 1));
                }
                this->facets[f][bits] = Lanes{facets[0], facets[1], facets[2], facets[3]};
                count[f][bits] = n;
            }
    }
};
template <int D> inline constexpr Children<D> children{};

} // namespace abacus
