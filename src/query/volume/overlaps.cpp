#include "query/volume/overlaps.hpp"

#include "geometry/ball.hpp"
#include "geometry/overlap.hpp"
#include "query/pages/page_simplex.hpp"

#include <algorithm>
#include <limits>

namespace abacus {

namespace {

/// How many triangles a flood may meet.
constexpr std::size_t most_met = 1024;

bool is_strictly_inside(const Box<2> &box, const Point<2> &p) {
    return box.lower[0] < p[0] && p[0] < box.upper[0] && box.lower[1] < p[1] && p[1] < box.upper[1];
}

} // namespace

/// The requested part of the plane: the triangle, clipped to the window if `inside` is in it.
class Overlaps::Area final : public Region<2> {
public:
    Area(const Asked &t, const Box<2> &window) : t_(t), window_(window) {}

    Point<2> inside(const Domain<2> &) const override { return t_.inside; }
    bool may_meet(const Point<2> *const *points, int n) const override {
        Box<2> around;
        for (int i = 0; i < n; ++i) around.extend(*points[i]);
        return may_meet_window(around) && t_.box.meets(around) &&
               !lie_beyond_edge(t_.corners, points, n, true);
    }
    bool may_meet(const Box<2> &box) const override {
        return may_meet_window(box) && meets<2>(t_.corners, box);
    }
    /// True even if the triangle touches the facet: then nothing overlaps.
    bool lies_beyond(const Corners<2> &facet) const override {
        return std::all_of(t_.corners.begin(), t_.corners.end(), [&](const Point<2> *corner) {
            return facet_side<2>(facet, 2, *corner) >= 0;
        });
    }
    bool has_much_of(const Domain<2> &domain) const override {
        return BoxRegion<2>(t_.box).has_much_of(domain);
    }

private:
    bool may_meet_window(const Box<2> &box) const {
        return !t_.is_strictly_inside || window_.meets(box);
    }

