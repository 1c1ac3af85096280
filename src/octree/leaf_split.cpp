#include "octree/leaf_split.hpp"

namespace abacus {
namespace {

/// A face as a ring of places, where corners and middles of edges alternate, and its middle.
struct Ring {
    std::array<int, 8> around;
    int middle;
};

/// The ring in the plane of two axes, through a place.
template <int D> constexpr Ring ring(std::array<int, D> at, int u, int v) {
    constexpr int steps[8][2] = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
    Ring ring{};
    for (int i = 0; i < 8; ++i) {
        at[u] = steps[i][0];
        at[v] = steps[i][1];
        ring.around[i] = LeafSplit<D>::place(at);
    }
    at[u] = at[v] = 1;
    ring.middle = LeafSplit<D>::place(at);
    return ring;
}

template <int D> int first_of(const typename LeafSplit<D>::Nodes &nodes, int a, int b) {
    return a < 0 || nodes[b] < nodes[a] ? b : a;
}

/// The place from which a face is cut.
template <int D> int apex_of(const typename LeafSplit<D>::Nodes &nodes, const Ring &ring) {
    if (nodes[ring.middle] != LeafSplit<D>::no_node) return ring.middle;
    int middle = -1, corner = -1;
    for (int i = 0; i < 8; i += 2) {
        corner = first_of<D>(nodes, corner, ring.around[i]);
        middle = first_of<D>(nodes, middle, ring.around[i + 1]);
    }
    return nodes[middle] != LeafSplit<D>::no_node ? middle : corner;
}

/// Calls visit(a, b, c) for the triangles of a face.
template <int D, class Visit>
void cut(const typename LeafSplit<D>::Nodes &nodes, const Ring &ring, Visit visit) {
    const int apex = apex_of<D>(nodes, ring);
    int last = ring.around[0];
    for (int i = 1; i <= 8; ++i) {
        const int next = ring.around[i % 8];
        if (nodes[next] == LeafSplit<D>::no_node) continue;
        if (last != apex && next != apex) visit(apex, last, next);
        last = next;
    }
}

/// The place from which a leaf in space is cut.
int apex_of(const LeafSplit<3>::Nodes &nodes) {
    int other = -1, corner = -1;
    for (int place = 0; place < LeafSplit<3>::places; ++place) {
        bool is_corner = true;
        for (const int x : LeafSplit<3>::lattice(place)) is_corner &= x != 1;
        int &first = is_corner ? corner : other;
        first = first_of<3>(nodes, first, place);
    }
    return nodes[other] != LeafSplit<3>::no_node ? other : corner;
}

} // namespace

template <int D>
int LeafSplit<D>::split(const Nodes &nodes, std::array<Simplex, most_simplices> &simplices) {
    int n = 0;
    if constexpr (D == 2) {
        cut<D>(nodes, ring<D>({}, 0, 1), [&](int a, int b, int c) { simplices[n++] = {a, b, c}; });
    } else {
        const int apex = apex_of(nodes);
        for (int axis = 0; axis < D; ++axis)
            for (int side = 0; side <= 2; side += 2) {
                if (lattice(apex)[axis] == side) continue;
                std::array<int, D> at{};
                at[axis] = side;
                cut<D>(nodes, ring<D>(at, (axis + 1) % D, (axis + 2) % D),
                       [&](int a, int b, int c) {
                           simplices[n++] = {apex, a, b, c};
                       });
            }
    }
    return n;
}

template class LeafSplit<2>;
template class LeafSplit<3>;

} // namespace abacus
