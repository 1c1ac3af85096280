#include "query/lines/plane_section.hpp"

#include "geometry/ball.hpp"
#include "geometry/tetrahedron_cut.hpp"
#include "keys/domain_of.hpp"
#include "query/pages/page_simplex.hpp"

#include <cmath>

namespace abacus {

namespace {

CuttingPlane plane_of(const abacus_section_query &query) {
    Point<3> through, normal;
    std::copy_n(query.through, 3, through.begin());
    std::copy_n(query.normal, 3, normal.begin());
    return {through, normal};
}

} // namespace

// ---- The region ---------------------------------------------------------------------------

PlaneRegion::PlaneRegion(const CuttingPlane &plane, const Box<3> &around)
    : plane_(plane), inside_(plane.through()), slack_(0) {
    const Point<3> &n = plane.normal();
    const double square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    Point<3> foot;
    for (int i = 0; i < 3; ++i) foot[i] = around.lower[i] * 0.5 + around.upper[i] * 0.5;
    // Alternate between the plane and the box: this leads to a common point, if they meet.
    for (int round = 0; round < 20; ++round) {
        const double way = plane.height(foot) / square;
        for (int i = 0; i < 3; ++i) foot[i] -= n[i] * way;
        if (!std::all_of(foot.begin(), foot.end(), [](double x) { return std::isfinite(x); }))
            break;
        inside_ = foot;
        foot = around.nearest(foot);
    }
    slack_ = 1.01 * std::fabs(plane.height(inside_)); // heights are not exact
}

bool PlaneRegion::may_meet(const Point<3> *const *points, int n) const {
    bool all_above = true, all_below = true;
    for (int i = 0; i < n; ++i) {
        const double height = plane_.height(*points[i]);
        all_above = all_above && height > slack_;
        all_below = all_below && height < -slack_;
    }
    return !all_above && !all_below;
}

bool PlaneRegion::may_meet(const Box<3> &box) const {
    if (box.upper[0] < box.lower[0]) return false; // a page without vertices
    Point<3> lowest, highest;
    for (int i = 0; i < 3; ++i) {
        const bool falls = plane_.normal()[i] < 0;
        lowest[i] = falls ? box.upper[i] : box.lower[i];
        highest[i] = falls ? box.lower[i] : box.upper[i];
    }
    return plane_.height(lowest) <= slack_ && plane_.height(highest) >= -slack_;
}

// ---- The section --------------------------------------------------------------------------

PlaneSection::PlaneSection(const Host &host, const abacus_facts &facts,
                           const abacus_section_query &query)
    : plane_(plane_of(query)), values_(host, facts, query.attribute), extent_(query.extent),
      is_split_(facts.census.split > 0), domain_(domain_of<3>(facts.form)),
      region_(plane_, domain_box<3>(facts.form)), pages_(host, facts, &region_) {}

bool PlaneSection::next(abacus_polygon &polygon) {
    for (;;) {
        if (!in_page_) {
            if (!pages_.advance()) return false;
            enter();
        }
        while (at_ < pages_.page().simplices())
            if (take(at_++, polygon)) return true;
        in_page_ = false;
    }
}

void PlaneSection::enter() {
    const PageView<3> &page = pages_.page();
    values_.enter(page);
    for (int v = 0; v < page.vertices(); ++v) heights_[v] = plane_.height(page.point(v));
    in_page_ = true;
    at_ = 0;
}

bool PlaneSection::take(int simplex, abacus_polygon &polygon) const {
    const PageView<3> &page = pages_.page();
    polygon.corners = 0;
    if (!page.is_ghost(simplex)) {
        if (!cut(simplex, polygon)) return false;
    } else {
        if (!is_bottom(simplex) || !is_in<3>(extent_, pages_.page(), simplex, 3)) return false;
        if (is_split_ && is_of_fault(simplex)) return false; // the simplex below has this section
        // The facet as seen from inside, which is above.
        for (const int i : {0, 2, 1}) add(page.corner(simplex, i), polygon);
    }
    polygon.code = code_of(page, simplex, domain_);
    // The order of the corners in memory depends on the history of the simplex.
    const auto is_less = [](const double(&p)[3], const double(&q)[3]) {
        return std::lexicographical_compare(p, p + 3, q, q + 3);
    };
    int first = 0;
    for (int i = 1; i < polygon.corners; ++i)
        if (is_less(polygon.point[i], polygon.point[first])) first = i;
    double *const points = polygon.point[0];
    std::rotate(points, points + 3 * first, points + 3 * polygon.corners);
    std::rotate(polygon.value, polygon.value + first, polygon.value + polygon.corners);
    return true;
}

bool PlaneSection::cut(int simplex, abacus_polygon &polygon) const {
    const PageView<3> &page = pages_.page();
    unsigned above = 0;
    for (int i = 0; i < 4; ++i)
        above |= static_cast<unsigned>(heights_[page.corner(simplex, i)] >= 0) << i;
    const TetrahedronCut &cut = tetrahedron_cuts[above];
    if (cut.corners == 0) return false;
    // In the order as seen from above, so in reverse. A corner on a vertex is added once; its edges
    // follow one another.
    int last = -1;
    for (int i = cut.corners; i-- > 0;) {
        const int below = page.corner(simplex, cut.edge[i].below);
        const int vertex = page.corner(simplex, cut.edge[i].above);
        const bool is_on = heights_[vertex] == 0;
        if (is_on && vertex == last) continue;
        if (is_on)
            add(vertex, polygon);
        else
            add(below, vertex, polygon);
        last = is_on ? vertex : -1;
    }
    return polygon.corners >= 3 && is_in<3>(extent_, pages_.page(), simplex);
}

/// Whether a ghost's facet is in the plane, with the mesh above it.
bool PlaneSection::is_bottom(int ghost) const {
    const PageView<3> &page = pages_.page();
    for (int i = 0; i < 3; ++i)
        if (heights_[page.corner(ghost, i)] != 0) return false;
    // The corners turn to the left as seen from outside. Along an axis on which the normal is not
    // 0, the facet does not appear as a line.
    const Point<3> &normal = plane_.normal();
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::fabs(normal[i]) > std::fabs(normal[axis])) axis = i;
    const auto flat = [&](int i) {
        const Point<3> &p = page.point(page.corner(ghost, i));
        return Point<2>{p[(axis + 1) % 3], p[(axis + 2) % 3]};
    };
    return (orientation(flat(0), flat(1), flat(2)) > 0) == (normal[axis] < 0);
}

