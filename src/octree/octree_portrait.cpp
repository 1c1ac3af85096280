#include "octree/octree_portrait.hpp"

#include "draw/plane.hpp"
#include "geometry/ball.hpp"
#include "octree/octree_scan.hpp"

#include <cmath>

namespace abacus {
namespace {

// Leaves come along the curve, or nearly so: the cache does not need them for long.
constexpr std::size_t cache_bytes = std::size_t{1} << 20;

/// Whether the drawing leaves out the leaf.
template <int D> bool is_too_long(const Box<D> &leaf, double max_edge) {
    for (int axis = 0; max_edge > 0 && axis < D; ++axis) {
        Point<D> end = leaf.lower;
        end[axis] = leaf.upper[axis];
        if (!is_within<D>(max_edge, leaf.lower, end)) return true;
    }
    return false;
}

void set_values(Patch &patch, double value) { std::fill_n(patch.value, patch.corners, value); }

template <class Picture>
void show(const Box<2> &leaf, double value, const abacus_drawing &drawing, Picture &picture) {
    if (is_too_long<2>(leaf, drawing.extent.max_edge)) return;
    Patch patch;
    patch.corners = 4;
    for (int i = 0; i < 4; ++i) {
        patch.corner[i][0] = i == 1 || i == 2 ? leaf.upper[0] : leaf.lower[0];
        patch.corner[i][1] = i >= 2 ? leaf.upper[1] : leaf.lower[1];
    }
    set_values(patch, value);
    picture.add(patch);
}

/// Leaves cut by a plane.
class Sections {
public:
    /// `sheet`: the part of the plane that is drawn, with its margin.
    Sections(const Host &host, const abacus_facts &facts, const Plane &plane,
             const abacus_drawing &sheet)
        : host_(host), reader_(host, facts, cache_bytes), plane_(plane), sheet_(sheet),
          has_window_(!shows_whole<2>(sheet)) {}

    template <class Picture> void show(Picture &picture) { show(Octant<3>{}, picture); }

private:
    static constexpr int corners = Octant<3>::children;

    template <class Picture> void show(const Octant<3> &octant, Picture &picture) {
        host_.poll();
        const Box<3> box = reader_.grid().box(octant);
        if (plane_.misses(box.lower, box.upper)) return;
        Place places[corners];
        for (int i = 0; i < corners; ++i) places[i] = plane_.place(box.corner(i));
        if (!is_in_window(places)) return;
        const Handle h = reader_.find(octant.code);
        if (reader_.cache().octant(h).level > octant.level) {
            for (int i = 0; i < corners; ++i) show(octant.child(i), picture);
            return;
        }
        Patch patch;
        if (is_too_long<3>(box, sheet_.extent.max_edge) || !cut(octant, places, patch)) return;
        set_values(patch,
                   sheet_.attribute >= 0 ? reader_.cache().values(h)[sheet_.attribute] : NAN);
        double squares = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double edge = (box.upper[axis] - box.lower[axis]) * Plane::scale;
            squares += edge * edge / 3;
        }
        patch.spacing = std::sqrt(squares);
        picture.add(patch);
    }
    bool is_in_window(const Place (&places)[corners]) const {
        for (int axis = 0; has_window_ && axis < 2; ++axis) {
            double least = INFINITY, most = -INFINITY;
            for (const Place &place : places) {
                least = std::min(least, place.at[axis]);
                most = std::max(most, place.at[axis]);
            }
            if (most < sheet_.lower[axis] || sheet_.upper[axis] < least) return false;
        }
        return true;
    }
    bool cut(const Octant<3> &leaf, const Place (&places)[corners], Patch &patch) const;

    const Host &host_;
    OctreeReader<3> reader_;
    const Plane &plane_;
    const abacus_drawing sheet_;
    const bool has_window_;
};

/// Whether places that lie in a plane are a face of the leaf where the domain ends.
bool is_outer_face(const Octant<3> &leaf, unsigned places) {
    const Cell<3> at = leaf.cell();
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            unsigned face = 0;
            for (unsigned i = 0; i < 8; ++i)
                face |= (i >> axis & 1) == unsigned(side) ? 1u << i : 0;
            const bool is_outer =
                side == 0 ? at[axis] == 0 : at[axis] + leaf.edge() == axis_cells<3>;
            if (face == places && is_outer) return true;
        }
    return false;
}

