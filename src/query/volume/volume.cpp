#include "query/volume/volume.hpp"

#include "geometry/clip_trapezoid.hpp"

#include "query/scan/cell_scan.hpp"
#include "sort/pacer.hpp"

#include <algorithm>
#include <limits>

namespace abacus {

namespace {

/// Simplices between two reports of progress: some milliseconds, between two meshes.
constexpr std::uint64_t simplices_at_once = 1024;

/// A simplex with its corners in lexicographic order, and their values.
template <int D> struct ValuedSimplex {
    std::array<Point<D>, D + 1> corner;
    std::array<double, D + 1> value;

    template <class PointOf, class ValueOf> ValuedSimplex(PointOf point, ValueOf number) {
        std::array<int, D + 1> order;
        for (int i = 0; i <= D; ++i) order[i] = i;
        std::sort(order.begin(), order.end(),
                  [&](int i, int j) { return lexicographically_less<D>(point(i), point(j)); });
        for (int i = 0; i <= D; ++i) {
            corner[i] = point(order[i]);
            value[i] = number(order[i]);
        }
    }

    bool has_values() const {
        return std::all_of(value.begin(), value.end(), [](double v) { return std::isfinite(v); });
    }
    /// Relative to its first corner.
    Piece<D> piece() const {
        Piece<D> piece;
        for (int i = 0; i <= D; ++i) {
            piece.corner[i] = seen_from_first(corner[i]);
            piece.value[i] = value[i];
        }
        return piece;
    }
    Point<D> seen_from_first(const Point<D> &p) const {
        Point<D> seen;
        for (int axis = 0; axis < D; ++axis) seen[axis] = p[axis] - corner[0][axis];
        return seen;
    }
    Box<D> seen_from_first(const Box<D> &box) const {
        return {seen_from_first(box.lower), seen_from_first(box.upper)};
    }
};

/// Calls visit(piece) for the parts of a simplex that count, cut at the border of a polygon. Its
/// corner 0 is the origin of the piece.
template <int D, class Visit>
void clip_polygon(const ValuedSimplex<D> &cell, const Piece<D> &piece, const abacus_extent &extent,
                  Visit &&visit) {
    if constexpr (D == 2)
        if (const Polygon *polygon = polygon_of(extent)) {
            Box<2> box;
            for (const Point<2> &corner : cell.corner) box.extend(corner);
            return polygon->each_part(box, [&](const Polygon::Trapezoid &part) {
                clip_trapezoid(piece, part, cell.corner[0], visit);
            });
        }
    visit(piece);
}

template <int D>
ValuedSimplex<D> cell_of(const abacus_simplex &simplex, const CornerValues &values) {
    return {[&](int i) {
                Point<D> p;
                std::copy_n(simplex.corner[i], D, p.begin());
                return p;
            },
            [&](int i) { return values.value(i, 0); }};
}

template <int D> Box<D> box_of(const abacus_window &window) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Box<D> box;
    for (int axis = 0; axis < D; ++axis) {
        const bool has_box = window.kind == ABACUS_BOX_WINDOW;
        box.lower[axis] = has_box ? window.lower[axis] : -infinity;
        box.upper[axis] = has_box ? window.upper[axis] : infinity;
    }
    return box;
}

abacus_window window_of(const Box<2> &box) {
    abacus_window window{};
    if (std::isfinite(box.lower[0]) && std::isfinite(box.upper[0])) {
        window.kind = ABACUS_BOX_WINDOW;
        std::copy_n(box.lower.begin(), 2, window.lower);
        std::copy_n(box.upper.begin(), 2, window.upper);
    }
    return window;
}

/// Calls visit(piece) for the pieces of a piece in a box.
template <int D, int bound = 0, class Visit>
void clip_box(const Piece<D> &piece, const Box<D> &box, Visit &&visit) {
    if constexpr (bound == 2 * D) {
        visit(piece);
    } else {
        constexpr int axis = bound / 2;
        constexpr bool is_lower = bound % 2 == 0;
        clip_axis<D>(piece, axis, is_lower ? box.lower[axis] : box.upper[axis], is_lower,
                     [&](const Piece<D> &part) { clip_box<D, bound + 1>(part, box, visit); });
    }
}

/// The area of the surface itself, in space.
double surface_of(const Piece<2> &piece) {
    const auto raised = [&](int i) {
        return Point<3>{piece.corner[i][0], piece.corner[i][1], piece.value[i]};
    };
    return triangle_area(raised(0), raised(1), raised(2));
}

double surface_of(const Piece<3> &piece) { return section_area(piece, piece.value); }

/// Calls visit(simplex, values) for each simplex of a window with the values at its corners, and
/// reports progress.
template <int D, class Visit>
void each_simplex(const Host &host, const abacus_facts &facts, const abacus_surface &surface,
                  const abacus_window &window, Visit visit) {
    Pacer pacer(host);
    pacer.begin(ABACUS_PHASE_SCANNING,
                window.kind == ABACUS_NO_WINDOW ? facts.census.simplices : 0);
    CellScan<D> cells(host, facts, window, surface.extent);
    CornerValues values(&surface.attribute, 1);
    abacus_simplex simplex;
    std::uint64_t seen = 0;
    while (cells.next(simplex, &values)) {
        visit(simplex, values);
        if (++seen % simplices_at_once == 0) pacer.reached(seen);
    }
    pacer.end(seen, {});
}

// ---- Between two meshes ------------------------------------------------------------------

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

/// Adds the volume between two triangles. The smaller one is cut at the edges of the other, so that
/// rounding errors are relative to its own lengths. The choice does not depend on their order.
void add_between(const ValuedSimplex<2> &first, const ValuedSimplex<2> &second,
                 const Box<2> &window, const abacus_extent &extent, Volume<2> &volume) {
    const Piece<2> whole_first = first.piece(), whole_second = second.piece();
    const double area = measure(whole_first), second_area = measure(whole_second);
    const bool is_first_cut =
        area < second_area || (area == second_area && first.corner <= second.corner);
    const ValuedSimplex<2> &cut = is_first_cut ? first : second,
                           &other = is_first_cut ? second : first;
    const Edges edges(other, cut);
    const double steepness = area > 0 ? surface_of(whole_first) / area : 1;
    edges.clip(is_first_cut ? whole_first : whole_second, [&](Piece<2> piece) {
        for (int i = 0; i < 3; ++i) {
            const double height = edges.value_at(piece.corner[i], other.value);
            piece.value[i] = is_first_cut ? piece.value[i] - height : height - piece.value[i];
        }
        clip_box<2>(piece, cut.seen_from_first(window), [&](const Piece<2> &in_window) {
            clip_polygon(cut, in_window, extent,
                         [&](const Piece<2> &part) { volume.add(part, steepness); });
        });
    });
}

} // namespace

