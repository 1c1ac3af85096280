// A leaf of a balanced octree cut into triangles or tetrahedra whose corners are nodes, such that
// all leaves together make a conforming mesh: what two leaves have in common they cut alike.
//
// In a balanced octree a leaf has nodes at its corners and, where smaller leaves touch it, in the
// middles of its edges and faces: they lie on a lattice of 3 to the power D places. Nodes have an
// order that is the same for all leaves: those that hang in the middle of a face first, then those
// in the middle of an edge, then those that do not hang; of each by their numbers. Then
//
//   a face  is cut into triangles from its first node that is no corner of it, or, without such a
//           node, from its first corner. Its nodes decide it, and both sides see the same ones.
//           Where one side has smaller faces, their first node is the middle of the large one, so
//           what is cut from there is cut alike;
//   a leaf  is cut from its first node that is no corner, or, without such a node, from its first
//           corner: into the pyramids over the triangles of the faces that do not have it. The
//           faces that have it are cut from it, too, by the rule for faces.
//
// In the plane the leaf is the face. No new points are needed.
#pragma once

#include "octree/octant.hpp"

#include <array>

namespace abacus {

template <int D> class LeafSplit {
public:
    static constexpr int places = D == 2 ? 9 : 27;
    static constexpr std::uint64_t no_node = ~std::uint64_t{0};
    /// Of 6 faces with 8 triangles, without those of the face in the middle of which all begins.
    static constexpr int most_simplices = D == 2 ? 6 : 40;

    /// The place in a lattice that counts 0, 1, 2 on each axis.
    static constexpr int place(const std::array<int, D> &at) {
        int place = 0;
        for (int i = D - 1; i >= 0; --i) place = 3 * place + at[i];
        return place;
    }
    static constexpr std::array<int, D> lattice(int place) {
        std::array<int, D> at{};
        for (int i = 0; i < D; ++i, place /= 3) at[i] = place % 3;
        return at;
    }
    /// The place of an octant's corner.
    static constexpr int corner(int number) {
        std::array<int, D> at{};
        for (int i = 0; i < D; ++i) at[i] = (number >> i & 1) * 2;
        return place(at);
    }
    /// A node in the order that decides; `middle`: the dimension of what it hangs in the middle of,
    /// 0 if it does not.
    static constexpr std::uint64_t order(int middle, std::uint64_t number) {
        return static_cast<std::uint64_t>(2 - middle) << 62 | number;
    }
    static constexpr std::uint64_t number(std::uint64_t order) { return order << 2 >> 2; }

    using Simplex = std::array<int, D + 1>;          // places, in any order
    using Nodes = std::array<std::uint64_t, places>; // by order(), or no_node

    /// Fills `simplices`; returns how many there are.
    static int split(const Nodes &nodes, std::array<Simplex, most_simplices> &simplices);
};

extern template class LeafSplit<2>;
extern template class LeafSplit<3>;

} // namespace abacus