/// Puts the corners of a convex polygon in order.
void put_around(Patch &patch) {
    double middle[2] = {0, 0};
    for (int i = 0; i < patch.corners; ++i)
        for (int axis = 0; axis < 2; ++axis) middle[axis] += patch.corner[i][axis] / patch.corners;
    std::array<std::pair<double, int>, Patch::most> order{}; // by insertion: there are few
    for (int i = 0; i < patch.corners; ++i) {
        const std::pair next{
            std::atan2(patch.corner[i][1] - middle[1], patch.corner[i][0] - middle[0]), i};
        int at = i;
        for (; at > 0 && next < order[at - 1]; --at) order[at] = order[at - 1];
        order[at] = next;
    }
    const Patch before = patch;
    for (int i = 0; i < patch.corners; ++i)
        std::copy_n(before.corner[order[i].second], 2, patch.corner[i]);
}

// As for tetrahedra (draw/section.hpp), a corner on the plane counts as one just above it. So if
// two leaves have a face in the plane, the lower one shows it. At the end of the domain there is no
// lower leaf, and the upper one shows it.
bool Sections::cut(const Octant<3> &leaf, const Place (&places)[corners], Patch &patch) const {
    unsigned below = 0, on = 0;
    for (int i = 0; i < corners; ++i) {
        below |= (places[i].side < 0 ? 1u : 0u) << i;
        on |= (places[i].side == 0 ? 1u : 0u) << i;
    }
    if (below == 0 && !is_outer_face(leaf, on)) return false;
    patch.corners = 0;
    const auto add = [&](double x, double y) {
        if (patch.corners == Patch::most) return;
        patch.corner[patch.corners][0] = x;
        patch.corner[patch.corners++][1] = y;
    };
    for (int i = 0; i < corners; ++i) {
        if ((on >> i & 1) != 0) {
            add(places[i].at[0], places[i].at[1]);
            continue;
        }
        if ((below >> i & 1) == 0) continue;
        for (int axis = 0; axis < 3; ++axis) {
            const Place &low = places[i], &high = places[i ^ 1 << axis];
            if (high.side <= 0) continue;
            const double share = pierced(low, high);
            add(std::lerp(low.at[0], high.at[0], share), std::lerp(low.at[1], high.at[1], share));
        }
    }
    if (patch.corners < 3) return false;
    put_around(patch);
    return true;
}

} // namespace

Portrait draw_octree(const Host &host, const abacus_facts &facts, const abacus_drawing &drawing) {
    const bool is_whole = shows_whole<2>(drawing);
    const std::int32_t margin = is_whole ? 0 : Canvas::margin_of(drawing);
    abacus_drawing wider = is_whole ? drawing : widened(drawing, margin);
    const auto show_leaves = [&](auto &picture) {
        const Box<2> window({wider.lower[0], wider.lower[1]}, {wider.upper[0], wider.upper[1]});
        OctreeScan<2> leaves =
            is_whole ? OctreeScan<2>(host, facts) : OctreeScan<2>(host, facts, window, cache_bytes);
        Octant<2> leaf;
        for (const double *values; leaves.next(leaf, values);)
            show(leaves.grid().box(leaf), drawing.attribute >= 0 ? values[drawing.attribute] : NAN,
                 drawing, picture);
    };
    abacus_drawing plain = drawing;
    plain.contour_interval = 0;
    return draw_patches(host, facts, plain, margin, ABACUS_RAMP_TERRAIN, 1, show_leaves);
}

Portrait draw_octree_section(const Host &host, const abacus_facts &facts,
                             const abacus_section &section, const abacus_drawing &drawing) {
    const Plane plane(section);
    abacus_drawing sheet = drawing;
    sheet.contour_interval = 0;
    const bool has_window = !shows_whole<3>(drawing);
    const SheetWindow window =
        has_window ? plane.window(std::to_array(drawing.lower), std::to_array(drawing.upper))
                   : SheetWindow{};
    std::copy_n(window.lower, 2, sheet.lower);
    std::copy_n(window.upper, 2, sheet.upper);
    const std::int32_t margin = has_window ? Canvas::margin_of(drawing) : 0;
    const abacus_drawing wider = has_window ? widened(sheet, margin) : sheet;
    const auto show_sections = [&](auto &picture) {
        Sections(host, facts, plane, wider).show(picture);
    };
    return draw_patches(host, facts, sheet, margin, ABACUS_RAMP_STRATA, Plane::scale,
                        show_sections);
}

} // namespace abacus
