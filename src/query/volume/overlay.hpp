// The pieces of two meshes in the plane where both have a surface.
//
// Triangles of the one are cut at the edges of those of the other that they overlap. In each piece
// both surfaces are linear.
#pragma once

#include "query/volume/overlaps.hpp"
#include "query/volume/valued_simplex.hpp"

namespace abacus {

/// The edges of a triangle, relative to the first corner of `seen_from`.
class Edges {
public:
    Edges(const ValuedSimplex<2> &triangle, const ValuedSimplex<2> &seen_from) {
        for (int i = 0; i < 3; ++i) corner_[i] = seen_from.seen_from_first(triangle.corner[i]);
        sign_ = orientation(triangle.corner[0], triangle.corner[1], triangle.corner[2]);
    }
    /// How far a point is inside the edge opposite a corner, times the length of the edge. The two
    /// triangles of the edge get the same value, except for the sign.
    double side(int opposite, const Point<2> &p) const {
        const Point<2> &a = corner_[opposite == 0 ? 1 : 0], &b = corner_[opposite == 2 ? 1 : 2];
        const double left = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
        return (opposite == 1) == (sign_ > 0) ? -left : left;
    }
    /// A linear function on the triangle, at a point inside it. Rounding never leads beyond the
    /// values at the corners.
    double value_at(const Point<2> &p, const std::array<double, 3> &values) const {
        double weight[3], sum = 0;
        for (int i = 0; i < 3; ++i) sum += weight[i] = std::max(side(i, p), 0.0);
        if (!(sum > 0)) return values[0]; // the triangle is too small for products
        double value = 0;
        for (int i = 0; i < 3; ++i) value += values[i] * (weight[i] / sum);
        return value;
    }

    /// Calls visit(piece) for the pieces of a piece in the triangle.
    template <int edge = 0, class Visit> void clip(const Piece<2> &piece, Visit &&visit) const {
        if constexpr (edge == 3) {
            visit(piece);
        } else {
            Sides<2> sides;
            for (int i = 0; i < 3; ++i) sides[i] = side(edge, piece.corner[i]);
            abacus::clip<2>(piece, sides,
                            [&](const Piece<2> &part) { this->clip<edge + 1>(part, visit); });
        }
    }

private:
    Point<2> corner_[3];
    int sign_;
};

/// Calls visit(piece, origin) for the pieces of two triangles in a window; its values are those of
/// the first less those of the second, and its corners are seen from the origin. The smaller
/// triangle is cut at the edges of the other, so that rounding errors are relative to its own
/// lengths. The choice does not depend on their order.
template <class Visit>
void each_common_piece(const ValuedSimplex<2> &first, const ValuedSimplex<2> &second,
                       const Box<2> &window, const abacus_extent &extent, Visit visit) {
    const Piece<2> whole_first = first.piece(), whole_second = second.piece();
    const double area = measure(whole_first), second_area = measure(whole_second);
    const bool is_first_cut =
        area < second_area || (area == second_area && first.corner <= second.corner);
    const ValuedSimplex<2> &cut = is_first_cut ? first : second,
                           &other = is_first_cut ? second : first;
    const Edges edges(other, cut);
    edges.clip(is_first_cut ? whole_first : whole_second, [&](Piece<2> piece) {
        for (int i = 0; i < 3; ++i) {
            const double height = edges.value_at(piece.corner[i], other.value);
            piece.value[i] = is_first_cut ? piece.value[i] - height : height - piece.value[i];
        }
        clip_box<2>(piece, cut.seen_from_first(window), [&](const Piece<2> &in_window) {
            clip_polygon(cut, in_window, extent,
                         [&](const Piece<2> &part) { visit(part, cut.corner[0]); });
        });
    });
}

/// Another mesh, which has its own host.
struct OtherMesh {
    const Host &host;
    const abacus_facts &facts;
    std::uint32_t attribute;
    std::size_t cache_bytes; // for its triangles
};

/// Calls visit(first, second) for all pairs of triangles with values that overlap; pieces of them
/// may still lie outside of the window.
template <class Visit>
void each_overlap(const Host &host, const abacus_facts &facts, const abacus_surface &surface,
                  const OtherMesh &other, Visit visit) {
    const Box<2> window = box_of<2>(surface.window);
    abacus_extent extent = surface.extent;
    extent.region = no_region; // regions are the mesh's own
    extent.has_box = 0;
    Overlaps overlaps(other.host, other.facts, other.attribute, extent, window, other.cache_bytes);
    // A small window needs only its own pages, not those of the hull.
    const abacus_window around = surface.window.kind == ABACUS_NO_WINDOW
                                     ? window_of<2>(overlaps.around_all())
                                     : surface.window;
    each_simplex<2>(
        host, facts, surface, around,
        [&](const abacus_simplex &simplex, const CornerValues &values) {
            const ValuedSimplex<2> first = cell_of<2>(simplex, values);
            if (!first.has_values()) return;
            Point<2> points[3];
            Corners<2> corners;
            for (int i = 0; i < 3; ++i) {
                std::copy_n(simplex.corner[i], 2, points[i].begin());
                corners[i] = &points[i];
            }
            overlaps.each(corners, [&](const Corners<2> &at, const std::array<double, 3> &heights) {
                const ValuedSimplex<2> second([&](int i) { return *at[i]; },
                                              [&](int i) { return heights[i]; });
                if (second.has_values()) visit(first, second);
            });
        });
}

} // namespace abacus
