#include "query/scan/range_scan.hpp"

#include "keys/domain_of.hpp"
#include "query/locate/reader.hpp"
#include "query/pages/page_simplex.hpp"

#include <algorithm>

namespace abacus {

namespace {

/// The size of the cache for the walk to the region.
constexpr std::size_t walk_bytes = std::size_t{1} << 20;

template <int D> Box<D> box_of(const PageView<D> &page) {
    Box<D> box;
    for (int i = 0; i < D; ++i) {
        box.lower[i] = page.box(i);
        box.upper[i] = page.box(D + i);
    }
    return box;
}

/// The corners of a ghost, with p in place of the point at infinity.
template <int D> Corners<D> ghost_corners(const PageView<D> &page, int ghost, const Point<D> &p) {
    Corners<D> corners;
    for (int i = 0; i < D; ++i) corners[i] = &page.point(page.corner(ghost, i));
    corners[D] = &p;
    return corners;
}

} // namespace

// ---- Boxes ------------------------------------------------------------------------------

template <int D> Point<D> BoxRegion<D>::inside(const Domain<D> &domain) const {
    Point<D> p;
    for (int i = 0; i < D; ++i)
        p[i] = std::clamp(domain.lower()[i] * 0.5 + domain.upper()[i] * 0.5, box_.lower[i],
                          box_.upper[i]);
    return p;
}

template <int D> bool BoxRegion<D>::may_meet(const Point<D> *const *points, int n) const {
    Box<D> around;
    for (int i = 0; i < n; ++i) around.extend(*points[i]);
    return box_.meets(around);
}

template <int D> bool BoxRegion<D>::lies_beyond(const Corners<D> &facet) const {
    // A ghost is positively oriented around the half-space beyond its facet.
    for (int i = 0; i < 1 << D; ++i)
        if (facet_side<D>(facet, D, box_.corner(i)) <= 0) return false;
    return true;
}

template <int D> bool BoxRegion<D>::has_much_of(const Domain<D> &domain) const {
    constexpr double much = 0.25;
    double share = 1;
    for (int i = 0; i < D; ++i) {
        const double lower = std::max(box_.lower[i], domain.lower()[i]);
        const double upper = std::min(box_.upper[i], domain.upper()[i]);
        const double extent = domain.upper()[i] * 0.5 - domain.lower()[i] * 0.5;
        if (extent > 0) share *= std::max(0.0, (upper * 0.5 - lower * 0.5) / extent);
    }
    return share > much;
}

// ---- The scan ---------------------------------------------------------------------------

template <int D>
RangeScan<D>::RangeScan(const Host &host, const abacus_facts &facts, const Region<D> *region,
                        Wants wants)
    : host_(host), facts_(facts), region_(region), wants_(std::move(wants)) {
    const bool is_whole = region == nullptr || !abacus_floods_pages(facts.standing) ||
                          facts.census.simplices == 0 ||
                          region->has_much_of(domain_of<D>(facts.form));
    if (is_whole) {
        whole_.emplace(host, facts_);
    } else {
        flood_.emplace(host, facts_);
        begin();
    }
}

template <int D> void RangeScan<D>::begin() {
    Reader<D> reader(host_, facts_, walk_bytes);
    const Point<D> p = region_->inside(reader.cache().domain());
    const auto around = reader.page_around(p);
    if (around->is_inside)
        flood_->reach(around->page);
    else
        begin_outside(p, around->page);
}

template <int D> void RangeScan<D>::begin_outside(const Point<D> &p, const Key &first) {
    PageFlood<D> hull(host_, facts_);
    const PageView<D> &page = hull.page();
    const auto sees = [&](int ghost) {
        return page.is_ghost(ghost) && facet_side<D>(ghost_corners<D>(page, ghost, p), D, p) > 0;
    };
    hull.reach(first);
    while (hull.advance()) {
        for (int s = 0; s < page.simplices(); ++s) {
            if (!sees(s)) continue;
            const Corners<D> corners = ghost_corners<D>(page, s, p);
            if (region_->lies_beyond(corners)) return;
            if (region_->may_meet(corners.data(), D)) flood_->reach(page.lower());
        }
        hull.spread([&](int s, int facet) { return facet < D && sees(s); });
    }
}

template <int D> bool RangeScan<D>::may_cross(int simplex, int facet) const {
    const PageView<D> &page = flood_->page();
    if (page.is_ghost(simplex) && facet != D) return false; // a ridge
    const Point<D> *points[D];
    for (int i = 0; i < D; ++i) points[i] = &page.point(page.corner(simplex, i + (i >= facet)));
    return region_->may_meet(points, D);
}

template <int D> bool RangeScan<D>::advance_any() {
    if (whole_) return wants_ ? whole_->advance(wants_) : whole_->advance();
    if (!flood_->advance()) return false;
    if (region_->may_meet(box_of(page())))
        flood_->spread([this](int simplex, int facet) { return may_cross(simplex, facet); });
    return true;
}

template <int D> bool RangeScan<D>::advance() {
    while (advance_any())
        if ((region_ == nullptr || region_->may_meet(box_of(page()))) &&
            (!wants_ || wants_(page())))
            return true;
    return false;
}

template <int D> void RangeScan<D>::rewind() {
    if (whole_)
        whole_.emplace(host_, facts_);
    else
        flood_->rewind();
}

template class BoxRegion<2>;
template class BoxRegion<3>;
template class RangeScan<2>;
template class RangeScan<3>;

} // namespace abacus
