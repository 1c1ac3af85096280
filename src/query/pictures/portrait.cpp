#include "query/pictures/portrait.hpp"

#include "draw/section.hpp"
#include "geometry/clip_trapezoid.hpp"
#include "geometry/map_plane.hpp"
#include "query/levels/contours.hpp"
#include "query/pages/extent.hpp"
#include "query/pages/page_values.hpp"
#include "query/scan/extent_pages.hpp"
#include "query/scan/range_scan.hpp"
#include "query/scan/simplex_labels.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <type_traits>

namespace abacus {

namespace {

/// The data of a simplex that both views use.
template <int D> class MeshView {
public:
    static constexpr int dimension = D;

    void enter(const PageView<D> &page) { values_.enter(page); }

protected:
    MeshView(const Host &host, const abacus_facts &facts, const abacus_drawing &drawing)
        : label_(drawing.attribute - static_cast<int>(facts.columns.attributes)),
          labels_(host, facts), values_(host, facts, label_ < 0 ? drawing.attribute : -1),
          extent_(drawing.extent) {}

    double value(int vertex) const { return values_.value(vertex); }
    /// Sets the values of a patch to the simplex's label, if the drawing shows a label.
    void set_label(const PageView<D> &page, int simplex, Patch &patch) {
        if (label_ >= 0)
            std::fill_n(patch.value, patch.corners, labels_.of_page(page, simplex)[label_]);
    }
    /// Null: there is none.
    const Polygon *polygon() const { return polygon_of(extent_); }
    /// Whether the drawing has the simplex with these first `n` corners.
    bool is_shown(const PageView<D> &page, int simplex, int n) const {
        return is_in<D>(extent_, page, simplex, n);
    }

private:
    const int label_; // its number; negative: there is an attribute, or nothing
    SimplexLabels<D> labels_;
    PageValues<D> values_;
    abacus_extent extent_;
};

void put(const Point<2> &place, Patch &patch, int corner) {
    patch.corner[corner][0] = place[0];
    patch.corner[corner][1] = place[1];
}

/// The triangles of a mesh.
class FlatView : public MeshView<2> {
public:
    static constexpr double unit = 1; // of coordinates, in the picture

    FlatView(const Host &host, const abacus_facts &facts, const abacus_drawing &drawing)
        : MeshView(host, facts, drawing), plane_(drawing.is_geographic != 0) {}

    bool show(const PageView<2> &page, int simplex, Patch &patch) {
        if (page.is_ghost(simplex) || !is_shown(page, simplex, 3)) return false;
        for (int i = 0; i < 3; ++i) {
            const int v = page.corner(simplex, i);
            put(patch, i, page.point(v));
            patch.value[i] = value(v);
        }
        set_label(page, simplex, patch);
        set_fixed(page.fixed(simplex), patch);
        return true;
    }
    /// Calls visit(patch) for the parts of a simplex in the polygon, if there is one.
    template <class Visit> void show_parts(const PageView<2> &page, int simplex, Visit visit) {
        Patch patch;
        if (!show(page, simplex, patch)) return;
        if (polygon() == nullptr) return visit(patch);
        const Point<2> &origin = page.point(page.corner(simplex, 0));
        Piece<2> whole;
        Box<2> box;
        for (int i = 0; i < 3; ++i) {
            const Point<2> &p = page.point(page.corner(simplex, i));
            box.extend(p);
            whole.corner[i] = {p[0] - origin[0], p[1] - origin[1]};
            whole.value[i] = patch.value[i];
        }
        polygon()->each_part(box, [&](const Polygon::Trapezoid &part) {
            clip_trapezoid(whole, part, origin, [&](const Piece<2> &piece) {
                for (int i = 0; i < 3; ++i) {
                    const Point<2> &p = piece.corner[i];
                    put(patch, i, {p[0] + origin[0], p[1] + origin[1]});
                    patch.value[i] = piece.value[i];
                }
                visit(patch);
            });
        });
    }

private:
    void put(Patch &patch, int corner, const Point<2> &place) const {
        abacus::put(plane_.project(place), patch, corner);
    }
    static void set_fixed(const FixedFacets<2> &fixed, Patch &patch) {
        patch.region = fixed.region();
        for (int i = 0; i < 3; ++i) { // opposite of corner i; it ends two further
            const Fixed kind = fixed[i];
            patch.edge[(i + 2) % 3] = kind == Fixed::hard   ? Patch::Edge::hard
                                      : kind == Fixed::soft ? Patch::Edge::soft
                                                            : Patch::Edge::free;
        }
    }

    // a tile has a plane of its own; other drawings use coordinates
    const MapPlane plane_;
};

/// The sections of the tetrahedra of a mesh by a plane.
class SectionView : public MeshView<3> {
public:
    static constexpr double unit = Plane::scale;

