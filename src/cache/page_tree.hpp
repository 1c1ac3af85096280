// From a simplex to its child in the trees of a page (cache/page_format.hpp): the one across a
// facet, with its vertices in an order of the same orientation and the point at infinity last.
// What the writer of a page says, vertex by vertex, the reader does with four numbers at once.
#pragma once

#include <array>
#include <cstdint>
#include <utility>

namespace abacus {

/// The facet towards the parent of a child across facet `f`, unless its apex alone is at infinity.
constexpr int facet_back(int f) { return f ^ static_cast<int>(f < 2); }

/// Vertices of the simplex across facet `f` of `parent`, whose apex is `apex`; and the facet
/// towards the parent.
template <int D, class Number>
constexpr int child_across(const Number *parent, int f, Number apex, Number infinity,
                           Number *child) {
    std::array<Number, D + 1> corner;
    for (int i = 0; i <= D; ++i) { // which one is replaced no processor can foresee
        const auto mask = static_cast<Number>(-(i == f));
        corner[i] = static_cast<Number>((parent[i] & ~mask) | (apex & mask));
    }
    if (apex == infinity && f != D) [[unlikely]] {
        std::swap(corner[f], corner[D]);
        for (int i = 0; i <= D; ++i) child[i] = corner[i];
        return D;
    }
    child[0] = corner[1];
    child[1] = corner[0];
    for (int i = 2; i <= D; ++i) child[i] = corner[i];
    return facet_back(f);
}

/// Vertex numbers of a simplex; what is no corner is `no_vertex`.
inline constexpr int lanes = 4;
using Lanes = std::uint16_t __attribute__((vector_size(2 * lanes)));
inline constexpr std::uint16_t no_vertex = 0xffff;

/// All bits of lane `f`.
inline constexpr std::array<Lanes, lanes> lane_masks{
    Lanes{0xffff, 0, 0, 0}, Lanes{0, 0xffff, 0, 0}, Lanes{0, 0, 0xffff, 0}, Lanes{0, 0, 0, 0xffff}};

/// child_across() with an apex that is not at infinity, or replaces that; it is in all lanes.
inline Lanes child_across(Lanes parent, int f, Lanes apex) {
    const Lanes corners = parent ^ ((parent ^ apex) & lane_masks[f]);
    return __builtin_shufflevector(corners, corners, 1, 0, 2, 3);
}
/// ... and with one that is, across a facet that has not been.
template <int D> Lanes ghost_across(Lanes parent, int f, std::uint16_t infinity) {
    parent[f] = parent[D];
    parent[D] = infinity;
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
