#include "query/shapes/light_edges.hpp"

#include "geometry/direction.hpp"
#include "geometry/distance.hpp"
#include "query/shapes/ridge_turn.hpp"

#include <algorithm>

namespace abacus {

template <int D> bool LightEdges<D>::is_handed_out(Handle h, int i, int j) const {
    const Simplex<D> &s = cache_.simplex(h);
    if (s.is_ghost()) return i != D;
    return leads_into<D>(cache_.corners(s), 1u << i | 1u << j);
}

template <int D>
bool LightEdges<D>::is_longest(VertexIndex a, VertexIndex b, VertexIndex apex) const {
    if (apex == infinite_vertex) return false;
    const Point<D> &p = cache_.point(a), &q = cache_.point(b), &r = cache_.point(apex);
    // If two edges have the same length, the one with the greater ends counts as longer.
    const auto comes_after = [](const Point<D> &from, const Point<D> &to, const Point<D> &other) {
        const int sign = compare_distance<D>(from, to, other);
        return sign != 0 ? sign > 0 : std::minmax(from, to) > std::minmax(from, other);
    };
    return comes_after(p, q, r) && comes_after(q, p, r);
}

template <int D> bool LightEdges<D>::is_longest(Handle h, int i, int j) {
    const VertexIndex a = cache_.simplex(h).vertex[i], b = cache_.simplex(h).vertex[j];
    bool is_longest_of_one = false;
    if constexpr (D == 2) {
        const int facet = 3 - i - j;
        is_longest_of_one = is_longest(a, b, cache_.simplex(h).vertex[facet]);
        if (is_longest_of_one) return true;
        const Link beyond = cache_.cross(h, facet);
        return is_longest(a, b, cache_.simplex(link_simplex(beyond)).vertex[link_facet(beyond)]);
    } else {
        // If ghosts are not linked, there is no way around an edge.
        if (!reader_.is_convex()) return false;
        turn_around<3>(cache_, h, {a, b}, [&](Handle, VertexIndex kept) {
            is_longest_of_one = is_longest_of_one || is_longest(a, b, kept);
        });
        return is_longest_of_one;
    }
}

template <int D> auto LightEdges<D>::edge(Handle h, int i, int j) const -> Edge {
    VertexIndex a = cache_.simplex(h).vertex[i], b = cache_.simplex(h).vertex[j];
    if (lexicographically_less<D>(cache_.point(b), cache_.point(a))) std::swap(a, b);
    return {{cache_.point(a), cache_.point(b)}, {cache_.vertices().id(a), cache_.vertices().id(b)}};
}

template class LightEdges<2>;
template class LightEdges<3>;

} // namespace abacus