    SectionView(const Host &host, const abacus_facts &facts, const Plane &plane,
                const abacus_drawing &drawing)
        : MeshView(host, facts, drawing), plane_(plane) {}

    void enter(const PageView<3> &page) {
        MeshView::enter(page);
        for (int v = 0; v < page.vertices(); ++v) places_[v] = plane_.place(page.point(v));
    }
    bool show(const PageView<3> &page, int simplex, Patch &patch) {
        const int finite = page.is_ghost(simplex) ? 3 : 4;
        return (finite == 3 ? cut<cut_ghost, 3>(page, simplex, patch)
                            : cut<cut_tetrahedron, 4>(page, simplex, patch)) &&
               is_shown(page, simplex, finite);
    }

private:
    template <auto section, int n> bool cut(const PageView<3> &page, int simplex, Patch &patch) {
        int sides = 0;
        for (int i = 0; i < n; ++i) sides += places_[page.corner(simplex, i)].side;
        if (std::abs(sides) == n) return false;
        Cut corner[n];
        for (int i = 0; i < n; ++i) {
            const int v = page.corner(simplex, i);
            corner[i] = {places_[v], value(v)};
        }
        if (!section(corner, patch)) return false;
        set_label(page, simplex, patch);
        patch.spacing = spacing(page, simplex, n);
        return true;
    }
    /// Root mean square of the edges of a simplex with n finite corners: the distance of its
    /// vertices, however flat it is.
    static double spacing(const PageView<3> &page, int simplex, int n) {
        double sum = 0;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < i; ++j) {
                const Point<3> p = page.point(page.corner(simplex, i));
                const Point<3> q = page.point(page.corner(simplex, j));
                for (int axis = 0; axis < 3; ++axis) {
                    const double side = (p[axis] - q[axis]) * Plane::scale;
                    sum += side * side;
                }
            }
        return std::sqrt(sum / (n * (n - 1) / 2));
    }

    Plane plane_;
    std::array<Place, page_vertices<3>> places_;
};

/// The part of space that a section shows: the plane, or its part in a window of the sheet. The
/// places of vertices decide, as they do when drawing.
class SectionRegion : public Region<3> {
public:
    SectionRegion(const Plane &plane, const abacus_section &section, const abacus_drawing &sheet)
        : plane_(plane), sheet_(sheet), has_window_(!shows_whole<2>(sheet)) {
        std::copy_n(section.through, 3, through_.begin());
    }

    Point<3> inside(const Domain<3> &) const override {
        if (!has_window_) return through_;
        return plane_.point({sheet_.lower[0] * 0.5 + sheet_.upper[0] * 0.5,
                             sheet_.lower[1] * 0.5 + sheet_.upper[1] * 0.5});
    }
    bool may_meet(const Point<3> *const *points, int n) const override {
        int sides = 0;
        double lower[2] = {INFINITY, INFINITY}, upper[2] = {-INFINITY, -INFINITY};
        for (int i = 0; i < n; ++i) {
            const Place place = plane_.place(*points[i]);
            sides += place.side;
            for (int axis = 0; axis < 2; ++axis) {
                lower[axis] = std::min(lower[axis], place.at[axis]);
                upper[axis] = std::max(upper[axis], place.at[axis]);
            }
        }
        if (std::abs(sides) == n) return false;
        for (int axis = 0; has_window_ && axis < 2; ++axis)
            if (upper[axis] < sheet_.lower[axis] || sheet_.upper[axis] < lower[axis]) return false;
        return true;
    }
    bool may_meet(const Box<3> &box) const override { return !plane_.misses(box.lower, box.upper); }

private:
    const Plane plane_;
    const abacus_drawing sheet_;
    const bool has_window_;
    Point<3> through_;
};

/// Shows everything on the pages to `picture`, an Extent or a Canvas.
template <int D, class View, class Picture>
void stream(RangeScan<D> &pages, View &view, Picture &picture) {
    Patch patch;
    while (pages.advance()) {
        const PageView<D> &page = pages.page();
        view.enter(page);
        for (int s = 0; s < page.simplices(); ++s)
            if constexpr (D == 2 && std::is_same_v<Picture, Extent>)
                view.show_parts(page, s, [&](const Patch &part) { picture.add(part); });
            else if (view.show(page, s, patch))
                picture.add(patch);
    }
}

/// Writes values on contours, if the drawing wants them.
void label_contours(const Host &host, const abacus_facts &facts, const abacus_drawing &drawing,
                    Canvas &canvas) {
    const Arena<double> levels = canvas.labelled_levels();
    if (levels.empty()) return;
    abacus_contouring contouring{};
    contouring.attribute = static_cast<std::uint32_t>(drawing.attribute);
    contouring.fixed = levels.data();
    contouring.fixed_count = levels.size();
    contouring.extent = drawing.extent;
    abacus_window window{};
    window.kind = ABACUS_BOX_WINDOW;
    std::copy_n(canvas.drawing().lower, 2, window.lower);
    std::copy_n(canvas.drawing().upper, 2, window.upper);
    const auto report = [](void *to, std::int64_t, double value, std::int32_t, const double *path,
                           std::size_t count) {
        static_cast<Canvas *>(to)->label(value, {reinterpret_cast<const Point<2> *>(path), count});
        return ABACUS_HOST_OK;
    };
    Contours(host, facts, window, contouring, drawing.memory).each(report, &canvas);
}

/// `region` is the part that the drawing shows with its margin; null: the whole mesh.
template <int D, class View>
Portrait draw(const Host &host, const abacus_facts &facts, const abacus_drawing &drawing,
              std::int32_t margin, const Region<D> *region, View &&view, abacus_ramp usual) {
    RangeScan<D> pages(host, facts, region, pages_in<D>(drawing.extent));
    bool again = false;
    const auto show = [&](auto &picture) {
        if (std::exchange(again, true)) pages.rewind();
        stream(pages, view, picture);
        if constexpr (D == 2 && std::is_same_v<decltype(picture), Canvas &>) {
            leave_polygon(drawing, picture);
            label_contours(host, facts, drawing, picture);
        }
    };
    return draw_patches(host, facts, drawing, margin, usual, View::unit, show);
}

/// What a drawing with a window shows with its margin.
BoxRegion<2> shown(const abacus_drawing &drawing, std::int32_t margin) {
    const abacus_drawing wider = widened(drawing, margin);
    const MapPlane plane(drawing.is_geographic != 0);
    return BoxRegion<2>(plane.unproject(
        Box<2>({wider.lower[0], wider.lower[1]}, {wider.upper[0], wider.upper[1]})));
}

} // namespace