    const Asked &t_;
    const Box<2> &window_;
};

Overlaps::Overlaps(const Host &host, const abacus_facts &facts, std::uint32_t attribute,
                   const abacus_extent &extent, const Box<2> &window, std::size_t cache_bytes)
    : host_(host), facts_(facts), attribute_(static_cast<int>(attribute)), extent_(extent),
      window_(window), reader_(host, facts, cache_bytes) {
    if (!reader_.is_convex())
        search_.emplace(host, page_attributes(facts.columns), cache_bytes / 2);
}

// Follows the hull's edges, from one that is visible from far away.
Box<2> Overlaps::around_all() {
    if (reader_.is_empty()) return {};
    if (!reader_.is_convex()) return reader_.boxes().around_all();
    constexpr double far = std::numeric_limits<double>::max();
    PageFlood<2> hull(host_, facts_);
    const PageView<2> &page = hull.page();
    hull.reach(reader_.page_around({far, far})->page);
    Box<2> box;
    while (hull.advance()) {
        for (int s = 0; s < page.simplices(); ++s)
            for (int i = 0; i < 2 && page.is_ghost(s); ++i)
                box.extend(page.point(page.corner(s, i)));
        hull.spread([&](int s, int facet) { return facet < 2 && page.is_ghost(s); });
    }
    return box;
}

void Overlaps::each(const Corners<2> &triangle, const Visit &visit) {
    if (reader_.is_empty()) return;
    host_.poll();
    const Asked t = asked(triangle);
    if (search_)
        search_pages(t, visit);
    else if (!flood(t, visit))
        scan_pages(t, visit);
}

/// Chooses the middle of the triangle or, if that is outside the window, of the triangle's box
/// there.
Overlaps::Asked Overlaps::asked(const Corners<2> &triangle) const {
    Box<2> box;
    for (const Point<2> *corner : triangle) box.extend(*corner);
    Asked t{triangle, box, *triangle[0], false};
    Point<2> middle, shared;
    for (int axis = 0; axis < 2; ++axis) {
        middle[axis] = 0;
        for (const Point<2> *corner : triangle) middle[axis] += (*corner)[axis] / 3;
        shared[axis] = std::max(box.lower[axis], window_.lower[axis]) / 2 +
                       std::min(box.upper[axis], window_.upper[axis]) / 2;
    }
    for (const Point<2> &p : {middle, shared})
        if (is_strictly_inside(window_, p) && in_simplex<2>(triangle, p) > 0) {
            t.inside = p;
            t.is_strictly_inside = true;
            break;
        }
    return t;
}

bool Overlaps::crosses(const Asked &t, const Point<2> &a, const Point<2> &b) const {
    Box<2> edge;
    edge.extend(a);
    edge.extend(b);
    if (!edge.meets(t.box)) return false;
    return !t.is_strictly_inside || (edge.meets(window_) && passes_through(a, b, t.corners));
}

Handle Overlaps::begin(const Asked &t) {
    const Handle h = reader_.simplex_around(t.inside);
    return reader_.cache().simplex(h).is_ghost() ? begin_outside(t, h) : h;
}

Handle Overlaps::begin_outside(const Asked &t, Handle ghost) {
    Cache<2> &cache = reader_.cache();
    const auto corners = [&](Handle h) {
        const Simplex<2> &s = cache.simplex(h);
        return Corners<2>{&cache.point(s.vertex[0]), &cache.point(s.vertex[1]), &t.inside};
    };
    const auto sees = [&](Handle h) { return orientation<2>(corners(h)) > 0; };
    Handle edge = no_handle;
    bool goes_on = true;
    reader_.flood().from(
        cache, ghost, [&](Handle h, int facet) { return facet < 2 && sees(h); },
        [&](Handle h) {
            if (!sees(h)) return true;
            const Corners<2> facet = corners(h);
            goes_on = !Area(t, window_).lies_beyond(facet);
            if (goes_on && crosses(t, *facet[0], *facet[1])) {
                edge = h;
                goes_on = false;
            }
            return goes_on;
        });
    return edge == no_handle ? no_handle : link_simplex(cache.cross(edge, 2));
}

bool Overlaps::flood(const Asked &t, const Visit &visit) {
    const Handle first = begin(t);
    if (first == no_handle) return true;
    Cache<2> &cache = reader_.cache();
    std::size_t met = 0;
    const auto may_cross = [&](Handle h, int facet) {
        const Simplex<2> &s = cache.simplex(h);
        return !s.is_ghost() && crosses(t, cache.point(s.vertex[(facet + 1) % 3]),
                                        cache.point(s.vertex[(facet + 2) % 3]));
    };
    Flood<2> &around = reader_.flood();
    if (!around.from(cache, first, may_cross, [&](Handle) { return ++met <= most_met; }))
        return false;
    for (const Handle h : around.met()) {
        const Simplex<2> &s = cache.simplex(h);
        if (s.is_ghost()) continue;
        std::array<double, 3> values;
        for (int i = 0; i < 3; ++i)
            values[i] = reader_.vertex_values().value(cache.vertices(), s.vertex[i], attribute_);
        show(t, cache.corners(s), values, visit);
    }
    return true;
}

void Overlaps::scan_pages(const Asked &t, const Visit &visit) {
    const Area area(t, window_);
    RangeScan<2> pages(host_, facts_, &area);
    while (pages.advance())
        for (int s = 0; s < pages.page().simplices(); ++s)
            if (!pages.page().is_ghost(s)) show(t, pages.page(), s, visit);
}

void Overlaps::search_pages(const Asked &t, const Visit &visit) {
    if (!t.box.meets(window_)) return;
    Box<2> box;
    for (int axis = 0; axis < 2; ++axis) {
        box.lower[axis] = std::max(t.box.lower[axis], window_.lower[axis]);
        box.upper[axis] = std::min(t.box.upper[axis], window_.upper[axis]);
    }
    reader_.boxes().meeting(box, [&](Key key, const Key &end) {
        while (key < end) {
            host_.poll();
            key = search_->near(key, box, [&](const PageView<2> &page, int simplex) {
                show(t, page, simplex, visit);
            });
        }
        return true;
    });
}

void Overlaps::show(const Asked &t, const PageView<2> &page, int simplex,
                    const Visit &visit) const {
    std::array<double, 3> values;
    for (int i = 0; i < 3; ++i)
        values[i] = reader_.vertex_values().value(page, page.corner(simplex, i), attribute_);
    show(t, corners_of(page, simplex), values, visit);
}

void Overlaps::show(const Asked &t, const Corners<2> &corners, const std::array<double, 3> &values,
                    const Visit &visit) const {
    Box<2> box;
    for (const Point<2> *corner : corners) box.extend(*corner);
    if (!box.meets(t.box) || !overlap(t.corners, corners)) return;
    if (is_in<2>(extent_, no_region, corners)) visit(corners, values);
}

} // namespace abacus
