// Tells which facet of a simplex separates it from a point, along a walk from one simplex to
// the next.
//
// A walk in the plane would mostly wait for the choice between two edges, which no processor can
// predict. So both edges are tested, and one is chosen without a branch. Of each triangle only
// the vertex is read that the triangle before lacks; the walk carries the others along, as
// differences from the point. In space the facets are tested in turn, beginning with any, until
// one separates.
#pragma once

#include "geometry/predicates.hpp"
#include "traverse/topology.hpp"

#include <utility>

namespace abacus {

/// Corners of a finite simplex.
template <int D, Topology<D> Mesh> Corners<D> corners_of(const Mesh &mesh, const Simplex<D> &s) {
    Corners<D> corners;
    for (int i = 0; i <= D; ++i) corners[i] = &mesh.point(s.vertex[i]);
    return corners;
}

template <int D, Topology<D> Mesh> class Separator {
public:
    /// Both are to outlive it.
    Separator(const Mesh &mesh, const Point<D> &p) : mesh_(mesh), p_(p) {}

    static constexpr int none = -1;
    /// A facet of a finite simplex that has p strictly beyond it, or `none`. `entered` is the facet
    /// across which the walk came from the simplex before, so p is on this side of it; `none` for
    /// the first simplex. If several facets separate, `random` decides which is returned.
    int find(const Simplex<D> &s, int entered, std::uint32_t random);
    /// Whether p is on a facet of the last simplex, which none separated.
    bool is_on_facet() const { return is_on_facet_; }

private:
    const Mesh &mesh_;
    const Point<D> &p_;
    bool is_on_facet_ = false;
};

template <int D, Topology<D> Mesh>
int Separator<D, Mesh>::find(const Simplex<D> &s, int entered, std::uint32_t random) {
    is_on_facet_ = false;
    const Corners<D> corners = corners_of(mesh_, s);
    // All of the first simplex, else those behind the one entered by, in a circle.
    const int facets = entered == none ? D + 1 : D;
    int turn = static_cast<int>(random % D);
    for (int i = 0; i < facets; ++i, turn = turn == facets - 1 ? 0 : turn + 1) {
        const int next = entered + 1 + turn, facet = next > D ? next - D - 1 : next;
        const int side = facet_side<D>(corners, facet, p_);
        if (side < 0) return facet;
        is_on_facet_ = is_on_facet_ || side == 0;
    }
    return none;
}

template <Topology<2> Mesh> class Separator<2, Mesh> {
public:
    Separator(const Mesh &mesh, const Point<2> &p) : mesh_(mesh), p_(p) {}

    static constexpr int none = -1;
    int find(const Simplex<2> &s, int entered, std::uint32_t random) {
        is_on_facet_ = false;
        if (entered == none) {
            // As if by edge 0, if that does not separate.
            after_ = seen_from_p(s.vertex[1]);
            before_ = seen_from_p(s.vertex[2]);
            const int side = facet_side<2>(corners_of(mesh_, s), 0, p_);
            if (side < 0) {
                std::swap(after_, before_);
                return 0;
            }
            is_on_facet_ = side == 0;
            entered = 0;
        }
        const Point<2> apex = seen_from_p(s.vertex[entered]);
        const SignedArea one = signed_area(before_, apex), other = signed_area(apex, after_);
        bool beyond_one = one.is_negative(), beyond_other = other.is_negative();
        if (!(one.is_sure() & other.is_sure())) [[unlikely]] {
            const Corners<2> corners = corners_of(mesh_, s);
            const int side = facet_side<2>(corners, edge_after(entered), p_);
            const int other_side = facet_side<2>(corners, edge_before(entered), p_);
            beyond_one = side < 0;
            beyond_other = other_side < 0;
            is_on_facet_ |= (side == 0) | (other_side == 0);
        }
        if (!(beyond_one | beyond_other)) return none;
        const bool is_one = beyond_one & (!beyond_other | ((random & 1) != 0));
        // The next triangle has the vertices of the edge in the opposite order.
        after_ = is_one ? apex : after_;
        before_ = is_one ? before_ : apex;
        return is_one ? edge_after(entered) : edge_before(entered);
    }
    bool is_on_facet() const { return is_on_facet_; }

private:
    // Counterclockwise; by shifts, for each step waits for them.
    static constexpr int edge_after(int edge) { return 0b00'10'01 >> 2 * edge & 3; }
    static constexpr int edge_before(int edge) { return 0b01'00'10 >> 2 * edge & 3; }

    Point<2> seen_from_p(VertexIndex v) const {
        const Point<2> &point = mesh_.point(v);
        return {point[0] - p_[0], point[1] - p_[1]};
    }

    const Mesh &mesh_;
    const Point<2> &p_;
    bool is_on_facet_ = false;
    Point<2> after_, before_; ///< the vertices after and before the apex, as seen from p
};

} // namespace abacus