Portrait draw_mesh(const Host &host, const abacus_facts &facts, const abacus_drawing &drawing) {
    if (shows_whole<2>(drawing)) {
        const std::optional<Box<2>> box = box_of(drawing.extent);
        const BoxRegion<2> around(box.value_or(Box<2>()));
        return draw<2>(host, facts, drawing, 0, box ? &around : nullptr,
                       FlatView(host, facts, drawing), ABACUS_RAMP_TERRAIN);
    }
    const std::int32_t margin = Canvas::margin_of(drawing);
    const BoxRegion<2> region = shown(drawing, margin);
    return draw<2>(host, facts, drawing, margin, &region, FlatView(host, facts, drawing),
                   ABACUS_RAMP_TERRAIN);
}

void leave_polygon(const abacus_drawing &drawing, Canvas &canvas) {
    const Polygon *polygon = polygon_of(drawing.extent);
    if (polygon == nullptr) return;
    const MapPlane plane(drawing.is_geographic != 0);
    canvas.leave_only([&](const auto &keep) {
        polygon->each_part(polygon->box(), [&](const Polygon::Trapezoid &part) {
            Patch patch{};
            patch.corners = 4;
            for (int i = 0; i < 4; ++i) put(plane.project(part.corner(i)), patch, i);
            keep(patch);
        });
    });
}

void draw_fixed_edges(const Host &host, const abacus_facts &facts, const abacus_drawing &drawing,
                      Canvas &canvas) {
    if (facts.census.lines == 0 || (drawing.lines == 0 && drawing.regions == 0)) return;
    abacus_drawing edges = drawing;
    edges.attribute = -1;
    const BoxRegion<2> region = shown(drawing, Canvas::margin_of(drawing));
    RangeScan<2> pages(host, facts, &region, pages_in<2>(drawing.extent));
    FlatView view(host, facts, edges);
    Patch patch;
    while (pages.advance()) {
        const PageView<2> &page = pages.page();
        for (int s = 0; page.is_lined() && s < page.simplices(); ++s)
            if (page.fixed(s).count() > 0 && view.show(page, s, patch)) canvas.add_edges(patch);
    }
}

Portrait draw_section(const Host &host, const abacus_facts &facts, const abacus_section &section,
                      const abacus_drawing &drawing) {
    const Plane plane(section);
    abacus_drawing sheet = drawing;
    const bool has_window = !shows_whole<3>(drawing);
    const SheetWindow window =
        has_window ? plane.window(std::to_array(drawing.lower), std::to_array(drawing.upper))
                   : SheetWindow{};
    std::copy_n(window.lower, 2, sheet.lower);
    std::copy_n(window.upper, 2, sheet.upper);
    const std::int32_t margin = has_window ? Canvas::margin_of(drawing) : 0;
    const SectionRegion region(plane, section, has_window ? widened(sheet, margin) : sheet);
    return draw<3>(host, facts, sheet, margin, &region, SectionView(host, facts, plane, drawing),
                   ABACUS_RAMP_STRATA);
}

} // namespace abacus
