// Simplices in flat arrays: vertex numbers and links to the neighbours
// (the dissertation's "Abacus triangle structure", §4.4).
//
// A handle numbers a simplex: block * block_slots + slot. A link names a facet
// of a neighbour: handle << 2 | facet. It carries the mirror facet, so that the
// way back needs no search. Facet i is the one opposite vertex i. When the
// neighbour is not in memory, the link is `absent` and its other bits number an
// entry of the table of visible facets, which knows where to find it.
//
// Ghosts join a hull facet to the point at infinity, which is vertex 0 and always
// the last one of its simplex.
#pragma once

#include "blocks/block.hpp"
#include "host/error.hpp"

#include <array>
#include <cstdint>
#include <utility>

namespace abacus {

enum class VertexIndex : std::uint32_t {};
constexpr std::uint32_t to_number(VertexIndex v) { return static_cast<std::uint32_t>(v); }
/// A facet of a simplex; a type of its own, for it is neither a number nor a handle.
enum class Link : std::uint32_t {};

inline constexpr VertexIndex infinite_vertex{0};
inline constexpr VertexIndex free_mark{0xffffffffu}; // vertex[0] of a free slot
inline constexpr Link absent{0x80000000u};
inline constexpr Link unset{0xffffffffu};

constexpr std::uint32_t to_bits(Link link) { return static_cast<std::uint32_t>(link); }
constexpr Link make_link(Handle simplex, int facet) {
    return Link{to_number(simplex) << 2 | static_cast<std::uint32_t>(facet)};
}
constexpr Handle link_simplex(Link link) { return Handle{to_bits(link) >> 2}; }
constexpr int link_facet(Link link) { return static_cast<int>(to_bits(link) & 3); }
constexpr bool is_absent(Link link) { return (to_bits(link) & to_bits(absent)) != 0; }
/// To an entry of the visible facets.
constexpr Link absent_link(std::uint32_t entry) { return Link{to_bits(absent) | entry}; }
constexpr std::uint32_t visible_facet(Link link) { return to_bits(link) & ~to_bits(absent); }
/// A link among simplices that are numbered from 0 on, where their handles begin with `first`.
constexpr Link link_from(Handle first, Link link) {
    return Link{to_bits(make_link(first, 0)) + to_bits(link)};
}

/// Slots of a block: more than a page of simplices can fill.
template <int D> inline constexpr std::uint32_t block_slots = D == 2 ? 1024 : 768;

template <int D> struct Simplex {
    std::array<VertexIndex, D + 1> vertex;
    std::array<Link, D + 1> link;

    bool is_ghost() const { return vertex[D] == infinite_vertex; }
    // A free slot, see blocks/data_type.hpp.
    bool is_free() const { return vertex[0] == free_mark; }
    std::uint32_t next_free() const { return to_bits(link[0]); }
    Handle moved_to() const { return Handle{to_bits(link[1])}; }
    void set_free(std::uint32_t next, Handle moved) {
        vertex[0] = free_mark;
        link[0] = Link{next};
        link[1] = Link{to_number(moved)};
    }
    /// Vertices that are not at infinity.
    int finite_vertices() const { return is_ghost() ? D : D + 1; }
    int index_of(VertexIndex v) const {
        for (int i = 0; i < D; ++i)
            if (vertex[i] == v) return i;
        return D;
    }
};

/// Whether a permutation, of numbers that are all different, keeps orientations.
constexpr bool is_even(const auto &permutation) {
    int inversions = 0;
    for (std::size_t i = 0; i < permutation.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) inversions += permutation[j] > permutation[i];
    return inversions % 2 == 0;
}

/// Corners of the ghost on a facet of a positively oriented simplex. The point at infinity is
/// on the other side of the facet than the corner opposite: one exchange turns the orientation
/// back. It brings infinity to its place, or, if it is there already, exchanges two others.
template <class Vertex, std::size_t n>
constexpr std::array<Vertex, n> ghost_on(std::array<Vertex, n> corners, std::size_t facet,
                                         const Vertex &infinity) {
    corners[facet] = infinity;
    if (facet == n - 1)
        std::swap(corners[0], corners[1]);
    else
        std::swap(corners[facet], corners[n - 1]);
    return corners;
}

/// Vertices of a facet in ascending order, and whether the order of the facet
/// induced by its simplex is an odd permutation of it. Neighbours in an oriented
/// mesh share the vertices and differ in `odd`.
template <int D, class Index> struct FacetVertices {
    std::array<Index, D> vertex;
    bool odd;

    /// Without a branch: which order it is no processor can foresee.
    template <class Vertices>
    FacetVertices(const Vertices &simplex, int facet) : odd((facet & 1) != 0) {
        for (int i = 0; i < D; ++i) vertex[i] = static_cast<Index>(simplex[i + (i >= facet)]);
        for (int last = D - 1; last > 0; --last)
            for (int i = 0; i < last; ++i) {
                const Index a = vertex[i], b = vertex[i + 1];
                const bool turned = b < a;
                vertex[i] = turned ? b : a;
                vertex[i + 1] = turned ? a : b;
                odd ^= turned;
            }
    }
};

/// Stored simplices that no triangulation has.
[[noreturn]] inline void throw_no_triangulation() {
    throw_corrupted("The simplices around a point are not a triangulation.");
}

} // namespace abacus
