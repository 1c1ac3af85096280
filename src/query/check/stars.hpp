// What the stars of all vertices show about the whole mesh: that it is in one piece and covers no
// place twice.
//
// A mesh can be sound across every facet and still overlap itself. Two meshes may be stored
// as one. Or five triangles around a vertex join each corner of a pentagon to the next but one, and
// wind around the vertex twice: each is positively oriented, no circumcircle is touched, the hull
// turns left at every corner, and Euler's relation holds.
//
// One piece. The lexicographically least vertex of a piece has no lesser neighbour. In a
// triangulation of a convex region there is only one such vertex: the segment from any other vertex
// to the least one begins in a simplex of its star, which therefore has a lesser corner. Hence
// there are at least as many such vertices as pieces, and a sound mesh has one.
//
// Wound once. Around a ridge, which is a vertex in the plane and an edge in space, simplices follow
// one another as wedges of less than half a turn. At a direction and its opposite, the wedges
// change from one side of a line or plane to the other: twice in a full turn, and at most once in
// half a turn or less, which is what the wedges make up on the hull, where two ghosts close the
// circle. No vertex lies in the chosen direction: towards greater lexicographic order.
//
// Every star. The stars visited have as many corners as the mesh. So no vertex has a second star
// that belongs to no page.
//
// A mesh that is in one piece, wound once everywhere and locally convex on its hull is convex and
// covers no place twice (Tietze 1928; Nakajima 1928, for immersions).
#pragma once

#include "geometry/predicates.hpp"
#include "traverse/own_vertices.hpp"

#include <algorithm>

namespace abacus {

/// What stars show together, of all vertices or of some.
struct StarCounts {
    std::uint64_t count = 0;
    std::uint64_t corners = 0; ///< simplices, counted once for each star that they are in
    std::uint64_t least = 0;   ///< vertices without a lesser neighbour
    bool are_wound_once = true;

    StarCounts &operator+=(const StarCounts &more) {
        count += more.count;
        corners += more.corners;
        least += more.least;
        are_wound_once = are_wound_once && more.are_wound_once;
        return *this;
    }
};

template <int D> class Stars {
public:
    explicit Stars(Cache<D> &cache)
        : cache_(cache), neighbours_(cache.host()), turns_(cache.host()) {}

    /// Visits all simplices around a vertex, none of which has been evicted. False if they wind
    /// around it, or around an edge from there to a greater vertex, more than once.
    bool add(VertexIndex v, const Arena<Handle> &star) {
        ++counts_.count;
        counts_.corners += star.size();
        neighbours_.clear();
        turns_.resize(D == 2);
        std::fill(turns_.begin(), turns_.end(), Turn{});
        bool has_lesser = false;
        for (const Handle h : star) has_lesser |= turn(cache_.simplex(h), v);
        counts_.least += !has_lesser;
        const bool once = std::all_of(turns_.begin(), turns_.end(), [](const Turn &t) {
            return t.ghosts == 0 ? t.changes == 2 : t.ghosts == 2 && t.changes <= 1;
        });
        counts_.are_wound_once &= once;
        return once;
    }

    /// The sums over the stars so far.
    const StarCounts &counts() const { return counts_; }

private:
    /// Around a ridge: wedges whose sides lie on different sides of the line or plane, and ghosts.
    struct Turn {
        std::uint32_t changes = 0, ghosts = 0;
    };

    /// Adds a simplex to the turns around its vertex v, in space around the edges from v to greater
    /// vertices, so that each edge is checked once. Returns whether it has a lesser vertex.
    bool turn(const Simplex<2> &s, VertexIndex v) {
        const int corner = s.index_of(v);
        const VertexIndex a = s.vertex[(corner + 1) % 3], b = s.vertex[(corner + 2) % 3];
        if (s.is_ghost()) {
            ++turns_[0].ghosts;
            return is_less(a == infinite_vertex ? b : a, v);
        }
        const bool a_is_less = is_less(a, v), b_is_less = is_less(b, v);
        turns_[0].changes += a_is_less != b_is_less;
        return a_is_less || b_is_less;
    }
    bool turn(const Simplex<3> &s, VertexIndex v) {
        const int corner = s.index_of(v), others = s.finite_vertices() - 1;
        std::array<VertexIndex, 3> other;
        std::array<bool, 3> is_lesser;
        bool has_lesser = false;
        for (int i = 0; i < others; ++i) {
            other[i] = s.vertex[i + (i >= corner)];
            has_lesser |= is_lesser[i] = is_less(other[i], v);
        }
        // For each pair of the others, seen from v: is the second to the left of the first? This is
        // the side for the edge to the first; for the edge to the second, the first is to the
        // right.
        std::array<bool, 3> is_left{};
        if (!s.is_ghost())
            for (int i = 0; i < 3; ++i) is_left[i] = turns_left(v, other[i], other[(i + 1) % 3]);
        for (int i = 0; i < others; ++i) {
            if (is_lesser[i]) continue;
            Turn &turn = turn_around(other[i]);
            if (s.is_ghost())
                ++turn.ghosts;
            else
                turn.changes += is_left[i] == is_left[(i + 2) % 3];
        }
        return has_lesser;
    }
    /// The turn around the edge to that neighbour.
    Turn &turn_around(VertexIndex neighbour) {
        const std::uint32_t n = cache_.number(neighbours_, neighbour);
        if (n == turns_.size()) turns_.push_back({});
        return turns_[n];
    }
    bool is_less(VertexIndex a, VertexIndex b) const {
        return lexicographically_less<D>(cache_.point(a), cache_.point(b));
    }
    /// Whether b is to the left of a, seen from v against the direction of lexicographic order:
    /// in projection along the first axis; where they are collinear in it, along the next.
    bool turns_left(VertexIndex v, VertexIndex a, VertexIndex b) const {
        const Point<3> &p = cache_.point(v), &q = cache_.point(a), &r = cache_.point(b);
        const SignedArea area = signed_area({q[1] - p[1], q[2] - p[2]}, {r[1] - p[1], r[2] - p[2]});
        if (area.is_sure()) [[likely]]
            return area.value > 0; // unpredictable, so no branch
        for (int axis = 0; axis < 3; ++axis) {
            const int i = (axis + 1) % 3, j = (axis + 2) % 3;
            const int side = orientation({p[i], p[j]}, {q[i], q[j]}, {r[i], r[j]});
            if (side != 0) return side > 0;
        }
        throw_corrupted("A simplex is flat.");
    }

    Cache<D> &cache_;
    StarCounts counts_;
    typename VertexHeap<D>::Numbering neighbours_; // of the current vertex, in space
    Arena<Turn> turns_;                            // around it, or around the edges to those
};

} // namespace abacus
