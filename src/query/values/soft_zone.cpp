#include "query/values/soft_zone.hpp"

#include "delaunay/cached_conflict.hpp"
#include "geometry/predicates.hpp"

#include <algorithm>
#include <cmath>

namespace abacus {

namespace {

constexpr double sure = 1e-9, margin = 1e-5; // of lengths

double cross(const Point<2> &a, const Point<2> &b) { return a[0] * b[1] - a[1] * b[0]; }

/// Of two points: whether rounding leaves their difference as good as exact.
bool is_sure_difference(const Point<2> &a, const Point<2> &b) {
    constexpr double rounding = 0x1p-53;
    const double most = std::max({std::abs(a[0]), std::abs(a[1]), std::abs(b[0]), std::abs(b[1])});
    return std::hypot(a[0] - b[0], a[1] - b[1]) * sure > most * rounding;
}

/// False only if the circle through p, u and w surely has no point of the segment from x to y.
bool may_meet_circle(const Point<2> &p, const Point<2> &u, const Point<2> &w, const Point<2> &x,
                     const Point<2> &y) {
    if (!is_sure_difference(u, p) || !is_sure_difference(w, p)) return true;
    const Point<2> a = minus<2>(u, p), b = minus<2>(w, p), c = minus<2>(x, p);
    const double turn = cross(a, b), aa = dot<2>(a, a), bb = dot<2>(b, b);
    if (!(turn * turn > 1e-12 * aa * bb)) return true; // the centre is far away
    const Point<2> centre{(aa * b[1] - bb * a[1]) / (2 * turn),
                          (bb * a[0] - aa * b[0]) / (2 * turn)};
    const Point<2> along = minus<2>(y, x), from = minus<2>(centre, c);
    const double t = std::clamp(dot<2>(from, along) / dot<2>(along, along), 0.0, 1.0);
    const Point<2> nearest = minus<2>(from, {along[0] * t, along[1] * t});
    const double radius = std::hypot(centre[0], centre[1]);
    // Where it lies is as uncertain as the place itself is from here.
    const double far = std::hypot(c[0], c[1]) + std::hypot(along[0], along[1]);
    return !(std::hypot(nearest[0], nearest[1]) > radius * (1 + margin) + far * sure);
}

} // namespace

Handle SoftZone::seen_beyond(Cache<2> &cache, Handle h, int facet) const {
    if (cache.fixed(make_link(h, facet)) == Fixed::hard) return no_handle;
    const Handle beyond = link_simplex(cache.cross(h, facet));
    return cache.simplex(beyond).is_ghost() ? no_handle : beyond;
}

bool SoftZone::is_at_end(Cache<2> &cache, Handle h, const Point<2> &p) const {
    for (int i = 0; i < 3; ++i)
        if (is_on_facet<2>(cache, h, i, p) && seen_beyond(cache, h, i) == no_handle) return true;
    return false;
}

void SoftZone::take(Cache<2> &cache, Handle h) {
    marks_.set(h, Marks::inside);
    region_.push_back(h);
    has_soft_ = has_soft_ || cache.fixed(h).any_soft();
}

void SoftZone::forget_region() {
    for (const Handle met : region_) marks_.set(met, Marks::none);
    region_.clear();
    has_soft_ = false;
}

void SoftZone::begin(Cache<2> &cache, Handle h, const Point<2> &p) {
    forget_region();
    take(cache, h);
    for (std::size_t n = 0; n < region_.size(); ++n) {
        if (n % 1024 == 1023) cache.poll();
        for (int i = 0; i < 3; ++i) {
            const Handle beyond = seen_beyond(cache, region_[n], i);
            if (beyond == no_handle || marks_.get(beyond) != Marks::none) continue;
            if (side_of<2>(cache, cache.simplex(beyond), p) == Side::inside) take(cache, beyond);
        }
    }
}

std::uint32_t SoftZone::number_of(Handle h) const {
    const auto *const at =
        std::lower_bound(places_.begin(), places_.end(), h,
                         [](const Place &place, Handle other) { return place.triangle < other; });
    return at != places_.end() && at->triangle == h ? at->number : ZoneSimplex<2>::not_seen;
}

void SoftZone::find_rim(Cache<2> &cache) {
    rim_.clear();
    border_.clear();
    for (const Handle h : region_)
        for (int i = 0; i < 3; ++i) {
            const Handle beyond = seen_beyond(cache, h, i);
            if (beyond == no_handle || marks_.get(beyond) != Marks::none) continue;
            const auto &vertex = cache.simplex(h).vertex;
            rim_.push_back({cache.point(vertex[(i + 1) % 3]), cache.point(vertex[(i + 2) % 3])});
            border_.push_back(make_link(h, i));
        }
}

bool SoftZone::matters(Cache<2> &cache, Handle h, const Point<2> &p) {
    begin(cache, h, p);
    if (!has_soft_) {
        find_rim(cache);
        grow(cache, p);
    }
    const bool has_soft = has_soft_;
    forget_region();
    return has_soft;
}

void SoftZone::triangulate(Cache<2> &cache, Pieces &pieces) {
    places_.clear();
    for (std::size_t n = 0; n < region_.size(); ++n)
        places_.push_back({region_[n], static_cast<std::uint32_t>(n)});
    std::sort(places_.begin(), places_.end(),
              [](const Place &a, const Place &b) { return a.triangle < b.triangle; });
    pieces.clear();
    border_.clear();
    for (const Handle h : region_) {
        std::array<Pieces::Side, 3> beyond;
        for (int i = 0; i < 3; ++i) {
            const Handle next = seen_beyond(cache, h, i);
            const bool is_inner = next != no_handle && number_of(next) != ZoneSimplex<2>::not_seen;
            beyond[i] = is_inner ? Pieces::unknown
                                 : pieces.outside(next == no_handle ? Fixed::hard : Fixed::no);
            if (next != no_handle && !is_inner) border_.push_back(make_link(h, i));
        }
        pieces.add(cache.simplex(h).vertex, beyond);
    }
    for (std::size_t n = 0; n < region_.size(); ++n)
        for (int i = 0; i < 3; ++i) {
            if (seen_beyond(cache, region_[n], i) == no_handle) continue;
            const Link next = cache.cross(region_[n], i);
            const std::uint32_t other = number_of(link_simplex(next));
            if (other != ZoneSimplex<2>::not_seen && other > n)
                pieces.join(Pieces::side(n, i), Pieces::side(other, link_facet(next)), Fixed::no);
        }
    pieces.improve();
}

std::size_t SoftZone::piece_around(Cache<2> &cache, const Pieces &pieces, const Point<2> &p) const {
    for (std::size_t n = 0; n < pieces.size(); ++n) {
        const auto &vertex = pieces[n].vertex;
        bool is_around = true;
        for (int i = 0; i < 3 && is_around; ++i)
            is_around = orientation(cache.point(vertex[(i + 1) % 3]),
                                    cache.point(vertex[(i + 2) % 3]), p) >= 0;
        if (is_around) return n;
    }
    throw_no_triangulation();
}

void SoftZone::find_zone(Cache<2> &cache, const Pieces &pieces, const Point<2> &p) {
    Arena<bool> is_met(host_);
    is_met.resize(pieces.size());
    std::fill(is_met.begin(), is_met.end(), false);
    rim_.clear();
    numbers_.clear();
    numbers_.push_back(static_cast<std::uint32_t>(piece_around(cache, pieces, p)));
    is_met[numbers_[0]] = true;
    for (std::size_t n = 0; n < numbers_.size(); ++n) {
        const Pieces::Piece &piece = pieces[numbers_[n]];
        for (int i = 0; i < 3; ++i) {
            if (piece.fixed.is_fixed(i)) continue;
            const Pieces::Side beyond = piece.beyond[i];
            if (!Pieces::is_outside(beyond)) {
                const std::uint32_t next = Pieces::piece_of(beyond);
                if (is_met[next]) continue;
                if (pieces.is_in_circle(next, p)) {
                    is_met[next] = true;
                    numbers_.push_back(next);
                    continue;
                }
            }
            rim_.push_back(
                {cache.point(piece.vertex[(i + 1) % 3]), cache.point(piece.vertex[(i + 2) % 3])});
        }
    }
}

bool SoftZone::is_reached(const Point<2> &p, const Point<2> &x, const Point<2> &y) const {
    const auto all_beside = [&](const Point<2> &a, const Point<2> &b) { // left of a to b, or on it
        return orientation(a, b, x) >= 0 && orientation(a, b, y) >= 0;
    };
    return std::any_of(rim_.begin(), rim_.end(), [&](const Rim &rim) {
        if ((x == rim.u && y == rim.w) || (x == rim.w && y == rim.u)) return true;
        return !all_beside(rim.u, rim.w) && !all_beside(rim.u, p) && !all_beside(p, rim.w) &&
               may_meet_circle(p, rim.u, rim.w, x, y);
    });
}

bool SoftZone::grow(Cache<2> &cache, const Point<2> &p) {
    const std::size_t before = region_.size();
    const auto cross = [&](Handle h, int i) {
        const Handle beyond = seen_beyond(cache, h, i);
        if (beyond == no_handle || marks_.get(beyond) != Marks::none) return;
        const auto &vertex = cache.simplex(h).vertex;
        if (is_reached(p, cache.point(vertex[(i + 1) % 3]), cache.point(vertex[(i + 2) % 3])))
            take(cache, beyond);
    };
    for (const Link edge : border_) cross(link_simplex(edge), link_facet(edge));
    for (std::size_t n = before; n < region_.size(); ++n) {
        if (n % 256 == 255) cache.poll();
        for (int i = 0; i < 3; ++i) cross(region_[n], i);
    }
    return region_.size() > before;
}

bool SoftZone::find(Cache<2> &cache, Handle h, const Point<2> &p, Arena<ZoneSimplex<2>> &zone) {
    zone.clear();
    if (is_at_end(cache, h, p)) return false;
    Pieces pieces(cache);
    begin(cache, h, p);
    do {
        triangulate(cache, pieces);
        find_zone(cache, pieces, p);
    } while (grow(cache, p));
    forget_region();
    Arena<std::uint32_t> place(host_);
    place.resize(pieces.size());
    std::fill(place.begin(), place.end(), ZoneSimplex<2>::not_seen);
    for (std::size_t n = 0; n < numbers_.size(); ++n)
        place[numbers_[n]] = static_cast<std::uint32_t>(n);
    for (const std::uint32_t number : numbers_) {
        const Pieces::Piece &piece = pieces[number];
        ZoneSimplex<2> simplex{piece.vertex, {}};
        for (int i = 0; i < 3; ++i)
            simplex.beyond[i] = piece.fixed.is_fixed(i) || Pieces::is_outside(piece.beyond[i])
                                    ? ZoneSimplex<2>::not_seen
                                    : place[Pieces::piece_of(piece.beyond[i])];
        zone.push_back(simplex);
    }
    return true;
}

} // namespace abacus
