// The pieces of two meshes where both have a surface, or a function in space.
//
// Simplices of the one are cut at the facets of those of the other that they overlap. In each piece
// both functions are linear. That is done in doubles where errors of rounding are small beside the
// whole; otherwise, for flat simplices, in rational numbers.
#pragma once

#include "geometry/common_portions.hpp"
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

/// How far a simplex cut at the facets of another one may be off in doubles, in all its parts: both
/// are seen in a frame near the first. A facet is off its place by a few roundings of the greater
/// length, and values by as many as the other simplex is flat.
template <int D> double rounding_error(const Piece<D> &cut, const Piece<D> &other) {
    constexpr double roundings = 0x1p-50;
    double length = 1; // of the one that is cut, and more
    for (const Point<D> &p : other.corner)
        for (int axis = 0; axis < D; ++axis)
            length = std::max(length, std::fabs(p[axis] - other.corner[0][axis]));
    double power = length;
    for (int i = 1; i < D; ++i) power *= length;
    const double error = std::max(length, measure(cut) * (power / measure(other))) * roundings;
    constexpr double most = 0x1p1000; // for any that is not known: a sum takes no infinities
    return error < most ? error : most;
}

/// The portions that pairs of simplices have in common. At first they are computed in doubles, and
/// the errors are summed with the sizes. If these do not leave nine digits, as among simplices that
/// are all flat, everything is done again, and portions of flat simplices are computed exactly.
template <int D> class CommonPortions {
public:
    explicit CommonPortions(bool is_exact) : is_exact_(is_exact) {}

    /// Whether nothing is left to be done again.
    bool is_sure() const { return is_exact_ || !(size_ < error_.times(std::uint32_t{1} << 30)); }

    /// Calls visit(portion) for the portions of two simplices in a window; its values are those of
    /// the first less those of the second.
    template <class Visit>
    void each(const ValuedSimplex<D> &first, const ValuedSimplex<D> &second, const Box<D> &window,
              const abacus_extent &extent, Visit visit) {
        const bool is_first_cut = is_cut(first, second);
        const ValuedSimplex<D> &cut = is_first_cut ? first : second,
                               &other = is_first_cut ? second : first;
        const NearFrame<D> frame(cut, other);
        const Piece<D> whole = frame.into(cut), other_whole = frame.into(other);
        const double error = rounding_error<D>(whole, other_whole);
        if (is_exact_ && !(error < most_relative_error * measure(whole)))
            return exact::each_common_portion<D>(cut.as_it_is(), other.as_it_is(), window,
                                                 polygon_in<D>(extent), [&](Portion<D> portion) {
                                                     if (!is_first_cut) portion.negate();
                                                     visit(portion);
                                                 });
        add(error_, error, frame);
        const Facets<D> facets(other, frame);
        const auto show = [&](const Piece<D> &piece) {
            const double size = measure(piece);
            add(size_, size, frame);
            visit(Portion<D>{size, piece.value, frame.of_measures(), frame.of_values()});
        };
        const auto show_in_polygon = [&](const Piece<D> &piece) {
            if (polygon_of(extent) == nullptr) return show(piece);
            clip_polygon(cut, frame.out(piece), extent,
                         [&](const Piece<D> &part) { show(frame.in(part)); });
        };
        facets.clip(whole, [&](Piece<D> piece) {
            for (int i = 0; i <= D; ++i) {
                const double value = facets.value_at(piece.corner[i], other_whole.value);
                piece.value[i] = is_first_cut ? piece.value[i] - value : value - piece.value[i];
            }
            clip_box<D>(piece, frame.into(window), show_in_polygon);
        });
    }

private:
    static constexpr double most_relative_error = 0x1p-30;

    void add(WideSum &sum, double number, const NearFrame<D> &frame) const {
        if (!is_exact_) sum.add(number, frame.of_measures());
    }

    const bool is_exact_;
    WideSum size_, error_;
};

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
