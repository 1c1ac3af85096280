// The pieces of two meshes where both have a surface, or a function in space.
//
// Simplices of the one are cut at the facets of those of the other that they overlap. In each piece
// both functions are linear.
#pragma once

#include "query/volume/near_frame.hpp"
#include "query/volume/overlaps.hpp"
#include "query/volume/valued_simplex.hpp"

namespace abacus {

/// The facets of a simplex, seen in a frame.
template <int D> class Facets {
public:
    Facets(const ValuedSimplex<D> &simplex, const NearFrame<D> &frame) {
        Corners<D> corners;
        for (int i = 0; i <= D; ++i) {
            corners[i] = &simplex.corner[i];
            corner_[i] = frame.into(simplex.corner[i]);
        }
        const bool is_positive = orientation<D>(corners) > 0;
        for (int opposite = 0; opposite <= D; ++opposite) {
            const auto corner = [&](int i) { return corner_[i + (i >= opposite)]; };
            Facet &facet = facet_[opposite];
            facet.origin = corner(0);
            facet.normal = normal([&](int i) {
                Point<D> way = corner(i + 1);
                for (int axis = 0; axis < D; ++axis) way[axis] -= facet.origin[axis];
                return way;
            });
            facet.is_turned = is_positive != ((D - opposite) % 2 == 0);
        }
    }
    /// How far a point is inside the facet opposite a corner, times the measure of the facet;
    /// exactly 0 at the corners of the facet. The two simplices of the facet get the same value,
    /// except for the sign.
    double side(int opposite, const Point<D> &p) const {
        const Facet &facet = facet_[opposite];
        double sum = 0;
        for (int axis = 0; axis < D; ++axis)
            sum += facet.normal[axis] * (p[axis] - facet.origin[axis]);
        for (int i = 0; i <= D; ++i)
            if (i != opposite && p == corner_[i]) sum = 0;
        return facet.is_turned ? -sum : sum;
    }
    /// A linear function on the simplex, at a point inside it. Rounding never leads beyond the
    /// values at the corners.
    double value_at(const Point<D> &p, const std::array<double, D + 1> &values) const {
        double weight[D + 1], sum = 0;
        for (int i = 0; i <= D; ++i) sum += weight[i] = std::max(side(i, p), 0.0);
        if (!(sum > 0)) return values[0]; // the simplex is too small for products
        double value = 0;
        for (int i = 0; i <= D; ++i) value += values[i] * (weight[i] / sum);
        return value;
    }

    /// Calls visit(piece) for the pieces of a piece in the simplex.
    template <int facet = 0, class Visit> void clip(const Piece<D> &piece, Visit &&visit) const {
        if constexpr (facet > D) {
            visit(piece);
        } else {
            Sides<D> sides;
            for (int i = 0; i <= D; ++i) sides[i] = side(facet, piece.corner[i]);
            abacus::clip<D>(piece, sides,
                            [&](const Piece<D> &part) { this->clip<facet + 1>(part, visit); });
        }
    }

private:
    struct Facet {
        Point<D> origin, normal;
        bool is_turned;
    };

    /// way(i): from the first corner of a facet to the next ones.
    template <class Way> static Point<D> normal(Way way) {
        const Point<D> a = way(0);
        if constexpr (D == 2) {
            return {-a[1], a[0]};
        } else {
            const Point<D> b = way(1);
            return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                    a[0] * b[1] - a[1] * b[0]};
        }
    }

    Point<D> corner_[D + 1];
    Facet facet_[D + 1];
};

/// The area or volume of a simplex, in an order that neither overflows nor underflows.
template <int D> ScaledNumber size_of(const ValuedSimplex<D> &simplex) {
    const NearFrame<D> frame(simplex, simplex);
    int exponent = 0;
    const double size = std::frexp(measure(frame.into(simplex)), &exponent);
    return {size, exponent + frame.of_measures()};
}

/// Whether the first of two simplices is cut at the facets of the second: the smaller one, so that
/// rounding errors are relative to its own lengths. The choice does not depend on their order.
template <int D> bool is_cut(const ValuedSimplex<D> &first, const ValuedSimplex<D> &second) {
    const ScaledNumber a = size_of(first), b = size_of(second);
    if (a.exponent != b.exponent && a.value != 0 && b.value != 0) return a.exponent < b.exponent;
    return a.value < b.value || (a.value == b.value && first.corner <= second.corner);
}

/// Calls visit(piece, frame) for the pieces of two simplices in a window; its values are those of
/// the first less those of the second, and all is seen in the frame.
template <int D, class Visit>
void each_common_piece(const ValuedSimplex<D> &first, const ValuedSimplex<D> &second,
                       const Box<D> &window, const abacus_extent &extent, Visit visit) {
    const bool is_first_cut = is_cut(first, second);
    const ValuedSimplex<D> &cut = is_first_cut ? first : second,
                           &other = is_first_cut ? second : first;
    const NearFrame<D> frame(cut, other);
    const Facets<D> facets(other, frame);
    const std::array<double, D + 1> values = frame.into(other).value;
    const auto show = [&](const Piece<D> &piece) {
        if (polygon_of(extent) == nullptr) return visit(piece, frame);
        clip_polygon(cut, frame.out(piece), extent,
                     [&](const Piece<D> &part) { visit(frame.in(part), frame); });
    };
    facets.clip(frame.into(cut), [&](Piece<D> piece) {
        for (int i = 0; i <= D; ++i) {
            const double value = facets.value_at(piece.corner[i], values);
            piece.value[i] = is_first_cut ? piece.value[i] - value : value - piece.value[i];
        }
        clip_box<D>(piece, frame.into(window), show);
    });
}

/// Another mesh, which has its own host.
struct OtherMesh {
    const Host &host;
    const abacus_facts &facts;
    std::uint32_t attribute;
    std::size_t cache_bytes; // for its simplices
};

/// Calls visit(first, second) for all pairs of simplices with values that overlap; pieces of them
/// may still lie outside of the window.
template <int D, class Visit>
void each_overlap(const Host &host, const abacus_facts &facts, const abacus_surface &surface,
                  const OtherMesh &other, Visit visit) {
    const Box<D> window = box_of<D>(surface.window);
    abacus_extent extent = surface.extent;
    extent.region = no_region; // regions are the mesh's own
    extent.has_box = 0;
    Overlaps<D> overlaps(other.host, other.facts, other.attribute, extent, window,
                         other.cache_bytes);
    // A small window needs only its own pages, not those of the hull.
    const abacus_window around = surface.window.kind == ABACUS_NO_WINDOW
                                     ? window_of<D>(overlaps.around_all())
                                     : surface.window;
    each_simplex<D>(host, facts, surface, around,
                    [&](const abacus_simplex &simplex, const CornerValues &values) {
                        const ValuedSimplex<D> first = cell_of<D>(simplex, values);
                        if (!first.has_values()) return;
                        Point<D> points[D + 1];
                        Corners<D> corners;
                        for (int i = 0; i <= D; ++i) {
                            std::copy_n(simplex.corner[i], D, points[i].begin());
                            corners[i] = &points[i];
                        }
                        overlaps.each(corners, [&](const Corners<D> &at,
                                                   const std::array<double, D + 1> &numbers) {
                            const ValuedSimplex<D> second([&](int i) { return *at[i]; },
                                                          [&](int i) { return numbers[i]; });
                            if (second.has_values()) visit(first, second);
                        });
                    });
}

} // namespace abacus
