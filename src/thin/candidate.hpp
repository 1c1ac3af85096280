// A vertex left out, and a simplex of the thinned mesh in which it is the worst so far, as words.
//
//   corners    of the simplex in lexicographic order, as ordered words; the last one of a ghost,
//              which has D, is all ones
//   values     at the corners; 0 for a ghost
//   vertex     id, coordinates, value, then its attributes if its mesh has them in its pages
//
// Candidates of the same simplex have the same corners: so sorting brings them together.
#pragma once

#include "geometry/linear_piece.hpp"
#include "geometry/ordered.hpp"

#include <algorithm>
#include <cstring>

namespace abacus {

template <int D> struct Candidate {
    static constexpr std::size_t key_words = (D + 1) * D;
    static constexpr std::size_t head_words = key_words + D + 1;
    static constexpr std::uint64_t no_corner = ~std::uint64_t{0};

    /// Words of the vertex.
    static std::size_t vertex_words(unsigned attributes) { return 1 + D + 1 + attributes; }

    static void put(std::uint64_t *to, const Piece<D> &piece, bool is_ghost) {
        std::array<int, D + 1> order;
        const int corners = is_ghost ? D : D + 1;
        for (int i = 0; i <= D; ++i) order[i] = i;
        std::sort(order.begin(), order.begin() + corners, [&](int i, int j) {
            return lexicographically_less<D>(piece.corner[i], piece.corner[j]);
        });
        for (int i = 0; i <= D; ++i) {
            if (i < corners)
                put_ordered(to + i * D, piece.corner[order[i]]);
            else
                std::fill_n(to + i * D, D, no_corner);
            const double value = is_ghost ? 0 : piece.value[order[i]];
            std::memcpy(to + key_words + i, &value, sizeof value);
        }
    }
    static bool is_ghost(const std::uint64_t *words) { return words[D * D] == no_corner; }
    static Piece<D> piece(const std::uint64_t *words) {
        Piece<D> piece;
        for (int i = 0; i <= D; ++i) {
            piece.corner[i] = point_from_ordered<D>(words + i * D);
            std::memcpy(&piece.value[i], words + key_words + i, sizeof(double));
        }
        return piece;
    }
    static std::array<Point<D>, D> facet(const std::uint64_t *words) {
        std::array<Point<D>, D> facet;
        for (int i = 0; i < D; ++i) facet[i] = point_from_ordered<D>(words + i * D);
        return facet;
    }
    static const std::uint64_t *vertex(const std::uint64_t *words) { return words + head_words; }
};

/// The vertex's words.
template <int D> Point<D> vertex_point(const std::uint64_t *vertex) {
    Point<D> p;
    std::memcpy(p.data(), vertex + 1, sizeof p);
    return p;
}
template <int D> double vertex_value(const std::uint64_t *vertex) {
    double value;
    std::memcpy(&value, vertex + 1 + D, sizeof value);
    return value;
}

} // namespace abacus