/// Whether another ghost has its facet at the same place. Such a ghost has the same key, so it is
/// on the same page.
bool PlaneSection::is_of_fault(int ghost) const {
    const PageView<3> &page = pages_.page();
    const auto has_corner = [&](int other, const Point<3> &p) {
        return page.point(page.corner(other, 0)) == p || page.point(page.corner(other, 1)) == p ||
               page.point(page.corner(other, 2)) == p;
    };
    for (int other = 0; other < page.simplices(); ++other) {
        if (other == ghost || !page.is_ghost(other)) continue;
        int shared = 0;
        for (int i = 0; i < 3; ++i) shared += has_corner(other, page.point(page.corner(ghost, i)));
        if (shared == 3) return true;
    }
    return false;
}

void PlaneSection::add(int vertex, abacus_polygon &polygon) const {
    std::copy_n(pages_.page().point(vertex).begin(), 3, polygon.point[polygon.corners]);
    polygon.value[polygon.corners++] = values_.value(vertex);
}

void PlaneSection::add(int below, int above, abacus_polygon &polygon) const {
    const PageView<3> &page = pages_.page();
    const bool is_turned = page.point(above) < page.point(below);
    const int from = is_turned ? above : below, to = is_turned ? below : above;
    const double share = share_at(0, heights_[from], heights_[to]);
    Point<3> p = point_between(page.point(from), page.point(to), share);
    if (const int axis = plane_.axis(); axis >= 0) p[axis] = plane_.through()[axis] + 0.0;
    std::copy_n(p.begin(), 3, polygon.point[polygon.corners]);
    polygon.value[polygon.corners++] = value_between(values_.value(from), values_.value(to), share);
}

} // namespace abacus
