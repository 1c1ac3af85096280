// What passes from sort to sort while a mesh is loaded: records of eight-byte words.
//
//   vertex    id, coordinates, attributes, as everywhere
//   simplex   code, part, D+1 vertices: positively oriented
//   boundary  code, part, D vertices of a ghost; code and part of the simplex behind it,
//             id and coordinates of the vertex of that simplex that the ghost lacks
//   flank     a simplex's side of a facet: the K ids of the facet in ascending order;
//             number << 3 | facet << 1 | odd; id of the opposite vertex; code, part of the
//             simplex; coordinates of the opposite vertex
//   link      number << 2 | facet; code and part of the neighbour; id and coordinates of
//             its opposite vertex
//   element   code, part; code and part of each of D+1 neighbours; 1 for a ghost, else 0;
//             D+1 vertices, of a ghost D
//   labelled  key of an owner of attributes, two words (attributes/attribute_key.hpp); its D+1
//             points; its labels
#pragma once

#include "geometry/predicates.hpp"
#include "host/host.hpp"
#include "keys/key.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

namespace abacus {

using Word = std::uint64_t;

template <int D> struct LoadLayout {
    std::size_t vertex;                        // words
    std::size_t simplex, boundary, element;    // words
    static constexpr std::size_t link = 4 + D; // words
    static constexpr std::size_t flank(std::size_t ids) { return ids + 4 + D; }

    explicit LoadLayout(unsigned attributes)
        : vertex(1 + D + attributes), simplex(2 + (D + 1) * vertex),
          boundary(2 + D * vertex + 3 + D), element(3 + 2 * (D + 1) + (D + 1) * vertex) {}

    const Word *simplex_vertex(const Word *s, int i) const { return s + 2 + i * vertex; }
    const Word *boundary_vertex(const Word *b, int i) const { return s_of(b) + i * vertex; }
    /// Code and part of the simplex behind, then its opposite vertex.
    const Word *behind(const Word *b) const { return s_of(b) + D * vertex; }

private:
    static const Word *s_of(const Word *b) { return b + 2; }
};

/// The coordinates of a vertex record, in place: words that hold doubles.
template <int D> const Point<D> &point_in(const Word *vertex) {
    static_assert(sizeof(Point<D>) == D * sizeof(Word));
    return *reinterpret_cast<const Point<D> *>(vertex + 1);
}

/// "(1, 2, 3)"
inline std::string name_of(std::span<const Word> ids) {
    std::string text = "(";
    for (const Word id : ids) {
        if (text.size() > 1) text += ", ";
        text += std::to_string(static_cast<std::int64_t>(id));
    }
    return text + ")";
}

/// The same in ascending order.
template <std::size_t N> std::string sorted_name(std::array<Word, N> ids) {
    std::sort(ids.begin(), ids.end(), [](Word a, Word b) {
        return static_cast<std::int64_t>(a) < static_cast<std::int64_t>(b);
    });
    return name_of(ids);
}
/// A simplex, named by a facet's ids and the opposite one.
template <std::size_t K> std::string sorted_name(const std::array<Word, K> &facet, Word opposite) {
    std::array<Word, K + 1> ids;
    std::copy(facet.begin(), facet.end(), ids.begin());
    ids[K] = opposite;
    return sorted_name(ids);
}

/// "simplices (1, 2, 3) and (4, 5, 6)", in one order
inline std::string names_of(const std::string &a, const std::string &b) {
    return "simplices " + std::min(a, b) + " and " + std::max(a, b);
}

} // namespace abacus
