#include "query/values/sibson.hpp"

#include "geometry/conflict.hpp"
#include "geometry/linear_solution.hpp"

#include <algorithm>
#include <cmath>

namespace abacus {

namespace {

template <int D> Point<D> plus(Point<D> a, const Point<D> &b) {
    for (int i = 0; i < D; ++i) a[i] += b[i];
    return a;
}
Point<3> times(const Point<3> &a, const Point<3> &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// b² − a², for vectors that may differ by little.
template <int D> double growth(const Point<D> &a, const Point<D> &b) {
    return dot<D>(minus<D>(b, a), plus<D>(b, a));
}

} // namespace

template <int D> bool Sibson<D>::find_zone(Cache<D> &cache, Handle h, const Point<D> &p) {
    met_.clear();
    beyond_.clear();
    marks_.set(h, Marks::inside);
    met_.push_back(h);
    bool is_on_hull = false;
    for (std::size_t n = 0; n < met_.size() && !is_on_hull; ++n) {
        if (n % 1024 == 1023) cache.poll();
        for (int i = 0; i <= D; ++i) {
            const Handle beyond = link_simplex(cache.cross(met_[n], i));
            beyond_.push_back(beyond);
            if (cache.is_fixed(make_link(met_[n], i))) [[unlikely]] {
                is_on_hull = is_on_hull || is_on_facet<D>(cache, met_[n], i, p);
                beyond_.back() = no_handle; // though it may be in the zone, too
                continue;
            }
            if (marks_.get(beyond) != Marks::none) continue;
            const Simplex<D> &s = cache.simplex(beyond);
            const Corners<D> corners = cache.corners(s);
            const Side side =
                s.is_ghost() ? side_of_ghost<D>(corners, p) : side_of_simplex<D>(corners, p);
            if (side != Side::inside) continue;
            marks_.set(beyond, Marks::inside);
            met_.push_back(beyond);
            is_on_hull = is_on_hull || s.is_ghost();
        }
    }
    for (const Handle met : met_) marks_.set(met, Marks::none);
    if (!is_on_hull) describe_zone(cache);
    return !is_on_hull;
}

template <int D> void Sibson<D>::describe_zone(Cache<D> &cache) {
    places_.clear();
    for (std::size_t n = 0; n < met_.size(); ++n)
        places_.push_back({met_[n], static_cast<std::uint32_t>(n)});
    std::sort(places_.begin(), places_.end(),
              [](const Place &a, const Place &b) { return a.simplex < b.simplex; });
    zone_.clear();
    for (std::size_t n = 0; n < met_.size(); ++n) {
        ZoneSimplex<D> simplex{cache.simplex(met_[n]).vertex, {}};
        for (int i = 0; i <= D; ++i) {
            const Handle beyond = beyond_[n * (D + 1) + i];
            const auto *const at =
                std::lower_bound(places_.begin(), places_.end(), beyond,
                                 [](const Place &place, Handle h) { return place.simplex < h; });
            const bool is_inner = at != places_.end() && at->simplex == beyond;
            simplex.beyond[i] = is_inner ? at->number : ZoneSimplex<D>::not_seen;
        }
        zone_.push_back(simplex);
    }
}

template <int D> void Sibson<D>::see(Cache<D> &cache, const Point<D> &p) {
    numbers_.clear();
    for (const ZoneSimplex<D> &simplex : zone_)
        for (const VertexIndex v : simplex.vertex) cache.number(numbers_, v);
    cache.sort_by_place(numbers_);
    const auto extent = [&](double part) {
        double most = 0;
        for (std::size_t i = 0; i < numbers_.size(); ++i)
            for (int axis = 0; axis < D; ++axis)
                most = std::max(most,
                                std::abs(cache.point(numbers_[i])[axis] * part - p[axis] * part));
        return most;
    };
    // Powers of two, so that nothing is rounded: a part for the case that differences overflow, and
    // two factors, since their product may be beyond the range of doubles.
    double most = extent(1);
    scale_[0] = std::isfinite(most) ? 1 : 0.25;
    if (scale_[0] != 1) most = extent(scale_[0]);
    const int exponent = most == 0 ? 0 : -std::ilogb(most);
    scale_[1] = std::ldexp(1.0, exponent / 2);
    scale_[2] = std::ldexp(1.0, exponent - exponent / 2);
    seen_.resize(numbers_.size());
    for (std::size_t i = 0; i < numbers_.size(); ++i)
        for (int axis = 0; axis < D; ++axis)
            seen_[i][axis] = (cache.point(numbers_[i])[axis] * scale_[0] - p[axis] * scale_[0]) *
                             scale_[1] * scale_[2];
    shares_.resize(numbers_.size());
    std::fill(shares_.begin(), shares_.end(), 0.0);
    cache_ = &cache;
    p_ = p;
}

template <int D> void Sibson<D>::order_zone(Cache<D> &cache) {
    members_.resize(zone_.size());
    for (std::size_t n = 0; n < zone_.size(); ++n) {
        std::array<std::pair<std::uint32_t, std::uint8_t>, D + 1> corners;
        for (int i = 0; i <= D; ++i)
            corners[i] = {cache.number(numbers_, zone_[n].vertex[i]), static_cast<std::uint8_t>(i)};
        std::sort(corners.begin(), corners.end());
        Member &member = members_[n];
        for (int i = 0; i <= D; ++i) {
            member.number[i] = corners[i].first;
            member.corner[i] = corners[i].second;
        }
        member.found = static_cast<std::uint32_t>(n);
    }
    std::sort(members_.begin(), members_.end(),
              [](const Member &a, const Member &b) { return a.number < b.number; });
    ranks_.resize(zone_.size());
    for (std::size_t n = 0; n < zone_.size(); ++n)
        ranks_[members_[n].found] = static_cast<std::uint32_t>(n);
}

/// The centre of the sphere through n neighbours, and through p if n is D.
template <int D> Point<D> Sibson<D>::centre(const std::uint32_t *numbers, int n) const {
    return solve<D>([&]<class T>() {
        // The points relative to p: rounded in doubles, exact in rational numbers.
        const auto point = [&](int i) {
            std::array<T, D> seen;
            for (int axis = 0; axis < D; ++axis)
                if constexpr (std::is_same_v<T, double>)
                    seen[axis] = seen_[numbers[i]][axis];
                else
                    seen[axis] = (T(cache_->point(numbers_[numbers[i]])[axis]) - T(p_[axis])) *
                                 T(scale_[0]) * T(scale_[1]) * T(scale_[2]);
            return seen;
        };
        std::array<T, D> from; // the first point, or p
        from.fill(T(0));
        if (n > D) from = point(D);
        LinearSystem<T, D> system;
        for (int i = 0; i < D; ++i) {
            const std::array<T, D> to = point(i);
            T half = T(0);
            for (int axis = 0; axis < D; ++axis) {
                system.matrix[i][axis] = to[axis] - from[axis];
                half += system.matrix[i][axis] * (to[axis] + from[axis]);
            }
            system.right[i] = half / T(2);
        }
        return system;
    });
}

template <int D>
std::array<std::uint32_t, D> Sibson<D>::facet_of(Cache<D> &cache, const ZoneSimplex<D> &s,
                                                 int facet) {
    const auto &vertex = s.vertex;
    const auto number = [&](int corner) { return cache.number(numbers_, vertex[corner]); };
    if constexpr (D == 2) {
        return {number((facet + 1) % 3), number((facet + 2) % 3)};
    } else {
        constexpr std::array<std::array<int, 3>, 4> outward{
            {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
        std::array<std::uint32_t, 3> numbers{number(outward[facet][0]), number(outward[facet][1]),
                                             number(outward[facet][2])};
        std::rotate(numbers.begin(), std::min_element(numbers.begin(), numbers.end()),
                    numbers.end());
        return numbers;
    }
}

template <int D>
void Sibson<D>::add_side(const std::array<std::uint32_t, D> &facet, const Point<D> &from,
                         const Point<D> &to) {
    Point<D> turned; // times an edge: the side's part in the edge's dual, times its length
    if constexpr (D == 3) turned = times(from, to);
    for (int i = 0; i < (D == 2 ? 1 : 3); ++i) {
        const std::uint32_t a = facet[i], b = facet[(i + 1) % D];
        const Point<D> edge = minus<D>(seen_[b], seen_[a]);
        double part;
        if constexpr (D == 2)
            part = (to[0] - from[0]) * edge[1] - (to[1] - from[1]) * edge[0];
        else
            part = dot<D>(turned, edge) / 2;
        const double share = part * growth<D>(seen_[a], seen_[b]) / (2 * dot<D>(edge, edge));
        shares_[a] += share;
        shares_[b] -= share;
    }
}

template <int D> void Sibson<D>::add_simplex(Cache<D> &cache, std::size_t n) {
    const Member &member = members_[n];
    const ZoneSimplex<D> &simplex = zone_[member.found];
    for (const std::uint8_t i : member.corner) {
        const bool is_inner = simplex.beyond[i] != ZoneSimplex<D>::not_seen;
        const std::uint32_t beyond = is_inner ? ranks_[simplex.beyond[i]] : 0;
        if (is_inner && beyond < n) continue; // the other simplex adds it
        const std::array<std::uint32_t, D> facet = facet_of(cache, simplex, i);
        if (is_inner) {
            add_side(facet, centres_[n], centres_[beyond]);
        } else {
            rim_.push_back({facet, centre(facet.data(), D)});
            add_side(facet, centres_[n], rim_.back().centre);
        }
    }
}

template <> void Sibson<2>::add_ridges() {
    // Between p and a vertex lies the edge between the centres of two consecutive facets of the
    // rim.
    for (const RimFacet &facet : rim_) {
        const Point<2> &a = seen_[facet.vertex[0]], &b = seen_[facet.vertex[1]], &y = facet.centre;
        shares_[facet.vertex[0]] += (y[1] * a[0] - y[0] * a[1]) / 2;
        shares_[facet.vertex[1]] -= (y[1] * b[0] - y[0] * b[1]) / 2;
    }
}

template <> void Sibson<3>::add_ridges() {
    ridges_.pair(3 * rim_.size(), numbers_.size(), [&](const auto &view) {
        for (std::size_t n = 0; n < rim_.size(); ++n)
            for (int i = 0; i < 3; ++i)
                view.add(rim_[n].vertex[i], rim_[n].vertex[(i + 1) % 3],
                         Link{static_cast<std::uint32_t>(n)});
        for (std::size_t n = 0; n < rim_.size(); ++n)
            for (int i = 0; i < 3; ++i) {
                const std::uint32_t a = rim_[n].vertex[i], b = rim_[n].vertex[(i + 1) % 3];
                const std::size_t beyond = to_bits(view.across(a, b));
                if (beyond < n) continue; // the other facet adds it
                const Point<3> turned = times(rim_[n].centre, rim_[beyond].centre);
                // The rest of the dual of the edge from a to b goes the other way.
                const Point<3> edge = minus<3>(seen_[b], seen_[a]);
                const double share =
                    dot<3>(turned, edge) * growth<3>(seen_[a], seen_[b]) / (4 * dot<3>(edge, edge));
                shares_[a] += share - dot<3>(turned, seen_[a]) / 4;
                shares_[b] -= share - dot<3>(turned, seen_[b]) / 4;
            }
    });
}

template <int D> bool Sibson<D>::normalize() {
    double sum = 0;
    for (double &share : shares_) {
        share = std::max(share, 0.0); // a negative share is a rounding error
        sum += share;
    }
    if (!(sum > 0) || !std::isfinite(sum)) return false;
    // The mean of the neighbours is p, unless circumcentres are so far away that rounding loses the
    // cell.
    Point<D> mean{};
    for (std::size_t i = 0; i < shares_.size(); ++i) {
        shares_[i] /= sum;
        for (int axis = 0; axis < D; ++axis) mean[axis] += shares_[i] * seen_[i][axis];
    }
    return dot<D>(mean, mean) < 1e-18; // seen_ is about 1 in size
}

template <int D>
bool Sibson<D>::find(Cache<D> &cache, Handle h, const Point<D> &p, bool has_soft_lines) {
    bool is_known = false;
    if constexpr (D == 2)
        if (has_soft_lines && soft_zone_.matters(cache, h, p)) {
            if (!soft_zone_.find(cache, h, p, zone_)) return false;
            is_known = true;
        }
    if (!is_known && !find_zone(cache, h, p)) return false;
    see(cache, p);
    order_zone(cache);
    centres_.clear();
    rim_.clear();
    for (const Member &member : members_) centres_.push_back(centre(member.number.data(), D + 1));
    for (std::size_t n = 0; n < zone_.size(); ++n) {
        if (n % 1024 == 1023) cache.poll();
        add_simplex(cache, n);
    }
    add_ridges();
    return normalize();
}

template class Sibson<2>;
template class Sibson<3>;

} // namespace abacus
