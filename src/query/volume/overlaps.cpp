#include "query/volume/overlaps.hpp"

#include "geometry/ball.hpp"
#include "query/pages/page_simplex.hpp"

#include <algorithm>
#include <limits>

namespace abacus {

namespace {

/// How many simplices a flood may meet.
constexpr std::size_t most_met = 1024;

template <int D> bool is_strictly_inside(const Box<D> &box, const Point<D> &p) {
    bool is_inside = true;
    for (int i = 0; i < D; ++i) is_inside &= box.lower[i] < p[i] && p[i] < box.upper[i];
    return is_inside;
}

} // namespace

/// The requested part: the simplex, clipped to the window if `inside` is in it.
template <int D> class Overlaps<D>::Area final : public Region<D> {
public:
    Area(const Asked &t, const Box<D> &window) : t_(t), window_(window) {}

    Point<D> inside(const Domain<D> &) const override { return t_.inside; }
    bool may_meet(const Point<D> *const *points, int n) const override {
        Box<D> around;
        for (int i = 0; i < n; ++i) around.extend(*points[i]);
        return may_meet_window(around) && t_.box.meets(around) &&
               !lie_beyond_facet<D>(t_.corners, points, n, true);
    }
    bool may_meet(const Box<D> &box) const override {
        return may_meet_window(box) && meets<D>(t_.corners, box);
    }
    /// True even if the triangle touches the facet: then nothing overlaps.
    bool lies_beyond(const Corners<D> &facet) const override {
        return std::all_of(t_.corners.begin(), t_.corners.end(), [&](const Point<D> *corner) {
            return facet_side<D>(facet, D, *corner) >= 0;
        });
    }
    bool has_much_of(const Domain<D> &domain) const override {
        return BoxRegion<D>(t_.box).has_much_of(domain);
    }

private:
    bool may_meet_window(const Box<D> &box) const {
        return !t_.is_strictly_inside || window_.meets(box);
    }

    const Asked &t_;
    const Box<D> &window_;
};

template <int D>
Overlaps<D>::Overlaps(const Host &host, const abacus_facts &facts, std::uint32_t attribute,
                      const abacus_extent &extent, const Box<D> &window, std::size_t cache_bytes)
    : host_(host), facts_(facts), attribute_(static_cast<int>(attribute)), extent_(extent),
      window_(window), reader_(host, facts, cache_bytes) {
    if (!reader_.is_convex())
        search_.emplace(host, page_attributes(facts.columns), cache_bytes / 2);
}

// Follows the hull's edges, from one that is visible from far away.
template <int D> Box<D> Overlaps<D>::around_all() {
    if (reader_.is_empty()) return {};
    if (!reader_.is_convex()) return reader_.boxes().around_all();
    Point<D> far;
    far.fill(std::numeric_limits<double>::max());
    PageFlood<D> hull(host_, facts_);
    const PageView<D> &page = hull.page();
    hull.reach(reader_.page_around(far)->page);
    Box<D> box;
    while (hull.advance()) {
        for (int s = 0; s < page.simplices(); ++s)
            for (int i = 0; i < D && page.is_ghost(s); ++i)
                box.extend(page.point(page.corner(s, i)));
        hull.spread([&](int s, int facet) { return facet < D && page.is_ghost(s); });
    }
    return box;
}

template <int D> void Overlaps<D>::each(const Corners<D> &simplex, const Visit &visit) {
    if (reader_.is_empty()) return;
    host_.poll();
    const Asked t = asked(simplex);
    if (search_)
        search_pages(t, visit);
    else if (!flood(t, visit))
        scan_pages(t, visit);
}

/// Chooses the middle of the simplex or, if that is outside the window, of the simplex's box
/// there.
template <int D> typename Overlaps<D>::Asked Overlaps<D>::asked(const Corners<D> &simplex) const {
    Box<D> box;
    for (const Point<D> *corner : simplex) box.extend(*corner);
    Asked t{simplex, box, *simplex[0], false};
    Point<D> middle, shared;
    for (int axis = 0; axis < D; ++axis) {
        middle[axis] = 0;
        for (const Point<D> *corner : simplex) middle[axis] += (*corner)[axis] / (D + 1);
        shared[axis] = std::max(box.lower[axis], window_.lower[axis]) / 2 +
                       std::min(box.upper[axis], window_.upper[axis]) / 2;
    }
    for (const Point<D> &p : {middle, shared})
        if (is_strictly_inside<D>(window_, p) && in_simplex<D>(simplex, p) > 0) {
            t.inside = p;
            t.is_strictly_inside = true;
            break;
        }
    return t;
}

template <int D> bool Overlaps<D>::crosses(const Asked &t, const FacetCorners<D> &facet) const {
    Box<D> box;
    for (const Point<D> *corner : facet) box.extend(*corner);
    if (!box.meets(t.box)) return false;
    return !t.is_strictly_inside || (box.meets(window_) && may_pass_through<D>(facet, t.corners));
}

template <int D> Handle Overlaps<D>::begin(const Asked &t) {
    const Handle h = reader_.simplex_around(t.inside);
    return reader_.cache().simplex(h).is_ghost() ? begin_outside(t, h) : h;
}

template <int D> Handle Overlaps<D>::begin_outside(const Asked &t, Handle ghost) {
    Cache<D> &cache = reader_.cache();
    const auto corners = [&](Handle h) {
        const Simplex<D> &s = cache.simplex(h);
        Corners<D> points;
        for (int i = 0; i < D; ++i) points[i] = &cache.point(s.vertex[i]);
        points[D] = &t.inside;
        return points;
    };
    const auto sees = [&](Handle h) { return orientation<D>(corners(h)) > 0; };
    Handle found = no_handle;
    bool goes_on = true;
    reader_.flood().from(
        cache, ghost, [&](Handle h, int facet) { return facet < D && sees(h); },
        [&](Handle h) {
            if (!sees(h)) return true;
            const Corners<D> seen = corners(h);
            FacetCorners<D> facet;
            std::copy_n(seen.begin(), D, facet.begin());
            goes_on = !Area(t, window_).lies_beyond(seen);
            if (goes_on && crosses(t, facet)) {
                found = h;
                goes_on = false;
            }
            return goes_on;
        });
    return found == no_handle ? no_handle : link_simplex(cache.cross(found, D));
}

template <int D> bool Overlaps<D>::flood(const Asked &t, const Visit &visit) {
    const Handle first = begin(t);
    if (first == no_handle) return true;
    Cache<D> &cache = reader_.cache();
    std::size_t met = 0;
    const auto may_cross = [&](Handle h, int facet) {
        const Simplex<D> &s = cache.simplex(h);
        FacetCorners<D> corners;
        for (int i = 0; i < D; ++i) corners[i] = &cache.point(s.vertex[i + (i >= facet)]);
        return !s.is_ghost() && crosses(t, corners);
    };
    Flood<D> &around = reader_.flood();
    if (!around.from(cache, first, may_cross, [&](Handle) { return ++met <= most_met; }))
        return false;
    for (const Handle h : around.met()) {
        const Simplex<D> &s = cache.simplex(h);
        if (s.is_ghost()) continue;
        std::array<double, D + 1> values;
        for (int i = 0; i <= D; ++i)
            values[i] = reader_.vertex_values().value(cache.vertices(), s.vertex[i], attribute_);
        show(t, cache.corners(s), values, visit);
    }
    return true;
}

template <int D> void Overlaps<D>::scan_pages(const Asked &t, const Visit &visit) {
    const Area area(t, window_);
    RangeScan<D> pages(host_, facts_, &area);
    while (pages.advance())
        for (int s = 0; s < pages.page().simplices(); ++s)
            if (!pages.page().is_ghost(s)) show(t, pages.page(), s, visit);
}

template <int D> void Overlaps<D>::search_pages(const Asked &t, const Visit &visit) {
    if (!t.box.meets(window_)) return;
    Box<D> box;
    for (int axis = 0; axis < D; ++axis) {
        box.lower[axis] = std::max(t.box.lower[axis], window_.lower[axis]);
        box.upper[axis] = std::min(t.box.upper[axis], window_.upper[axis]);
    }
    reader_.boxes().meeting(box, [&](Key key, const Key &end) {
        while (key < end) {
            host_.poll();
            key = search_->near(key, box, [&](const PageView<D> &page, int simplex) {
                show(t, page, simplex, visit);
            });
        }
        return true;
    });
}

template <int D>
void Overlaps<D>::show(const Asked &t, const PageView<D> &page, int simplex,
                       const Visit &visit) const {
    std::array<double, D + 1> values;
    for (int i = 0; i <= D; ++i)
        values[i] = reader_.vertex_values().value(page, page.corner(simplex, i), attribute_);
    show(t, corners_of(page, simplex), values, visit);
}

template <int D>
void Overlaps<D>::show(const Asked &t, const Corners<D> &corners,
                       const std::array<double, D + 1> &values, const Visit &visit) const {
    Box<D> box;
    for (const Point<D> *corner : corners) box.extend(*corner);
    if (!box.meets(t.box) || !overlap<D>(t.corners, corners)) return;
    if (is_in<D>(extent_, no_region, corners)) visit(corners, values);
}

template class Overlaps<2>;
template class Overlaps<3>;

} // namespace abacus