// ---- Sums --------------------------------------------------------------------------------

template <int D> void Volume<D>::add(const Piece<D> &piece) {
    area_.add(measure(piece));
    surface_.add(surface_of(piece));
    add_sides(piece);
}

template <int D> void Volume<D>::add(const Piece<D> &piece, double steepness) {
    const double area = measure(piece);
    area_.add(area);
    surface_.add(area * steepness);
    add_sides(piece);
}

template <int D> void Volume<D>::add_sides(const Piece<D> &piece) {
    const auto amount = [](const Piece<D> &part) {
        return D == 2 ? std::fabs(measure(part) * mean(part)) : measure(part);
    };
    const auto [least, greatest] = std::minmax_element(piece.value.begin(), piece.value.end());
    if (*least >= 0) {
        cut_.add(amount(piece));
    } else if (*greatest <= 0) {
        fill_.add(amount(piece));
    } else {
        Sides<D> turned;
        for (int i = 0; i <= D; ++i) turned[i] = -piece.value[i];
        clip<D>(piece, piece.value, [&](const Piece<D> &part) { cut_.add(amount(part)); });
        clip<D>(piece, turned, [&](const Piece<D> &part) { fill_.add(amount(part)); });
    }
}

// ---- Meshes ------------------------------------------------------------------------------

template <int D>
abacus_volume volume_above(const Host &host, const abacus_facts &facts,
                           const abacus_surface &surface, double base) {
    const Box<D> window = box_of<D>(surface.window);
    Volume<D> volume;
    each_simplex<D>(host, facts, surface, surface.window,
                    [&](const abacus_simplex &simplex, const CornerValues &values) {
                        ValuedSimplex<D> cell = cell_of<D>(simplex, values);
                        if (!cell.has_values()) return;
                        for (double &value : cell.value) value -= base;
                        clip_box<D>(
                            cell.piece(), cell.seen_from_first(window), [&](const Piece<D> &piece) {
                                clip_polygon(cell, piece, surface.extent,
                                             [&](const Piece<D> &part) { volume.add(part); });
                            });
                    });
    return volume.sums();
}

abacus_volume volume_between(const Host &host, const abacus_facts &facts,
                             const abacus_surface &surface, const Host &other_host,
                             const abacus_facts &other, std::uint32_t other_attribute,
                             std::size_t cache_bytes) {
    const Box<2> window = box_of<2>(surface.window);
    abacus_extent extent = surface.extent;
    extent.region = no_region; // regions are the mesh's own
    extent.has_box = 0;
    Overlaps overlaps(other_host, other, other_attribute, extent, window, cache_bytes);
    // A small window needs only its own pages, not those of the hull.
    const abacus_window around =
        surface.window.kind == ABACUS_NO_WINDOW ? window_of(overlaps.around_all()) : surface.window;
    Volume<2> volume;
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
                if (second.has_values()) add_between(first, second, window, surface.extent, volume);
            });
        });
    return volume.sums();
}

template class Volume<2>;
template class Volume<3>;
template abacus_volume volume_above<2>(const Host &, const abacus_facts &, const abacus_surface &,
                                       double);
template abacus_volume volume_above<3>(const Host &, const abacus_facts &, const abacus_surface &,
                                       double);

} // namespace abacus
